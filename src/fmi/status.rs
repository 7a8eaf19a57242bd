//! What a call answers: every error becomes one of the standard's statuses, in one match.

use super::error::Error;
use super::lifecycle::State;
use super::variables::LogCategory;
use crate::simulation::SimulationError;
use serde::{Deserialize, Serialize};

/// The standard's `fmi2Status`. A step is over when its call returns, so `fmi2Pending` is never
/// answered and has no name here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, with a remark in the log.
    Warning = 1,
    /// Not done in full; the instance is sound.
    Discard = 2,
    /// Refused.
    Error = 3,
    /// A fault of ours; the instance is lost.
    Fatal = 4,
}

impl From<()> for Status {
    fn from((): ()) -> Self {
        Self::Ok
    }
}

impl Error {
    /// The status that the call answers.
    pub fn status(&self) -> Status {
        match self {
            Self::Argument(_)
            | Self::Variable(_)
            | Self::ModelExchange
            | Self::Instantiate(_)
            | Self::Time(_)
            | Self::Category(_)
            | Self::NoStatusKind(_)
            | Self::FmuState(_)
            | Self::Scene(_)
            | Self::Simulation(SimulationError::Scene(_) | SimulationError::Snapshot(_)) => Status::Error,
            Self::StatusKind(_) | Self::NoNumber(..) | Self::Simulation(SimulationError::Integration { .. }) => {
                Status::Discard
            }
            Self::CallOrder(State::Fatal) | Self::Panic(_) => Status::Fatal,
            Self::CallOrder(_) => Status::Error,
        }
    }
}

impl Status {
    /// The log category of messages with this status. Of what went well nothing is said.
    pub fn category(self) -> Option<LogCategory> {
        match self {
            Self::Ok => None,
            Self::Warning => Some(LogCategory::StatusWarning),
            Self::Discard => Some(LogCategory::StatusDiscard),
            Self::Error => Some(LogCategory::StatusError),
            Self::Fatal => Some(LogCategory::StatusFatal),
        }
    }
}

/// The standard's `fmi2StatusKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatusKind {
    /// Status of the last step.
    DoStep,
    /// Text about a step under way.
    Pending,
    /// Time that the last step reached.
    LastSuccessfulTime,
    /// Whether the instance wants to end the simulation.
    Terminated,
}

impl StatusKind {
    /// The kind of this number.
    pub fn read(value: i32) -> Result<Self, Error> {
        match value {
            0 => Ok(Self::DoStep),
            1 => Ok(Self::Pending),
            2 => Ok(Self::LastSuccessfulTime),
            3 => Ok(Self::Terminated),
            other => Err(Error::NoStatusKind(other)),
        }
    }

    /// The standard's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::DoStep => "fmi2DoStepStatus",
            Self::Pending => "fmi2PendingStatus",
            Self::LastSuccessfulTime => "fmi2LastSuccessfulTime",
            Self::Terminated => "fmi2Terminated",
        }
    }
}
