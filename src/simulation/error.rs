//! Why a simulation cannot start or go on.

use std::fmt;

/// Why a simulation cannot start or go on.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulationError {
    /// The scene contradicts itself; the text names the parameter and what is allowed.
    Scene(String),
    /// The integrator gave up at `time`; the state is that of `time`, still usable.
    Integration {
        /// [s] Last time reached, counted from the start.
        time: f64,
        /// One line: component and cause.
        cause: String,
    },
    /// A snapshot does not fit this scene.
    Snapshot(String),
}

impl SimulationError {
    /// The same error in times of an importer whose run started at `start` [s].
    pub fn counted_from(self, start: f64) -> Self {
        match self {
            Self::Integration { time, cause } => Self::Integration { time: start + time, cause },
            other => other,
        }
    }
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
