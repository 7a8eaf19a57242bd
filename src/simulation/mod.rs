//! Model, state and integrator: a mechanism that moves through time.

mod assemble;
mod derivatives;
mod equations;
mod error;
mod linearization;
mod motion;
mod observation;
mod phase;
mod record;
mod run;
mod settings;
mod side;
mod start;
mod system;
mod time_stepping;

pub use crate::integrator::Snapshot;
pub use equations::Size;
pub use error::SimulationError;
pub use linearization::Linearization;
pub use phase::{Phase, PhaseScales};
pub use side::Side;
pub use system::System;

use crate::integrator::{IntegrationError, Reader};
use crate::model::drive::InputSignal;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use motion::Motion;

/// A mechanism at one communication point, ready to go on.
///
/// - Nothing is allocated after [`Simulation::start`] but by `snapshot` and `restore`.
/// - While inputs stay the same (to the bit), any split of an interval gives the same bits.
/// - Inputs are taken as they are: the caller keeps them finite.
pub struct Simulation {
    motion: Box<dyn Motion>,
    time: f64,
    side: Side,
}

/// The only end that a mechanism's equations of motion have.
const DEAD_END: &str = "the rod stands across the guide, where ideal joints leave open which way the slider goes on";

impl Simulation {
    /// Assembles the scene's mechanism and puts it in its start position. Time is counted from here.
    ///
    /// # Errors
    /// `Scene` if the start position does not close the loop, or the method cannot do what the scene asks for.
    pub fn start(scene: &Scene, inputs: Inputs) -> Result<Self, SimulationError> {
        scene.check_method().map_err(|error| SimulationError::Scene(error.to_string()))?;
        Ok(Self { motion: start::start(scene, inputs)?, time: 0.0, side: Side::After })
    }

    /// [s] The communication point reached, counted from the start.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets inputs and their first time derivatives from the communication point on:
    /// u(t) = `inputs` + `rates`·(t − time). The same bits as those in force change nothing.
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        self.motion.set_inputs(InputSignal { at: self.time, value: inputs, rate: rates });
    }

    /// Moves to `time` (≥ the time reached).
    ///
    /// # Errors
    /// `Integration`; the simulation is then at the last time that it reached and can still be asked,
    /// saved and restored.
    pub fn advance_to(&mut self, time: f64) -> Result<(), SimulationError> {
        self.side = Side::After;
        match self.motion.advance(time) {
            Ok(()) => {
                self.time = time;
                Ok(())
            }
            Err(error) => Err(self.failed(error)),
        }
    }

    /// Moves to the next closing or opening of a contact, or to `time` (≥ the time reached), and tells whether there
    /// was one.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_to_event(&mut self, time: f64) -> Result<bool, SimulationError> {
        self.side = Side::After;
        match self.motion.advance_to_event(self.time, time) {
            Ok(event) => {
                self.time = event.unwrap_or(time);
                Ok(event.is_some())
            }
            Err(error) => Err(self.failed(error)),
        }
    }

    /// Moves to the end of the next step of the method, or to `time` (≥ the time reached), and tells whether a contact
    /// has closed or opened there. The steps are the same as those of [`Simulation::advance_to`].
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_by_step(&mut self, time: f64) -> Result<bool, SimulationError> {
        self.side = Side::After;
        let after = self.time;
        let next = after.next_up().min(time);
        let moved = self.motion.advance(next).and_then(|()| {
            let reached = self.motion.front_time().min(time);
            Ok((reached, self.motion.advance_to_event(after, reached)?))
        });
        match moved {
            Ok((reached, event)) => {
                self.time = reached;
                Ok(event.is_some())
            }
            Err(error) => Err(self.failed(error)),
        }
    }

    /// Looks from now on at this side of the events at the communication point, until time moves.
    pub fn look(&mut self, side: Side) {
        self.side = side;
    }

    /// Stays where it could not go on.
    fn failed(&mut self, error: IntegrationError) -> SimulationError {
        self.time = self.time.max(error.time());
        let cause = match error {
            IntegrationError::DeadEnd { .. } => DEAD_END.to_owned(),
            IntegrationError::TooMuchWork { .. } => format!("{error}; see solver.max_evaluations"),
            _ => error.to_string(),
        };
        SimulationError::Integration { time: error.time(), cause }
    }

    /// Outputs at the communication point.
    pub fn outputs(&mut self) -> Outputs {
        self.motion.outputs(self.time, self.side)
    }

    /// First time derivatives of the real outputs at the communication point; its integers and
    /// Booleans are without meaning.
    pub fn output_rates(&mut self) -> Outputs {
        self.motion.output_rates(self.time, self.side)
    }

    /// Derivative of the real outputs with respect to the inputs along `seed`, state held; its
    /// integers and Booleans are without meaning.
    pub fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        self.motion.output_sensitivity(self.time, seed, self.side)
    }

    /// How large its equations of motion are.
    pub fn size(&self) -> Size {
        self.motion.size()
    }

    /// The point of phase space at the communication point. A step that goes beyond is cut there, so that the point is as
    /// accurate as the steps are and not as what is interpolated between them; later steps are others than without a look.
    pub fn phase(&mut self) -> Phase {
        self.motion.phase(self.time)
    }

    /// Goes on from `phase`: one of a simulation with the same joints, drive and method, or near one. Inputs stay.
    pub fn place(&mut self, phase: &Phase) {
        self.motion.place(phase);
        self.time = phase.time;
    }

    /// What size of difference is noticeable.
    pub fn phase_scales(&self) -> PhaseScales {
        self.motion.phase_scales()
    }

    /// [s] Time and states where the next step starts.
    pub fn front(&self) -> (f64, Vec<f64>) {
        self.motion.front()
    }

    /// Rates of the `states` at `time` [s] with the contacts closed that are so where the next step
    /// starts; states that are missing count as 0.
    pub fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        self.motion.rates_at(time, states)
    }

    /// The equations of motion near `states` and `time` [s], with the same contacts.
    pub fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        self.motion.linearization_at(time, states)
    }

    /// Evaluates the equations of motion so many times, for nothing: where the next step starts, to be timed.
    pub fn evaluate(&self, times: usize) {
        self.motion.evaluate(times);
    }

    /// Evaluates their derivatives so many times, likewise.
    pub fn differentiate(&self, times: usize) {
        self.motion.differentiate(times);
    }

    /// All that is needed to go on from here.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        snapshot.reals.push(self.time);
        self.motion.save(&mut snapshot);
        snapshot
    }

    /// A simulation of `scene` that goes on where `snapshot` was taken.
    ///
    /// # Errors
    /// `Snapshot` if it is not one of a run of a scene with these joints and this drive; `Scene` as in
    /// [`Simulation::start`].
    pub fn restore(scene: &Scene, snapshot: &Snapshot) -> Result<Self, SimulationError> {
        let mut simulation = Self::start(scene, Inputs::default())?;
        let mut reader = Reader::new(snapshot);
        let restored = reader.real().filter(|&time| simulation.motion.load(time, &mut reader).is_some());
        match restored {
            Some(time) if reader.is_at_end() => {
                simulation.time = time;
                Ok(simulation)
            }
            _ => Err(SimulationError::Snapshot(
                "the saved state is not one of a run of a scene with these joints and this drive".into(),
            )),
        }
    }
}
