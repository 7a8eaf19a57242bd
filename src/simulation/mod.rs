//! Model, state and integrator: a mechanism that moves through time.

mod assemble;
mod derivatives;
mod equations;
mod phase;
mod record;
mod run;
mod system;
mod time_stepping;

pub use crate::integrator::Snapshot;
pub use equations::Linearization;
pub use phase::{Phase, PhaseScales};
pub use system::System;

use crate::integrator::{IntegrationError, Reader};
use crate::model::drive::InputSignal;
use crate::model::signals::{Inputs, Outputs};
use crate::model::start::StartPose;
use crate::scene::Scene;
use run::Motion;
use std::fmt;

/// A mechanism at one communication point, ready to go on.
///
/// - Nothing is allocated after [`Simulation::start`] but by `snapshot` and `restore`.
/// - While inputs stay the same (to the bit), any split of an interval gives the same bits.
/// - Inputs are taken as they are: the caller keeps them finite.
pub struct Simulation {
    motion: Box<dyn Motion>,
    time: f64,
}

/// How large the equations of motion are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Degrees of freedom; a prescribed crank angle is none.
    pub degrees_of_freedom: usize,
    /// States: positions, their rates, and what else is integrated.
    pub states: usize,
    /// Event functions: one of each joint A, B, C with clearance, and four of the guide.
    pub event_functions: usize,
}

/// Why a simulation cannot start or go on.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulationError {
    /// The scene contradicts itself; the text names the parameter and what is allowed.
    Scene(String),
    /// The integrator gave up at `time`; the state is that of `time`, still usable.
    Integration {
        /// [s] Last time reached.
        time: f64,
        /// One line: component and cause.
        cause: String,
    },
    /// A snapshot does not fit this scene.
    Snapshot(String),
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(text) | Self::Snapshot(text) => f.write_str(text),
            Self::Integration { time, cause } => write!(f, "at t = {time:.9} s: {cause}"),
        }
    }
}

impl std::error::Error for SimulationError {}

/// The only end that a mechanism's equations of motion have.
const DEAD_END: &str = "the rod stands across the guide, where ideal joints leave open which way the slider goes on";

/// Where a scene starts.
fn start_pose(scene: &Scene) -> Result<StartPose, SimulationError> {
    StartPose::of(scene).ok_or_else(|| {
        SimulationError::Scene("crank.angle_start: the rod is too short to close the loop at the start".into())
    })
}

impl Simulation {
    /// Assembles the scene's mechanism and puts it in its start position at `time` [s].
    ///
    /// # Errors
    /// `Scene` if the start position does not close the loop, or the method cannot do what the scene asks for.
    pub fn start(scene: &Scene, time: f64, inputs: Inputs) -> Result<Self, SimulationError> {
        scene.check_method().map_err(|error| SimulationError::Scene(error.to_string()))?;
        let pose = start_pose(scene)?;
        let signal = InputSignal { at: time, value: inputs, rate: Inputs::default() };
        Ok(Self { motion: assemble::start(scene, time, &pose, signal), time })
    }

    /// [s] The communication point reached.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets inputs and their first time derivatives from the communication point on:
    /// u(t) = `inputs` + `rates`·(t − time). The same bits as those in force change nothing.
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        self.motion.set_signal(InputSignal { at: self.time, value: inputs, rate: rates });
    }

    /// Moves to `time` (≥ the time reached).
    ///
    /// # Errors
    /// `Integration`; the simulation is then at the last time that it reached and can still be asked,
    /// saved and restored.
    pub fn advance_to(&mut self, time: f64) -> Result<(), SimulationError> {
        match self.motion.advance(time) {
            Ok(()) => {
                self.time = time;
                Ok(())
            }
            Err(error) => Err(self.failed(error)),
        }
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
        self.motion.outputs(self.time)
    }

    /// First time derivatives of the real outputs at the communication point; its integers and
    /// Booleans are without meaning.
    pub fn output_rates(&mut self) -> Outputs {
        self.motion.output_rates(self.time)
    }

    /// Derivative of the real outputs with respect to the inputs along `seed`, state held; its
    /// integers and Booleans are without meaning.
    pub fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        self.motion.output_sensitivity(self.time, seed)
    }

    /// How large its equations of motion are.
    pub fn size(&self) -> Size {
        self.motion.size()
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
        let mut simulation = Self::start(scene, 0.0, Inputs::default())?;
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
