//! A simulation: model, state and integrator of a mechanism in motion.

mod assemble;
mod contacts;
mod derivatives;
mod equations;
mod error;
mod hosted;
mod interval;
mod linearization;
mod motion;
mod names;
mod observation;
mod phase;
mod record;
mod run;
mod settings;
mod side;
mod start;
pub mod step_map;
mod system;
mod time_stepping;
pub mod variation;

pub use crate::integrator::Snapshot;
pub use contacts::{CONTACTS, ContactReport, PINS, contacts, subject};
pub use equations::Size;
pub use error::SimulationError;
pub use hosted::{Direction, HostedMechanism, Update, nominals};
pub use linearization::Linearization;
pub use phase::{Phase, PhaseScales};
pub use side::Side;
pub use system::System;

use crate::integrator::{IntegrationError, MAX_STATES, Reader, WorkLimit};
use crate::model::drive::InputSignal;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use motion::Motion;
use names::Names;
use observation::with_settings;

/// A mechanism at a communication point.
///
/// - No call allocates after [`Simulation::start`], except `snapshot` and `restore`.
/// - While the inputs keep the same bits, any split of an interval gives the same bits.
/// - Inputs are not checked: the caller must keep them finite.
pub struct Simulation {
    motion: Box<dyn Motion>,
    names: Names,
    time: f64,
    /// As the scene has it.
    tolerance: f64,
    side: Side,
    work_limit: WorkLimit,
    allowance: Allowance,
}

/// Work that an advance by single steps may take, as much as one that does not stop.
#[derive(Clone, Copy, Default)]
struct Allowance {
    /// [s] Where it ends.
    until: f64,
    /// Evaluations of the rates when it began.
    from: u64,
    /// Evaluations from there on.
    most: u64,
}

impl Simulation {
    /// Assembles the mechanism of a scene and sets it to its start pose. The time is 0 there.
    ///
    /// # Errors
    /// `Scene` if the loop does not close in the start pose, or if the method does not support the scene.
    pub fn start(scene: &Scene, inputs: Inputs) -> Result<Self, SimulationError> {
        scene.check_method().map_err(|error| SimulationError::Scene(error.to_string()))?;
        let (motion, tolerance) = (start::start(scene, inputs)?, scene.solver.tolerance);
        let (work_limit, allowance) = (settings::settings(scene).effort, Allowance::default());
        let names = Names::of(scene);
        Ok(Self { motion, names, time: 0.0, tolerance, side: Side::After, work_limit, allowance })
    }

    /// [s] The communication point reached, relative to the start.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets the inputs and their first time derivatives from the communication point on: u(t) = `inputs` + `rates`·(t −
    /// time). Inputs with the same bits as the present ones change nothing.
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        self.motion.set_inputs(InputSignal { at: self.time, value: inputs, rate: rates });
    }

    /// Advances to `time` [s], which must not be less than the time reached.
    ///
    /// # Errors
    /// `Integration`; the simulation is then at the last time reached, and its outputs, `snapshot` and `restore` can
    /// still be used.
    pub fn advance_to(&mut self, time: f64) -> Result<(), SimulationError> {
        self.begin_interval();
        self.side = Side::After;
        match self.motion.advance(time) {
            Ok(()) => {
                self.time = time;
                Ok(())
            }
            Err(error) => Err(self.failed(error)),
        }
    }

    /// Advances to the next opening or closing of a contact, or to `time` [s] (not less than the time reached). Returns
    /// whether there was such an event.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_to_event(&mut self, time: f64) -> Result<bool, SimulationError> {
        self.begin_interval();
        self.side = Side::After;
        match self.motion.advance_to_event(self.time, time) {
            Ok(event) => {
                self.time = event.unwrap_or(time);
                Ok(event.is_some())
            }
            Err(error) => Err(self.failed(error)),
        }
    }

    /// Begins an interval at the communication point, from which outputs such as `joint.C.impact.speed` are counted.
    /// Only [`Simulation::advance_by_step`] does not begin one itself.
    pub fn begin_interval(&mut self) {
        self.motion.begin_interval(self.time);
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
        let moved = self.check_work(time).and_then(|()| self.motion.advance(next)).and_then(|()| {
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

    /// Refuses a single step on the way to `time` if those before took more work than an advance to there may take.
    fn check_work(&mut self, time: f64) -> Result<(), IntegrationError> {
        let now = self.motion.evaluations();
        if self.time >= self.allowance.until || time > self.allowance.until {
            self.allowance = Allowance { until: time, from: now, most: self.work_limit.over(time - self.time) };
        }
        let evaluations = now - self.allowance.from;
        if evaluations > self.allowance.most {
            return Err(IntegrationError::TooMuchWork { time: self.time, evaluations });
        }
        Ok(())
    }

    /// Looks from now on at this side of the events at the communication point, until time moves.
    pub fn look(&mut self, side: Side) {
        self.side = side;
    }

    /// Sets the time to that of the error, and converts the error.
    fn failed(&mut self, error: IntegrationError) -> SimulationError {
        self.time = self.time.max(error.time());
        self.names.explain(error)
    }

    /// Outputs at the communication point.
    pub fn outputs(&mut self) -> Outputs {
        with_settings(self.motion.outputs(self.time, self.side), self.tolerance)
    }

    /// First time derivatives of the real outputs at the communication point; integers and Booleans are meaningless.
    pub fn output_rates(&mut self) -> Outputs {
        self.motion.output_rates(self.time, self.side)
    }

    /// Derivative of the real outputs with respect to the inputs in the direction `seed`, at constant states; integers
    /// and Booleans are meaningless.
    pub fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        self.motion.output_sensitivity(self.time, seed, self.side)
    }

    /// The contacts at the communication point. Those change that close or open at the events there, on whichever side.
    pub fn contacts(&mut self) -> ContactReport {
        self.motion.contacts(self.time, self.side)
    }

    /// Writes the states at the communication point and their rates; how many there are.
    pub fn write_states(&mut self, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize {
        self.motion.write_states(self.time, states, rates)
    }

    /// Size of the equations of motion.
    pub fn size(&self) -> Size {
        self.motion.size()
    }

    /// The point of phase space at the communication point. A step that extends beyond the point is repeated so that it
    /// ends there. The point then has the accuracy of steps, not that of interpolation. Later steps differ from those
    /// without this call.
    pub fn phase(&mut self) -> Phase {
        self.motion.phase(self.time)
    }

    /// Continues from `phase`, a point of a simulation with the same joints, drive and method, or near one. The inputs
    /// are kept. An open contact that penetrates closes, and a closed one across a gap opens.
    pub fn place(&mut self, phase: &Phase) {
        self.motion.place(self.time, phase);
        self.time = phase.time;
    }

    /// Scales of just noticeable differences in a point of phase space.
    pub fn phase_scales(&self) -> PhaseScales {
        self.motion.phase_scales()
    }

    /// [s] Time and states at the start of the next step.
    pub fn front(&self) -> (f64, Vec<f64>) {
        self.motion.front()
    }

    /// Rates of the `states` at `time` [s], with the contact states at the start of the next step; missing states count
    /// as 0.
    pub fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        self.motion.rates_at(time, states)
    }

    /// The linearization of the equations of motion at `states` and `time` [s], with the same contact states.
    pub fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        self.motion.linearization_at(time, states)
    }

    /// Evaluates the equations of motion `times` times at the start of the next step and discards the results, for
    /// benchmarks.
    pub fn evaluate(&self, times: usize) {
        self.motion.evaluate(times);
    }

    /// Evaluates the Jacobian of the equations of motion `times` times and discards the results, for benchmarks.
    pub fn differentiate(&self, times: usize) {
        self.motion.differentiate(times);
    }

    /// A snapshot of the simulation, from which it can be restored.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        snapshot.reals.push(self.time);
        self.motion.save(&mut snapshot);
        snapshot
    }

    /// A simulation of `scene` that continues where `snapshot` was taken.
    ///
    /// # Errors
    /// `Snapshot` if it is not from a run of a scene with these joints and this drive; `Scene` as in
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
