//! What a call answers: every outcome becomes one of the standard's statuses.

use super::error::Error;
use crate::fmi::slave::Severity;

/// The standard's `fmi3Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, with a remark in the log.
    Warning = 1,
    /// Not done; the instance is as it was.
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

impl From<&Error> for Status {
    fn from(error: &Error) -> Self {
        error.severity().into()
    }
}
