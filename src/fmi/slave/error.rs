//! Errors of a slave, each with the names and numbers that the importer needs.

mod display;

use super::severity::Severity;
use crate::scene::SceneError;
use crate::scene::parameter::Refusal;
use crate::simulation::SimulationError;

/// A call is refused, or a step fails.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A value reference or a value cannot be used.
    Variable(VariableError),
    /// A time or a tolerance cannot be used.
    Time(TimeError),
    /// A saved state cannot be used.
    SavedState(SavedStateError),
    /// The parameters contradict each other.
    Scene(SceneError),
    /// An output is NaN or infinite.
    OutputNotFinite(&'static str, f64),
    /// A number of a phase is NaN or infinite.
    PhaseNotFinite(String, f64),
    /// No motion goes on from a phase. Its largest number.
    PhaseBeyond(String, f64),
    /// An output has no derivative with respect to start values, since it jumps.
    NoDerivative(&'static str),
    /// The mechanism cannot start or go on.
    Simulation(SimulationError),
    /// The call belongs to the other kind of interface.
    Interface,
    /// An array has not as many entries as the slave has states or event indicators.
    Count {
        /// What the entries stand for.
        of: &'static str,
        /// Entries given.
        given: usize,
        /// Entries needed.
        needed: usize,
    },
}

impl Error {
    /// Its severity.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Variable(_)
            | Self::Time(_)
            | Self::SavedState(_)
            | Self::Scene(_)
            | Self::PhaseNotFinite(..)
            | Self::PhaseBeyond(..)
            | Self::Interface
            | Self::Count { .. }
            | Self::Simulation(
                SimulationError::Scene(_) | SimulationError::Snapshot(_) | SimulationError::Grazing { .. },
            ) => Severity::Error,
            Self::OutputNotFinite(..)
            | Self::NoDerivative(_)
            | Self::Simulation(SimulationError::Integration { .. }) => Severity::Discard,
        }
    }
}

/// A value reference or a value cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum VariableError {
    /// No variable has this value reference.
    Unknown(u32),
    /// The variable does not have the function's type.
    Type {
        /// Name of the variable.
        name: &'static str,
        /// Its type.
        is: &'static str,
        /// The function's type.
        asked: &'static str,
    },
    /// The variable cannot be read or written now.
    Moment {
        /// Name of the variable.
        name: &'static str,
        /// Whether it was written, rather than read.
        write: bool,
        /// Its causality: input, output or fixed parameter.
        causality: &'static str,
        /// State of the life cycle.
        state: &'static str,
    },
    /// NaN or infinite.
    NotFinite(&'static str, f64),
    /// Outside the declared range, or not an item of the enumeration.
    Refused(Refusal),
    /// The order of a derivative is not 1.
    Order(&'static str, i32),
    /// The scene has fewer continuous states.
    Absent(&'static str),
    /// This parameter's value would change the states or event indicators of model exchange.
    Structure(&'static str),
    /// The function is for another kind of variable. The last field says which it needs.
    Kind(&'static str, &'static str),
    /// The variable is named twice.
    Twice(&'static str),
}

/// A time or a tolerance cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TimeError {
    /// NaN or infinite.
    NotFinite(&'static str, f64),
    /// 0 or negative.
    NotPositive(&'static str, f64),
    /// The stop lies before the start.
    StopBeforeStart {
        /// [s]
        start: f64,
        /// [s]
        stop: f64,
    },
    /// The importer's communication point is not that of the slave.
    Elsewhere {
        /// [s] The importer's communication point.
        given: f64,
        /// [s] The slave's communication point.
        reached: f64,
    },
    /// The step would end after the experiment's stop time.
    PastStop {
        /// [s] End of the step.
        end: f64,
        /// [s] Stop time.
        stop: f64,
    },
}

/// A saved state cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SavedStateError {
    /// The state is NULL.
    Null,
    /// Not a live state of this slave.
    Foreign,
    /// The buffer is shorter than the state.
    Buffer {
        /// Bytes given.
        given: usize,
        /// Bytes needed.
        needed: usize,
    },
    /// Too short, or without the magic number of this format.
    NotOurs,
    /// In another version of the format.
    Version {
        /// Version of the bytes.
        found: u32,
        /// Version that this library reads.
        known: u32,
    },
    /// From an FMU with other variables.
    Declaration,
    /// Incomplete, or with bytes after the end.
    Length {
        /// Number of bytes in the header.
        expected: usize,
        /// Bytes given.
        given: usize,
    },
    /// From an instance of the other kind of interface: co-simulation or model exchange.
    Interface,
    /// The checksum does not match.
    Checksum,
    /// The checksum matches, but the content is invalid.
    Content,
}

impl From<Refusal> for Error {
    fn from(refusal: Refusal) -> Self {
        VariableError::Refused(refusal).into()
    }
}

/// `impl From<$part> for Error`.
macro_rules! from {
    ($($part:ident => $item:ident),+) => {
        $(impl From<$part> for Error {
            fn from(error: $part) -> Self {
                Self::$item(error)
            }
        })+
    };
}

from! {
    VariableError => Variable, TimeError => Time, SavedStateError => SavedState,
    SceneError => Scene, SimulationError => Simulation
}

impl std::error::Error for Error {}
