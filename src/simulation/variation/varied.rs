//! A mechanism as the variational equations see it.

use super::neighbours::Neighbours;
use crate::integrator::tangent::{Companion, Crossing, Gradient, Variational};
use crate::integrator::{MAX_STATES, System};
use crate::math::Real;
use crate::model::contact::ContactState;
use crate::model::jacobian::in_directions;
use crate::model::mechanism_model::MechanismModel;
use crate::model::scalar::Tangent;
use crate::model::state::{CONTACTS, Conditions, Pose};

/// A mechanism and its neighbours along the parameters.
pub struct Varied<'a> {
    /// The mechanism.
    pub model: &'a dyn MechanismModel,
    /// Neighbours along each parameter.
    pub neighbours: &'a [Neighbours],
}

/// Relative change of an approach speed in a difference. The force is linear in the speed's reciprocal.
const APPROACH_STEP: f64 = 1e-4;
/// Relative change of an approach speed near a corner of the force.
const SHORT_STEP: f64 = 1e-8;
/// Relative difference of the slopes on both sides that shows a corner.
const CORNER: f64 = 1e-6;

impl Variational for Varied<'_> {
    type Discrete = Conditions;

    fn system(&self) -> &dyn System<Discrete = Conditions> {
        self.model
    }

    fn memories(&self) -> usize {
        CONTACTS
    }

    fn write_rates_by_memory(
        &self,
        contact: usize,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        slopes: &mut [f64],
    ) -> bool {
        let ContactState { closed, per_approach, approach } = conditions.contacts[contact];
        if !closed {
            return false;
        }
        let at = |share: f64| {
            let mut conditions = *conditions;
            conditions.contacts[contact].per_approach = per_approach * (1.0 + share);
            let mut rates = [0.0; MAX_STATES];
            self.model.rates(&conditions, t, y, &mut rates[..y.len()]);
            rates
        };
        let here = at(0.0);
        // d(1/v)/dv = −(1/v)/v.
        let slope = |from: f64, to: f64, share: f64| (from - to) / (share * approach);
        let (more, less) = (at(APPROACH_STEP), at(-APPROACH_STEP));
        let one_sided = slopes.iter_mut().enumerate().map(|(i, place)| {
            let (up, down) = (slope(here[i], more[i], APPROACH_STEP), slope(less[i], here[i], APPROACH_STEP));
            *place = 0.5 * (up + down);
            (up - down).abs() > CORNER * up.abs().max(down.abs()) + f64::EPSILON * here[i].abs() / APPROACH_STEP
        });
        // The corner of the limited force lies in between.
        if one_sided.fold(false, |any, one| any | one) {
            let (more, less) = (at(SHORT_STEP), at(-SHORT_STEP));
            for (i, place) in slopes.iter_mut().enumerate() {
                *place = slope(less[i], more[i], 2.0 * SHORT_STEP);
            }
        }
        true
    }

    fn parameters(&self) -> usize {
        self.neighbours.len()
    }

    fn write_rates_by_parameter(
        &self,
        parameter: usize,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        companion: &Companion<'_>,
        slopes: &mut [f64],
    ) {
        self.neighbours[parameter].write_rates(self.model, conditions, t, y, companion, slopes);
    }

    fn crossings(&self, before: &Conditions, after: &Conditions, t: f64, y: &[f64]) -> Vec<Crossing<Conditions>> {
        let changed: Vec<usize> = changed(before, after).collect();
        if changed.is_empty() {
            return vec![];
        }
        let pose = self.model.pose(t, y);
        let (gradients, approaches) = (self.gradients(before, &pose, t, y), self.model.approaches(&pose));
        let mut conditions = *before;
        changed
            .into_iter()
            .map(|contact| {
                conditions.contacts[contact] = after.contacts[contact];
                let [distance, rate] = gradients[contact].clone();
                let closes = after.contacts[contact].closed;
                // An approach below the floor is remembered as the floor.
                let remembered = if closes && approaches[contact].1 > self.model.speed_floor(contact) {
                    rate.clone()
                } else {
                    Gradient::default()
                };
                Crossing {
                    contact,
                    after: conditions,
                    distance,
                    rate,
                    memory: Some((contact, remembered)),
                    reset: if closes { 0..0 } else { self.model.bristles_of(contact) },
                }
            })
            .collect()
    }

    fn differ(&self, before: &Conditions, after: &Conditions) -> bool {
        changed(before, after).next().is_some()
    }
}

/// The contacts that are closed in only one of the two.
fn changed<'a>(before: &'a Conditions, after: &'a Conditions) -> impl Iterator<Item = usize> + 'a {
    (0..CONTACTS).filter(|&contact| before.contacts[contact].closed != after.contacts[contact].closed)
}

impl Varied<'_> {
    /// Derivatives of the penetration and of the approach speed of every contact, where the pose is `here`.
    fn gradients(&self, conditions: &Conditions, here: &Pose, t: f64, y: &[f64]) -> [[Gradient; 2]; CONTACTS] {
        let n = y.len();
        let empty = || Gradient { by_state: vec![0.0; n], by_time: 0.0, by_parameter: vec![] };
        let mut all: [[Gradient; 2]; CONTACTS] = std::array::from_fn(|_| [empty(), empty()]);
        in_directions::<MAX_STATES>(n, n + 1, t, y, |first, t, at| {
            let pose = self.model.tangent_evaluation(conditions, t, at, &mut [Tangent::ZERO; MAX_STATES][..n]).pose;
            for (gradients, (depth, rate)) in all.iter_mut().zip(self.model.tangent_approaches(&pose)) {
                for (gradient, number) in gradients.iter_mut().zip([depth, rate]) {
                    for (column, slope) in (first..=n).zip(number.slope) {
                        if column < n {
                            gradient.by_state[column] = slope;
                        } else {
                            gradient.by_time = slope;
                        }
                    }
                }
            }
        });
        for neighbours in self.neighbours {
            for (gradients, slopes) in all.iter_mut().zip(neighbours.approaches(self.model, here, t, y)) {
                for (gradient, slope) in gradients.iter_mut().zip(slopes) {
                    gradient.by_parameter.push(slope);
                }
            }
        }
        all
    }
}
