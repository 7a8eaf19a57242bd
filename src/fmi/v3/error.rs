//! Why a call is refused: what the slave says, and what FMI 3.0 and its C interface add.

use super::lifecycle::State;
use crate::fmi::abi::ArgumentError;
use crate::fmi::slave;
use crate::fmi::slave::error::{SavedStateError, VariableError};
use crate::fmi::slave::{Interface, Severity};
use crate::fmi::status::Status;
use crate::scene::slot::SlotError;
use std::fmt;

/// Why a call is refused or a step not finished.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The slave refuses.
    Slave(slave::Error),
    /// A step broke off. The standard wants an error for that: `fmi3Discard` would promise the state before the step.
    Step(slave::Error),
    /// A pointer from outside cannot be used.
    Argument(ArgumentError),
    /// An array has not as many entries as the call needs.
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// Entries given.
        given: usize,
        /// Entries needed.
        needed: usize,
    },
    /// The call does not belong in this state.
    CallOrder(State),
    /// The function belongs to this kind of interface, and the instance is of the other.
    Interface(Interface),
    /// The FMU does not provide the function. The reason.
    NotProvided(&'static str),
    /// The importer has said at instantiation that it does not use event mode.
    NoEventMode,
    /// The variable is none of those that the importer named for intermediate updates.
    NotIntermediate(u32),
    /// The importer asks for something else than this FMU.
    Instantiate(InstantiateError),
    /// A fault of ours, with what is known of it.
    Panic(String),
}

impl Error {
    /// How bad it is.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Slave(error) => error.severity(),
            Self::CallOrder(State::Fatal) | Self::Panic(_) => Severity::Fatal,
            _ => Severity::Error,
        }
    }
}

/// Why there is no instance.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InstantiateError {
    /// NULL, empty or blank.
    Name,
    /// The packaged scene inside the library cannot be read.
    Slot(SlotError),
    /// The XML that the importer read is not this library's.
    Token {
        /// The library's.
        expected: String,
        /// The importer's, if any.
        given: Option<String>,
    },
    /// Variables are named for intermediate updates, but there is no callback.
    NoCallback,
    /// A variable that has no intermediate values.
    Intermediate(u32),
}

/// `impl From<$part> for Error`.
macro_rules! from {
    ($($part:ty => $item:path),+ $(,)?) => {
        $(impl From<$part> for Error {
            fn from(error: $part) -> Self {
                $item(error.into())
            }
        })+
    };
}

from! {
    slave::Error => Self::Slave,
    SavedStateError => Self::Slave,
    VariableError => Self::Slave,
    ArgumentError => Self::Argument,
    InstantiateError => Self::Instantiate,
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
            Self::Slave(error) | Self::Step(error) => error.fmt(f),
            Self::Argument(error) => error.fmt(f),
            Self::Length { argument, given, needed } => {
                write!(f, "argument '{argument}' has {given} entries, and {needed} are needed")
            }
            Self::CallOrder(state) => write!(f, "not allowed in state '{state}'"),
            Self::Interface(interface) => f.write_str(interface.mismatch()),
            Self::NotProvided(reason) => f.write_str(reason),
            Self::NoEventMode => f.write_str("the instance was made with eventModeUsed = fmi3False"),
            Self::NotIntermediate(reference) => {
                write!(f, "value reference {reference} is not among requiredIntermediateVariables")
            }
            Self::Instantiate(error) => error.fmt(f),
            Self::Panic(what) => write!(f, "fault of the FMU: {what}"),
        }
    }
}

impl fmt::Display for InstantiateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name => write!(f, "instanceName is NULL or blank"),
            Self::Slot(error) => error.fmt(f),
            Self::Token { expected, given: Some(given) } => {
                write!(f, "instantiationToken '{given}' does not match this library's '{expected}'")
            }
            Self::Token { expected, given: None } => {
                write!(f, "instantiationToken is NULL; this library's is '{expected}'")
            }
            Self::NoCallback => write!(f, "requiredIntermediateVariables are named, but intermediateUpdate is NULL"),
            Self::Intermediate(reference) => write!(
                f,
                "value reference {reference} among requiredIntermediateVariables is neither an input nor a continuous output"
            ),
        }
    }
}
