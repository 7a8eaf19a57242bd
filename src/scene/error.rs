//! Errors of a scene.

use super::modal_check::TableError;
use super::parameter::Refusal;
use crate::model_description::number::number;
use std::fmt;

/// A parameter that is not allowed.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneError {
    /// A value is outside its own range.
    Range(Refusal),
    /// A value is inconsistent with another parameter.
    Conflict {
        /// Name of the parameter.
        name: String,
        /// Value of the parameter, in SI units.
        value: f64,
        /// The allowed values, in words and numbers.
        allowed: String,
    },
    /// The modal table of the rod is invalid.
    Table(TableError),
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(refusal) => refusal.fmt(f),
            Self::Table(error) => error.fmt(f),
            Self::Conflict { name, value, allowed } => {
                write!(f, "{name} = {} is not allowed: {allowed}", number(*value))
            }
        }
    }
}

impl std::error::Error for SceneError {}

impl SceneError {
    /// Name of the parameter.
    pub fn name(&self) -> &str {
        match self {
            Self::Range(refusal) => refusal.name,
            Self::Table(_) => "rod.flexible.table",
            Self::Conflict { name, .. } => name,
        }
    }
}

/// The error of parameter `joint.letter.what` with `value` unless `holds`.
pub(super) fn rule(
    holds: bool,
    letter: &str,
    what: &str,
    value: f64,
    allowed: impl FnOnce() -> String,
) -> Result<(), SceneError> {
    if holds {
        return Ok(());
    }
    let name = format!("joint.{letter}.{what}");
    Err(SceneError::Conflict { name, value, allowed: allowed() })
}
