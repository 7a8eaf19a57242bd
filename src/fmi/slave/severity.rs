//! How bad it is: the statuses that every version of FMI has, success aside.

use super::variables::LogCategory;

/// How bad the outcome of a call is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Done, with a remark in the log.
    Warning,
    /// Not done in full; the slave is sound.
    Discard,
    /// Refused.
    Error,
    /// A fault of ours; the slave is lost.
    Fatal,
}

impl Severity {
    /// The log category of messages of this severity.
    pub fn category(self) -> LogCategory {
        match self {
            Self::Warning => LogCategory::StatusWarning,
            Self::Discard => LogCategory::StatusDiscard,
            Self::Error => LogCategory::StatusError,
            Self::Fatal => LogCategory::StatusFatal,
        }
    }
}
