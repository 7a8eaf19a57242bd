//! What is wrong with a scene.

use super::modal_check::TableError;
use super::parameter::Refusal;
use crate::model_description::number::number;
use std::fmt;

/// A parameter that does not go with the others.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneError {
    /// A value outside its own range.
    Range(Refusal),
    /// A value that another parameter rules out.
    Conflict {
        /// Name of the parameter.
        name: String,
        /// Its value, in SI units.
        value: f64,
        /// What it must be, in words and numbers.
        allowed: String,
    },
    /// The rod's modal table cannot be a rod's.
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
