//! Severities: the statuses of every version of FMI, without success.

use super::variables::LogCategory;

/// The severity of a call's outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Success with a warning.
    Warning,
    /// Not finished; the slave can go on.
    Discard,
    /// Refused.
    Error,
    /// An internal error; the slave must not be used any more.
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
