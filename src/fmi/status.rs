//! What a call answers: every outcome becomes one of the standard's statuses.

use super::slave::Severity;
use super::slave::variables::LogCategory;
use serde::{Deserialize, Serialize};

/// The standard's status, the same numbers in FMI 2.0 and 3.0. A step is over when its call returns, so `fmi2Pending` is
/// never answered and has no name here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, with a remark in the log.
    Warning = 1,
    /// Not done in full, or not at all; the instance is sound.
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

impl From<Severity> for Status {
    fn from(severity: Severity) -> Self {
        match severity {
            Severity::Warning => Self::Warning,
            Severity::Discard => Self::Discard,
            Severity::Error => Self::Error,
            Severity::Fatal => Self::Fatal,
        }
    }
}

impl Status {
    /// The log category of messages with this status. Success is not logged.
    pub fn category(self) -> Option<LogCategory> {
        let severity = match self {
            Self::Ok => return None,
            Self::Warning => Severity::Warning,
            Self::Discard => Severity::Discard,
            Self::Error => Severity::Error,
            Self::Fatal => Severity::Fatal,
        };
        Some(severity.category())
    }
}
