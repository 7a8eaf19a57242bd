//! What a simulation asks of a mechanism under a method.

use super::equations::{Equations, Size};
use super::linearization::Linearization;
use super::phase::{Phase, PhaseScales};
use super::side::Side;
use crate::integrator::{IntegrationError, Reader, Snapshot};
use crate::model::drive::InputSignal;
use crate::model::signals::{Inputs, Outputs};

/// A mechanism in motion, whatever its size.
pub trait Motion: Send {
    /// Steps until `t` lies within the last step.
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError>;
    /// Steps until `t` lies within the last step, or to an event after `after`, and tells when that was.
    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError>;
    /// The point of phase space at `t` in the last step.
    fn phase(&mut self, t: f64) -> Phase;
    /// Starts anew from such a point.
    fn place(&mut self, phase: &Phase);
    /// What size of difference is noticeable in a point of phase space.
    fn phase_scales(&self) -> PhaseScales;
    /// Sets the inputs from the communication point `inputs.at` on.
    fn set_inputs(&mut self, inputs: InputSignal);
    /// Outputs at `t` in the last step, on this side of the events there.
    fn outputs(&mut self, t: f64, side: Side) -> Outputs;
    /// Their time derivatives.
    fn output_rates(&mut self, t: f64, side: Side) -> Outputs;
    /// Their derivatives with respect to the inputs, along `seed`.
    fn output_sensitivity(&mut self, t: f64, seed: Inputs, side: Side) -> Outputs;
    /// How large it is.
    fn size(&self) -> Size;
    /// Evaluates the right-hand side where the next step starts.
    fn evaluate(&self, times: usize);
    /// Its equations, from where the next step starts.
    fn equations(self: Box<Self>) -> Box<dyn Equations>;
    /// Evaluates its derivatives there.
    fn differentiate(&self, times: usize);
    /// [s] Time there.
    fn front_time(&self) -> f64;
    /// Time and states there.
    fn front(&self) -> (f64, Vec<f64>);
    /// Rates of the right-hand side that holds there.
    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64>;
    /// The same, with derivatives.
    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization;
    /// Appends all that it remembers.
    fn save(&self, snapshot: &mut Snapshot);
    /// Takes back what `save` appended of a run at `time` [s]; `None` if it does not fit.
    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()>;
}
