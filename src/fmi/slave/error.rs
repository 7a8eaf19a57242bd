//! Why a slave refuses or breaks off: each cause with the names and numbers that the importer needs.

mod display;

use super::severity::Severity;
use crate::scene::SceneError;
use crate::scene::parameter::Refusal;
use crate::simulation::SimulationError;

/// Why a call is refused or a step not finished.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A value reference or a value cannot be used.
    Variable(VariableError),
    /// A time or a tolerance cannot be used.
    Time(TimeError),
    /// A saved state cannot be used.
    SavedState(SavedStateError),
    /// The parameters do not go together.
    Scene(SceneError),
    /// An output that is NaN or infinite.
    OutputNotFinite(&'static str, f64),
    /// An output that has no derivative with respect to start values: it jumps there.
    NoDerivative(&'static str),
    /// The mechanism cannot start or go on.
    Simulation(SimulationError),
    /// The call is for a slave of the other kind of interface.
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
    /// How bad it is.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Variable(_)
            | Self::Time(_)
            | Self::SavedState(_)
            | Self::Scene(_)
            | Self::Interface
            | Self::Count { .. }
            | Self::Simulation(SimulationError::Scene(_) | SimulationError::Snapshot(_)) => Severity::Error,
            Self::OutputNotFinite(..)
            | Self::NoDerivative(_)
            | Self::Simulation(SimulationError::Integration { .. }) => Severity::Discard,
        }
    }
}

/// Why a value reference or a value cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum VariableError {
    /// No variable has this value reference.
    Unknown(u32),
    /// The variable is of another type than the function's.
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
        /// Whether it was to be written, rather than read.
        write: bool,
        /// What it is: input, output or fixed parameter.
        causality: &'static str,
        /// State of the importer's lifecycle.
        state: &'static str,
    },
    /// NaN or infinite.
    NotFinite(&'static str, f64),
    /// Outside the declared range, or not an item of the enumeration.
    Refused(Refusal),
    /// Derivatives are of order 1 only.
    Order(&'static str, i32),
    /// The scene has not so many continuous states.
    Absent(&'static str),
    /// This parameter's value would change the states or event indicators of model exchange.
    Structure(&'static str),
    /// The function is for another kind of variable. The last field says which it needs.
    Kind(&'static str, &'static str),
}

/// Why a time or a tolerance cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TimeError {
    /// NaN or infinite.
    NotFinite(&'static str, f64),
    /// Not above 0.
    NotPositive(&'static str, f64),
    /// The stop lies before the start.
    StopBeforeStart {
        /// [s]
        start: f64,
        /// [s]
        stop: f64,
    },
    /// The importer's communication point is not where the slave is.
    Elsewhere {
        /// [s] The importer's.
        given: f64,
        /// [s] The slave's.
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

/// Why a saved state cannot be used.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SavedStateError {
    /// NULL.
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
    /// Too short or without our magic number.
    NotOurs,
    /// Written in another version of the format.
    Version {
        /// Theirs.
        found: u32,
        /// Ours.
        known: u32,
    },
    /// Written by an FMU with another declaration of variables.
    Declaration,
    /// Cut or with bytes after the end.
    Length {
        /// Bytes that the header promises.
        expected: usize,
        /// Bytes given.
        given: usize,
    },
    /// Of an instance of the other kind: co-simulation or model exchange.
    Interface,
    /// Checksum does not match.
    Checksum,
    /// The checksum matches but the content makes no sense.
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
