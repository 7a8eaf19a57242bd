//! Mechanisms that differ a little in one parameter, and derivatives from their differences.
//!
//! A mechanism is assembled from numbers without derivatives. Derivatives by a parameter are therefore differences of
//! order 4 at the same state, (8·(f₁ − f₋₁) − (f₂ − f₋₂))/(12·h). Contact forces are not smooth where a penetration
//! begins and at their corners, so the step h is chosen anew at every state, such that no penetration, and no distance to
//! a corner, changes by more than a share of itself.

use super::seed::Seed;
use crate::integrator::{Discontinuities, MAX_STATES};
use crate::model::contact::ContactState;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::signals::Outputs;
use crate::model::state::{CONTACTS, Conditions};
use crate::scene::Scene;
use crate::scene::parameter::{Kind, Parameter};
use crate::simulation::assemble;
use crate::simulation::error::SimulationError;
use crate::simulation::observation::observe;
use crate::simulation::start::pose;
use std::cell::OnceCell;

/// Steps of a difference, in steps h, with their weights. Opposite ones follow each other, so that the sum is exactly 0
/// where nothing changes.
const CENTRAL: [(f64, f64); 4] = [(-1.0, -8.0 / 12.0), (1.0, 8.0 / 12.0), (-2.0, 1.0 / 12.0), (2.0, -1.0 / 12.0)];
/// The longest step as a share of a parameter …
const LONGEST: f64 = 1e-3;
/// … or, if it is 0, of its range.
const OF_RANGE: f64 = 1e-4;
/// The longest step is at most this.
const MOST: f64 = 0.1;
/// Ratio of two steps, and their number.
const RATIO: f64 = 0.1;
const LEVELS: usize = 7;
/// The level at which changes of penetrations are measured: short against clearances, where its lengths are centimetres.
const MEASURED: usize = 4;
/// Largest change of a penetration, and of a distance to a corner, as shares of themselves.
const LARGEST_CHANGE: f64 = 0.01;
const NEAREST_CORNER: f64 = 0.2;

/// A mechanism with one parameter changed.
struct Neighbour {
    /// Weight of its numbers in a derivative.
    weight: f64,
    model: Box<dyn MechanismModel>,
    observer: Observer,
    /// The state in which it starts, and the approach speeds of the contacts that are closed there.
    start: (Vec<f64>, [f64; CONTACTS]),
}

/// Neighbours at one step.
struct Level {
    /// Unit of the parameter.
    step: f64,
    neighbours: Vec<Neighbour>,
}

/// Neighbours at all steps. A level is assembled when it is first used: few steps of a motion need short ones.
struct Levels {
    scene: Scene,
    parameter: &'static Parameter,
    widest: Level,
    shorter: [OnceCell<Level>; LEVELS - 1],
}

/// What the neighbours differ in.
enum Of {
    Parameter(Box<Levels>),
    /// Outputs and rates are affine in the inputs.
    Input(Seed),
}

/// Neighbours of a mechanism along one parameter or input.
pub struct Neighbours(Of);

impl Neighbours {
    /// Neighbours along a real parameter of `scene`.
    ///
    /// # Errors
    /// `Scene` if a neighbour cannot be assembled: the parameter is at an end of its range.
    pub fn of_parameter(scene: &Scene, parameter: &'static Parameter) -> Result<Self, SimulationError> {
        let widest = Level::new(scene, parameter, longest(parameter, scene))?;
        let levels = Levels { scene: scene.clone(), parameter, widest, shorter: Default::default() };
        Ok(Self(Of::Parameter(Box::new(levels))))
    }

    /// Neighbours along an input.
    pub fn of_input(seed: Seed) -> Self {
        Self(Of::Input(seed))
    }

    /// Whether the neighbours lie along this seed.
    pub fn is_of(&self, seed: &Seed) -> bool {
        match (&self.0, seed) {
            (Of::Parameter(own), Seed::Parameter(other)) => own.parameter.name == other.name,
            (Of::Input(own), other) => std::mem::discriminant(own) == std::mem::discriminant(other),
            _ => false,
        }
    }

    /// Writes the derivative of the start state, and of the approach speeds of closed contacts below it.
    pub fn write_start(&self, direction: &mut [f64]) {
        let Of::Parameter(levels) = &self.0 else { return };
        // The start pose is smooth.
        let Level { step, neighbours } = levels.at(0);
        for Neighbour { weight, start: (states, approach), .. } in neighbours {
            let values = states.iter().chain(approach);
            direction.iter_mut().zip(values).for_each(|(slope, value)| *slope += weight * value / step);
        }
    }

    /// Writes the derivatives of the rates of `model`, which these are neighbours of, at constant state.
    pub fn write_rates(
        &self,
        model: &dyn MechanismModel,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        slopes: &mut [f64],
    ) {
        let n = slopes.len();
        slopes.fill(0.0);
        let mut rates = [0.0; MAX_STATES];
        let mut add = |share: f64, model: &dyn MechanismModel, conditions: &Conditions| {
            model.rates(conditions, t, y, &mut rates[..n]);
            slopes.iter_mut().zip(&rates).for_each(|(slope, rate)| *slope += share * rate);
        };
        match &self.0 {
            Of::Input(seed) => {
                for (conditions, share) in under(conditions, t, seed) {
                    add(share, model, &conditions);
                }
            }
            Of::Parameter(levels) => {
                let level = levels.suitable(model, conditions, t, y);
                for Neighbour { weight, model, .. } in &level.neighbours {
                    add(weight / level.step, model.as_ref(), conditions);
                }
            }
        }
    }

    /// Derivatives of the penetration and of the approach speed of every contact at constant state.
    ///
    /// An eccentricity is smooth within a part of itself, and lengths are many times as large: of all steps, two
    /// neighbouring ones that agree best are short enough, and long enough for rounding.
    pub fn approaches(&self, t: f64, y: &[f64]) -> [[f64; 2]; CONTACTS] {
        let Of::Parameter(levels) = &self.0 else { return [[0.0; 2]; CONTACTS] };
        let all: Vec<_> = (0..LEVELS).map(|place| levels.at(place).approaches(t, y)).collect();
        std::array::from_fn(|contact| {
            std::array::from_fn(|i| {
                let pairs = all.windows(2).map(|pair| (pair[0][contact][i], pair[1][contact][i]));
                let apart = |pair: &(f64, f64)| (pair.0 - pair.1).abs();
                pairs.min_by(|a, b| apart(a).total_cmp(&apart(b))).map_or(0.0, |pair| pair.1)
            })
        })
    }
}

impl Neighbour {
    fn new(scene: &Scene, weight: f64) -> Result<Self, SimulationError> {
        let model = assemble::model(scene);
        let mut states = vec![0.0; model.layout().states];
        model.write_start(&pose(scene)?, &mut states);
        let approach = model.start_contacts(0.0, &states).map(|contact| contact.approach);
        Ok(Self { weight, model, observer: Observer::new(scene), start: (states, approach) })
    }
}

impl Levels {
    /// The neighbours at a step, assembled once.
    fn at(&self, place: usize) -> &Level {
        let Some(cell) = place.checked_sub(1).and_then(|place| self.shorter.get(place)) else { return &self.widest };
        match cell.get() {
            Some(level) => level,
            None => match Level::new(&self.scene, self.parameter, step_at(self.widest.step, place)) {
                Ok(level) => cell.get_or_init(|| level),
                // They lie between those at the longest step, which are legal.
                Err(_) => &self.widest,
            },
        }
    }

    /// The neighbours of `model` that suit the state.
    fn suitable(&self, model: &dyn MechanismModel, conditions: &Conditions, t: f64, y: &[f64]) -> &Level {
        let here = Distances::at(model, conditions, t, y);
        let Level { step, neighbours } = self.at(MEASURED);
        let of = |neighbour: &Neighbour| Distances::at(neighbour.model.as_ref(), conditions, t, y);
        let longest = here.longest(*step, &std::array::from_fn(|i| of(&neighbours[i])));
        let by_slope = place_of(self.widest.step, longest);
        // Across an eccentricity a long step changes it by much, whatever its slope is.
        let keeps = |place: &usize| self.at(*place).neighbours.iter().all(|neighbour| here.is_near(&of(neighbour)));
        self.at((by_slope..LEVELS - 1).find(keeps).unwrap_or(LEVELS - 1))
    }
}

impl Level {
    fn new(scene: &Scene, parameter: &'static Parameter, step: f64) -> Result<Self, SimulationError> {
        let value = parameter.value(scene);
        let neighbours = CENTRAL.iter().map(|(place, weight)| {
            let mut changed = scene.clone();
            let refused = |reason: String| {
                let name = parameter.name;
                SimulationError::Scene(format!("{name} = {value} has no neighbours to differentiate by: {reason}"))
            };
            parameter.write(&mut changed, value + place * step).map_err(|error| refused(error.to_string()))?;
            changed.check().map_err(|error| refused(error.to_string()))?;
            Neighbour::new(&changed, *weight)
        });
        Ok(Self { step, neighbours: neighbours.collect::<Result<_, SimulationError>>()? })
    }

    fn approaches(&self, t: f64, y: &[f64]) -> [[f64; 2]; CONTACTS] {
        let mut slopes = [[0.0; 2]; CONTACTS];
        for Neighbour { weight, model, .. } in &self.neighbours {
            for (slopes, (depth, rate)) in slopes.iter_mut().zip(model.approaches(t, y)) {
                if depth.is_finite() {
                    slopes[0] += weight * depth / self.step;
                    slopes[1] += weight * rate / self.step;
                }
            }
        }
        slopes
    }
}

/// The longest step of a parameter.
fn longest(parameter: &Parameter, scene: &Scene) -> f64 {
    match (parameter.value(scene).abs(), &parameter.kind) {
        (0.0, Kind::Real { max, .. }) => (OF_RANGE * max).min(MOST * LONGEST),
        (size, _) => LONGEST * size,
    }
}

/// Distances of a state from where the rates are not smooth.
#[derive(Clone, Copy)]
struct Distances {
    penetrations: [f64; CONTACTS],
    corners: Discontinuities,
}

impl Distances {
    /// Whether none of these differs from that of a neighbour, which is up to two steps away, by much more than it may.
    fn is_near(&self, other: &Self) -> bool {
        let near =
            |share: f64, own: f64, other: f64| !own.is_finite() || (other - own).abs() <= 4.0 * share * own.abs();
        let mut corners = self.corners.values().iter().zip(other.corners.values());
        let mut penetrations = self.penetrations.iter().zip(&other.penetrations);
        penetrations.all(|(own, other)| near(LARGEST_CHANGE, *own, *other))
            && corners.all(|(own, other)| near(NEAREST_CORNER, *own, *other))
    }

    fn at(model: &dyn MechanismModel, conditions: &Conditions, t: f64, y: &[f64]) -> Self {
        let mut corners = Discontinuities::NONE;
        model.discontinuities(conditions, t, y, &mut corners);
        Self { penetrations: model.approaches(t, y).map(|(depth, _)| depth), corners }
    }

    /// The longest step that changes none of these by much. `others` are the distances after a `step`, at [`CENTRAL`]'s
    /// places.
    fn longest(&self, step: f64, others: &[Self; CENTRAL.len()]) -> f64 {
        let limit = |share: f64, own: f64, of: &dyn Fn(&Self) -> f64| {
            let slope = others.iter().zip(CENTRAL).map(|(other, (_, weight))| weight * of(other)).sum::<f64>() / step;
            if own.is_finite() && slope != 0.0 { share * (own / slope).abs() } else { f64::INFINITY }
        };
        let penetrations = self.penetrations.iter().enumerate();
        let corners = self.corners.values().iter().enumerate();
        let by_contact = penetrations.map(|(i, own)| limit(LARGEST_CHANGE, *own, &|other| other.penetrations[i]));
        let by_corner = corners.map(|(i, own)| limit(NEAREST_CORNER, *own, &|other| other.corners.values()[i]));
        by_contact.chain(by_corner).fold(f64::INFINITY, f64::min)
    }
}

/// The step of a level if that of the first is `first`.
fn step_at(first: f64, level: usize) -> f64 {
    first * RATIO.powi(level as i32)
}

/// The level of the longest step that is not longer than `longest`, or of the shortest of all.
fn place_of(first: f64, longest: f64) -> usize {
    (0..LEVELS - 1).find(|level| step_at(first, *level) <= longest).unwrap_or(LEVELS - 1)
}

/// Conditions under two values of an input, with their weights in a difference.
fn under(conditions: &Conditions, t: f64, seed: &Seed) -> [(Conditions, f64); 2] {
    let here = conditions.inputs.at(t);
    let size = here.crank_torque.abs().max(here.slider_load.abs()).max(1.0);
    [size, -size].map(|change| {
        let mut conditions = *conditions;
        let value = &mut conditions.inputs.value;
        match seed {
            Seed::CrankTorque => value.crank_torque += change,
            _ => value.slider_load += change,
        }
        (conditions, 0.5 / change)
    })
}

/// Derivatives of the outputs by what the neighbours differ in, at constant state.
pub fn derivative(
    neighbours: &Neighbours,
    model: &dyn MechanismModel,
    observer: &Observer,
    conditions: &Conditions,
    t: f64,
    y: &[f64],
) -> Outputs {
    match &neighbours.0 {
        Of::Input(seed) => {
            sum(under(conditions, t, seed)
                .map(|(conditions, share)| (observe(model, observer, &conditions, t, y), share)))
        }
        Of::Parameter(levels) => {
            let level = levels.suitable(model, conditions, t, y);
            let terms = level.neighbours.iter().map(|Neighbour { weight, model, observer, .. }| {
                (observe(model.as_ref(), observer, conditions, t, y), weight / level.step)
            });
            sum(terms)
        }
    }
}

/// Derivatives of the outputs along a direction of states and, below them, of approach speeds.
pub fn along(
    model: &dyn MechanismModel,
    observer: &Observer,
    conditions: &Conditions,
    t: f64,
    y: &[f64],
    direction: &[f64],
) -> Outputs {
    if direction.iter().all(|slope| *slope == 0.0) {
        // A difference would be a rounding error.
        return Outputs::default();
    }
    let n = y.len();
    let scaled = direction.iter().zip(model.scales()).filter(|(_, scale)| **scale > 0.0);
    let longest = scaled.map(|(slope, scale)| (slope / scale).abs()).fold(0.0, f64::max);
    let remembered = conditions.contacts.iter().zip(&direction[n..]).filter(|(contact, _)| contact.closed);
    let longest = remembered.map(|(contact, slope)| (slope / contact.approach).abs()).fold(longest, f64::max);
    let moved = |step: f64| {
        let moved: Vec<f64> = y.iter().zip(direction).map(|(y, slope)| y + step * slope).collect();
        let mut conditions = *conditions;
        for (contact, slope) in
            conditions.contacts.iter_mut().zip(&direction[n..]).filter(|(contact, _)| contact.closed)
        {
            let approach = contact.approach + step * slope;
            *contact = ContactState { closed: true, approach, per_approach: 1.0 / approach };
        }
        (moved, conditions)
    };
    let first = if longest > 0.0 { LONGEST / longest } else { 1.0 };
    let second = step_at(first, 1);
    let here = Distances::at(model, conditions, t, y);
    let others = CENTRAL.map(|(place, _)| {
        let (moved, conditions) = moved(place * second);
        Distances::at(model, &conditions, t, &moved)
    });
    let step = step_at(first, place_of(first, here.longest(second, &others)));
    sum(CENTRAL.map(|(place, weight)| {
        let (moved, conditions) = moved(place * step);
        (observe(model, observer, &conditions, t, &moved), weight / step)
    }))
}

/// Σ share·outputs.
fn sum(terms: impl IntoIterator<Item = (Outputs, f64)>) -> Outputs {
    terms.into_iter().fold(Outputs::default(), |sum, (outputs, share)| {
        sum.combined(&outputs, |sum, value| if share == 0.0 { sum } else { sum + share * value })
    })
}
