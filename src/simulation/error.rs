//! Why a simulation cannot start or go on.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a simulation cannot start or go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SimulationError {
    /// The scene contradicts itself; the text names the parameter and what is allowed.
    Scene(String),
    /// The integrator gave up at `time`; the state is that of `time`, still usable.
    Integration {
        /// [s] Last time reached.
        time: f64,
        /// One line: component and cause.
        cause: String,
        /// Whether no step can lead on from there, however short and under whatever inputs.
        dead_end: bool,
    },
    /// A snapshot does not fit this scene.
    Snapshot(String),
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(text) | Self::Snapshot(text) => f.write_str(text),
            Self::Integration { time, cause, .. } => write!(f, "at t = {time:.9} s: {cause}"),
        }
    }
}

impl std::error::Error for SimulationError {}
