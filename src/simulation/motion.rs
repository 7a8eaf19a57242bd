//! Interface between a simulation and a mechanism with its method.

use super::contacts::ContactReport;
use super::equations::{Equations, Size};
use super::linearization::Linearization;
use super::phase::{Phase, PhaseScales};
use super::side::Side;
use crate::integrator::{IntegrationError, MAX_STATES, Reader, Snapshot};
use crate::model::drive::InputSignal;
use crate::model::signals::{Inputs, Outputs};

/// A mechanism in motion under a method.
pub trait Motion: Send {
    /// Steps until `t` lies within the last step.
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError>;
    /// Steps until `t` lies within the last step or an event after `after` has happened. Returns the time [s] of that
    /// event.
    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError>;
    /// Begins an interval at the communication point `t`, from which outputs such as the largest approach speed are
    /// counted.
    fn begin_interval(&mut self, _: f64) {}
    /// The point of phase space at `t` in the last step.
    fn phase(&mut self, t: f64) -> Phase;
    /// Restarts from a point of phase space, with the sums that there are at `t` in the last step.
    fn place(&mut self, t: f64, phase: &Phase);
    /// Scales of just noticeable differences in a point of phase space.
    fn phase_scales(&self) -> PhaseScales;
    /// Sets the inputs from the communication point `inputs.at` on.
    fn set_inputs(&mut self, inputs: InputSignal);
    /// Outputs at `t` in the last step, on this side of the events there.
    fn outputs(&mut self, t: f64, side: Side) -> Outputs;
    /// Time derivatives of the outputs at `t` in the last step, on this side of the events there.
    fn output_rates(&mut self, t: f64, side: Side) -> Outputs;
    /// Derivatives of the outputs at `t` with respect to the inputs, in the direction `seed`, on this side of the events.
    fn output_sensitivity(&mut self, t: f64, seed: Inputs, side: Side) -> Outputs;
    /// The contacts at `t` in the last step, on this side of the events there.
    fn contacts(&mut self, t: f64, side: Side) -> ContactReport;
    /// Writes the states at `t` in the last step and their rates; how many there are.
    fn write_states(&mut self, t: f64, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize;
    /// Size of the equations of motion.
    fn size(&self) -> Size;
    /// Evaluates the right-hand side `times` times at the start of the next step.
    fn evaluate(&self, times: usize);
    /// The equations of motion, starting at the start of the next step.
    fn equations(self: Box<Self>) -> Box<dyn Equations>;
    /// Evaluates the Jacobian of the right-hand side `times` times at the start of the next step.
    fn differentiate(&self, times: usize);
    /// Time [s] at the start of the next step.
    fn front_time(&self) -> f64;
    /// Evaluations of the rates up to the start of the next step.
    fn evaluations(&self) -> u64;
    /// Time [s] and states at the start of the next step.
    fn front(&self) -> (f64, Vec<f64>);
    /// Rates of `states` at `time` [s] under the conditions at the start of the next step.
    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64>;
    /// Linearization at `states` and `time` [s] under the conditions at the start of the next step.
    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization;
    /// Appends the memory of the run to a snapshot.
    fn save(&self, snapshot: &mut Snapshot);
    /// Restores what `save` appended of a run at `time` [s]; `None` if it does not fit.
    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()>;
}
