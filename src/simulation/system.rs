//! The equations of motion of a scene for an integrator that is not ours: right-hand side, event
//! functions, and what happens at an event.

use super::equations::{Equations, Size};
use super::error::SimulationError;
use super::start::start;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;

/// A scene's equations, with the contacts as they are now.
///
/// States are positions, as many rates of theirs, and what else is integrated, in the order in which
/// our own integrator has them. Contacts change only in [`System::cross`]: between two events the
/// right-hand side is smooth but for friction's and the force law's own discontinuities.
pub struct System {
    equations: Box<dyn Equations>,
}

impl System {
    /// The equations of `scene`, whose time starts at 0, under constant `inputs`.
    ///
    /// # Errors
    /// `Scene` if the start position does not close the loop.
    pub fn start(scene: &Scene, inputs: Inputs) -> Result<Self, SimulationError> {
        Ok(Self { equations: start(scene, inputs)?.equations() })
    }

    /// How many freedoms, states and event functions there are.
    pub fn size(&self) -> Size {
        self.equations.size()
    }

    /// Writes the start state.
    pub fn write_start(&self, y: &mut [f64]) {
        self.equations.write_start(y);
    }

    /// Writes what size of error is just noticeable in each state: our error norm's weights over the
    /// tolerance.
    pub fn write_scales(&self, scales: &mut [f64]) {
        self.equations.write_scales(scales);
    }

    /// [s] No step of ours is longer, so that no event is missed.
    pub fn longest_step(&self) -> f64 {
        self.equations.longest_step()
    }

    /// Writes the rates of the state `y` at `t` [s].
    #[inline]
    pub fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        self.equations.write_rates(t, y, rates);
    }

    /// Writes the event functions: an event happens when one falls through zero.
    #[inline]
    pub fn write_event_functions(&self, t: f64, y: &[f64], event_functions: &mut [f64]) {
        self.equations.write_event_functions(t, y, event_functions);
    }

    /// Opens or closes the contacts of the event functions in `crossed`, and of all others that are at or
    /// below zero and falling.
    pub fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]) {
        self.equations.cross(t, y, crossed);
    }

    /// Takes the contacts of the start again.
    pub fn restart(&mut self) {
        self.equations.restart();
    }

    /// Outputs of the state `y` at `t` [s] with the contacts as they are now.
    pub fn outputs(&self, t: f64, y: &[f64]) -> Outputs {
        self.equations.outputs(t, y)
    }
}
