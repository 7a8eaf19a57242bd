//! Errors of calls: those of the slave, and those of FMI 2.0 and its C interface.

use super::lifecycle::State;
use super::status_kind::StatusKind;
use crate::fmi::abi::ArgumentError;
use crate::fmi::slave;
use crate::fmi::slave::error::SavedStateError;
use crate::fmi::slave::{Interface, Severity};
use crate::fmi::status::Status;
use crate::scene::slot::SlotError;
use std::fmt;

/// A call is refused, or a step fails.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// An error of the slave.
    Slave(slave::Error),
    /// A pointer of the importer cannot be used.
    Argument(ArgumentError),
    /// The call is not allowed in this state.
    CallOrder(State),
    /// The function belongs to this kind of interface, but the instance has the other kind.
    Interface(Interface),
    /// The importer expects a different FMU.
    Instantiate(InstantiateError),
    /// This FMU does not have this kind of status.
    StatusKind(StatusKind),
    /// A number that is not a status kind.
    NotAStatusKind(i32),
    /// An internal error, with its message.
    Panic(String),
}

impl Error {
    /// Its severity.
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

/// An instance cannot be made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InstantiateError {
    /// The type is neither model exchange nor co-simulation.
    Type(i32),
    /// The name is NULL or empty.
    Name,
    /// The packaged scene inside the library cannot be read.
    Slot(SlotError),
    /// The importer's model description does not belong to this library.
    Guid {
        /// GUID of the library.
        expected: String,
        /// GUID of the importer, if it passed one.
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
