//! Errors of a simulation.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Errors of a simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SimulationError {
    /// The scene is inconsistent; the text names the parameter and the allowed values.
    Scene(String),
    /// The integrator stopped at `time`; the state at that time is valid and can be used.
    Integration {
        /// [s] Last time reached, relative to the start.
        time: f64,
        /// The cause, in one line.
        cause: String,
        /// Whether no step can lead on from there, however short and under whatever inputs.
        dead_end: bool,
    },
    /// A snapshot does not fit the scene.
    Snapshot(String),
    /// The motion has no derivative, because a contact closes or opens too slowly, or just fails to.
    Grazing {
        /// [s] When, relative to the start.
        time: f64,
        /// What grazes, in words.
        contact: String,
    },
}

impl SimulationError {
    /// The same error with times of an importer whose run started at `start` [s].
    pub fn counted_from(self, start: f64) -> Self {
        match self {
            Self::Integration { time, cause, dead_end } => Self::Integration { time: start + time, cause, dead_end },
            Self::Grazing { time, contact } => Self::Grazing { time: start + time, contact },
            other => other,
        }
    }
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(text) | Self::Snapshot(text) => f.write_str(text),
            Self::Integration { time, cause, .. } => write!(f, "at t = {time:.9} s: {cause}"),
            Self::Grazing { time, contact } => {
                write!(f, "at t = {time:.9} s: {contact} grazes, so that the motion has no derivative there")
            }
        }
    }
}

impl std::error::Error for SimulationError {}
