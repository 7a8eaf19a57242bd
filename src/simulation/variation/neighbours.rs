//! Mechanisms that differ a little in one parameter, and derivatives from their differences.
//!
//! A mechanism is assembled from numbers without derivatives, so that derivatives by a parameter are differences
//! ([`line`](super::line)). What a length does to a closed contact at a constant state, and what the bodies do that have
//! moved with it, cancel nearly, to less than a thousandth; an error of either would be a thousand times as large
//! in their sum. Two measures keep derivatives exact there: rates and outputs are differentiated along the parameter and the
//! states together, and penetrations by their chain rule through the pose, which is smooth in every length.

use super::levels::{CENTRAL, Levels, Neighbour};
use super::line::{DIRECTION, Line, plus, sum};
use super::seed::Seed;
use crate::integrator::MAX_STATES;
use crate::integrator::tangent::Companion;
use crate::math::add_multiple;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::scalar::{DIRECTIONS, Tangent};
use crate::model::signals::Outputs;
use crate::model::state::{CONTACTS, Conditions, Pose};
use crate::scene::Scene;
use crate::scene::parameter::Parameter;
use crate::simulation::error::SimulationError;
use crate::simulation::observation::observe;

/// What the neighbours differ in.
enum Of {
    Parameter(Box<Levels>),
    /// Outputs and rates are affine in the inputs, …
    Input(Seed),
    /// … and in the slopes of their lines, with the time since the communication point as a factor.
    Slope(Seed),
}

/// Neighbours of a mechanism along one parameter or input, or along the slope of an input.
pub struct Neighbours(Of);

impl Neighbours {
    /// Neighbours along a real parameter of `scene`.
    ///
    /// # Errors
    /// `Scene` if a neighbour cannot be assembled: the parameter is at an end of its range.
    pub fn of_parameter(scene: &Scene, parameter: &'static Parameter) -> Result<Self, SimulationError> {
        Ok(Self(Of::Parameter(Box::new(Levels::new(scene, parameter)?))))
    }

    /// Neighbours along an input.
    pub fn of_input(seed: Seed) -> Self {
        Self(Of::Input(seed))
    }

    /// Neighbours along the slope of an input.
    pub fn of_slope(seed: Seed) -> Self {
        Self(Of::Slope(seed))
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
        let level = levels.at(0);
        for (Neighbour { start: (states, approach), .. }, (_, weight)) in level.neighbours.iter().zip(CENTRAL) {
            let values = states.iter().chain(approach);
            direction.iter_mut().zip(values).for_each(|(slope, value)| *slope += weight * value / level.step);
        }
    }

    /// Writes the derivatives of the rates of `model`, which these are neighbours of, at constant state.
    pub fn write_rates(
        &self,
        model: &dyn MechanismModel,
        conditions: &Conditions,
        t: f64,
        y: &[f64],
        companion: &Companion<'_>,
        slopes: &mut [f64],
    ) {
        match &self.0 {
            Of::Input(seed) | Of::Slope(seed) => {
                let n = slopes.len();
                slopes.fill(0.0);
                let mut rates = [0.0; MAX_STATES];
                for (conditions, share) in self.under(conditions, t, seed) {
                    model.rates(&conditions, t, y, &mut rates[..n]);
                    add_multiple(slopes, share, &rates);
                }
            }
            Of::Parameter(levels) => {
                let together = Line { model, conditions, t, y, direction: companion.direction, levels: Some(levels) };
                let mut changed = [0.0; DIRECTION];
                let fitted = together.best(&mut changed);
                fitted.write_rates(slopes);
                Companion { direction: fitted.line.direction, ..*companion }.subtract_from(slopes);
            }
        }
    }

    /// Adds to `moved` the outputs' derivatives by the input or its slope at the state of a line, times its share.
    #[inline(never)]
    pub fn add_input(&self, at: &Line<'_>, observer: &Observer, share: f64, moved: &mut Outputs) {
        let (Of::Input(seed) | Of::Slope(seed)) = &self.0 else { return };
        let Line { model, t, y, .. } = *at;
        let terms = self.under(at.conditions, t, seed);
        let effect = sum(terms.map(|(conditions, weight)| (observe(model, observer, &conditions, t, y), weight)));
        *moved = plus(moved, &effect, share);
    }

    /// Derivatives of the outputs along a line of states, below which those of approach speeds stand, and along the parameter
    /// with it, if these are neighbours along one.
    pub fn output_derivative(&self, states: Line<'_>, observer: &Observer) -> Outputs {
        match &self.0 {
            Of::Input(_) | Of::Slope(_) => states.fitted().outputs(observer),
            Of::Parameter(levels) => {
                let (mut changed, direction) = ([0.0; DIRECTION], states.direction);
                let fitted = Line { levels: Some(levels), ..states }.best(&mut changed);
                // What the line's direction lacks is a direction of the states.
                let mut rest = [0.0; DIRECTION];
                rest[..direction.len()].copy_from_slice(direction);
                rest.iter_mut().zip(fitted.line.direction).for_each(|(slope, other)| *slope -= other);
                let rest = Line { direction: &rest[..direction.len()], ..states };
                plus(&rest.fitted().outputs(observer), &fitted.outputs(observer), 1.0)
            }
        }
    }

    /// Conditions under two values of an input, with their weights in a difference by the input or its slope.
    #[inline(never)]
    fn under(&self, conditions: &Conditions, t: f64, seed: &Seed) -> [(Conditions, f64); 2] {
        let here = conditions.inputs.at(t);
        let size = here.crank_torque.abs().max(here.slider_load.abs()).max(1.0);
        let factor = if matches!(self.0, Of::Slope(_)) { t - conditions.inputs.at } else { 1.0 };
        [size, -size].map(|change| {
            let mut conditions = *conditions;
            let value = &mut conditions.inputs.value;
            match seed {
                Seed::CrankTorque => value.crank_torque += change,
                _ => value.slider_load += change,
            }
            (conditions, factor * 0.5 / change)
        })
    }

    /// Derivatives of the penetration and of the approach speed of every contact of `model` at constant state, where its
    /// pose is `here`.
    pub fn approaches(&self, model: &dyn MechanismModel, here: &Pose, t: f64, y: &[f64]) -> [[f64; 2]; CONTACTS] {
        let Of::Parameter(levels) = &self.0 else { return [[0.0; 2]; CONTACTS] };
        let (level, poses) = levels.poses(here, t, y);
        let [a, b, c, d] = &poses;
        let moving = Pose::combined([here, a, b, c, d], &|[value, others @ ..]| {
            let mut slope = [0.0; DIRECTIONS];
            slope[0] = difference(others) / level.step;
            Tangent { value, slope }
        });
        let through_pose = model.tangent_approaches(&moving);
        let others = level.neighbours.each_ref().map(|neighbour| neighbour.model.approaches(here));
        std::array::from_fn(|contact| {
            let ((depth, rate), others) = (through_pose[contact], others.map(|all| all[contact]));
            if !depth.value.is_finite() {
                return [0.0; 2];
            }
            let alone = [others.map(|(depth, _)| depth), others.map(|(_, rate)| rate)];
            let [of_depth, of_rate] = alone.map(|values| difference(values) / level.step);
            [depth.slope[0] + of_depth, rate.slope[0] + of_rate]
        })
    }
}

/// Σ weight·value over the places of [`CENTRAL`].
#[inline(never)]
fn difference(values: [f64; CENTRAL.len()]) -> f64 {
    values.iter().zip(CENTRAL).map(|(value, (_, weight))| weight * value).sum()
}
