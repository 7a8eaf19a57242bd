//! The equations of motion of a scene for an external integrator: right-hand side, event functions and event handling.

use super::equations::{Equations, Size};
use super::error::SimulationError;
use super::start::start;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;

/// The equations of motion of a scene, with their present contact states.
///
/// The states are positions, their rates and first-order states, in the order of the internal integrator. Contact
/// states change only in [`System::cross`]. Between events the right-hand side is smooth, except for derivative
/// discontinuities of friction and force laws.
pub struct System {
    equations: Box<dyn Equations>,
}

impl System {
    /// The equations of `scene`, whose time starts at 0, under constant `inputs`.
    ///
    /// # Errors
    /// `Scene` if the loop does not close in the start pose.
    pub fn start(scene: &Scene, inputs: Inputs) -> Result<Self, SimulationError> {
        Ok(Self { equations: start(scene, inputs)?.equations() })
    }

    /// Numbers of degrees of freedom, states and event functions.
    pub fn size(&self) -> Size {
        self.equations.size()
    }

    /// Writes the start state.
    pub fn write_start(&self, y: &mut [f64]) {
        self.equations.write_start(y);
    }

    /// Writes the scales of the states: sizes of just tolerable errors, in the unit of each state.
    pub fn write_scales(&self, scales: &mut [f64]) {
        self.equations.write_scales(scales);
    }

    /// [s] Upper bound of a step for which no event is missed.
    pub fn longest_step(&self) -> f64 {
        self.equations.longest_step()
    }

    /// Writes the rates of the state `y` at `t` [s].
    #[inline]
    pub fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        self.equations.write_rates(t, y, rates);
    }

    /// Writes the event functions; an event happens when one of them falls through zero.
    #[inline]
    pub fn write_event_functions(&self, t: f64, y: &[f64], event_functions: &mut [f64]) {
        self.equations.write_event_functions(t, y, event_functions);
    }

    /// Opens or closes the contacts of the event functions in `crossed`, and of all others that are at or below zero
    /// and falling.
    pub fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]) {
        self.equations.cross(t, y, crossed);
    }

    /// Resets the contact states to those of the start.
    pub fn restart(&mut self) {
        self.equations.restart();
    }

    /// Outputs of the state `y` at `t` [s] with the present contact states.
    pub fn outputs(&self, t: f64, y: &[f64]) -> Outputs {
        self.equations.outputs(t, y)
    }
}
