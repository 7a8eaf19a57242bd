//! Why a call is refused: what the slave says, and what FMI 2.0 and its C interface add.

use super::lifecycle::State;
use super::status_kind::StatusKind;
use crate::fmi::abi::ArgumentError;
use crate::fmi::slave;
use crate::fmi::slave::error::SavedStateError;
use crate::fmi::slave::{Interface, Severity};
use crate::fmi::status::Status;
use crate::scene::slot::SlotError;
use std::fmt;

/// Why a call is refused or a step not finished.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The slave refuses or breaks off.
    Slave(slave::Error),
    /// A pointer from outside cannot be used.
    Argument(ArgumentError),
    /// The call does not belong in this state.
    CallOrder(State),
    /// The function belongs to this kind of interface, and the instance is of the other.
    Interface(Interface),
    /// The importer asks for something else than this FMU.
    Instantiate(InstantiateError),
    /// The status asked for is not known here.
    StatusKind(StatusKind),
    /// A number that is not a status kind.
    NotAStatusKind(i32),
    /// A fault of ours, with what is known of it.
    Panic(String),
}

impl Error {
    /// How bad it is.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Slave(error) => error.severity(),
            Self::StatusKind(_) => Severity::Discard,
            Self::CallOrder(State::Fatal) | Self::Panic(_) => Severity::Fatal,
            Self::Argument(_)
            | Self::CallOrder(_)
            | Self::Interface(_)
            | Self::Instantiate(_)
            | Self::NotAStatusKind(_) => Severity::Error,
        }
    }
}

/// Why there is no instance.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InstantiateError {
    /// Neither model exchange nor co-simulation.
    Type(i32),
    /// NULL or empty.
    Name,
    /// The packaged scene inside the library cannot be read.
    Slot(SlotError),
    /// The XML that the importer read is not this library's.
    Guid {
        /// The library's.
        expected: String,
        /// The importer's, if any.
        given: Option<String>,
    },
}

impl From<slave::Error> for Error {
    fn from(error: slave::Error) -> Self {
        Self::Slave(error)
    }
}

impl From<SavedStateError> for Error {
    fn from(error: SavedStateError) -> Self {
        Self::Slave(error.into())
    }
}

impl From<ArgumentError> for Error {
    fn from(error: ArgumentError) -> Self {
        Self::Argument(error)
    }
}

impl From<InstantiateError> for Error {
    fn from(error: InstantiateError) -> Self {
        Self::Instantiate(error)
    }
}

impl From<&Error> for Status {
    fn from(error: &Error) -> Self {
        error.severity().into()
    }
}

impl std::error::Error for Error {}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slave(error) => error.fmt(f),
            Self::Argument(error) => error.fmt(f),
            Self::CallOrder(state) => write!(f, "not allowed in state '{state}'"),
            Self::Interface(interface) => f.write_str(interface.mismatch()),
            Self::Instantiate(error) => error.fmt(f),
            Self::StatusKind(kind) => write!(f, "there is no {} to tell here", kind.name()),
            Self::NotAStatusKind(value) => write!(f, "{value} is not an fmi2StatusKind"),
            Self::Panic(what) => write!(f, "fault of the FMU: {what}"),
        }
    }
}

impl fmt::Display for InstantiateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Type(kind) => write!(f, "fmuType {kind}: neither fmi2ModelExchange (0) nor fmi2CoSimulation (1)"),
            Self::Name => write!(f, "instanceName is NULL or empty"),
            Self::Slot(error) => error.fmt(f),
            Self::Guid { expected, given: Some(given) } => {
                write!(f, "fmuGUID '{given}' does not match this library's '{expected}'")
            }
            Self::Guid { expected, given: None } => {
                write!(f, "fmuGUID is NULL; this library's is '{expected}'")
            }
        }
    }
}
