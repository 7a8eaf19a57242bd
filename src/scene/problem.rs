//! Problems of a scene file, with file, line and column.

use super::error::SceneError;
use super::units::UnitError;
use std::fmt;

/// A scene file with errors: all problems, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadError {
    /// Name of the file.
    pub file: String,
    /// The problems; at least one.
    pub problems: Vec<Problem>,
}

/// A problem of a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong there.
    pub fault: Fault,
}

/// What is wrong in a scene file.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The file is not valid TOML.
    Syntax(String),
    /// A key is unknown.
    UnknownKey {
        /// Path of the key.
        key: String,
        /// A similar key that may have been meant.
        nearest: Option<String>,
        /// Keys that are allowed in this place.
        known: Vec<String>,
    },
    /// The same quantity is given twice.
    Twice {
        /// Path of the key.
        key: String,
    },
    /// A value has the wrong type.
    Type {
        /// Path of the key.
        key: String,
        /// Value found.
        found: String,
        /// Type required.
        wanted: String,
    },
    /// A text is not a quantity in a suitable unit.
    Unit {
        /// Path of the key.
        key: String,
        /// Text found.
        found: String,
        /// Cause.
        why: UnitError,
        /// Suitable units.
        units: String,
    },
    /// A value is outside its range or list.
    Value {
        /// Path of the key.
        key: String,
        /// Value found.
        found: String,
        /// The range or list.
        allowed: String,
    },
    /// Values are inconsistent.
    Conflict(SceneError),
    /// A table does not have the required form.
    Form {
        /// Path of the key.
        key: String,
        /// The form required.
        why: String,
    },
    /// A file cannot be read.
    File {
        /// Path of the key whose value names the file.
        key: String,
        /// Name of the file.
        file: String,
        /// Cause.
        why: String,
    },
    /// Problems of a file that the scene names.
    Inside(Box<ReadError>),
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Problem { line, column, fault }) in self.problems.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{}:{line}:{column}: {fault}", self.file)?;
        }
        Ok(())
    }
}

impl std::error::Error for ReadError {}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax(text) => f.write_str(text),
            Self::UnknownKey { key, nearest: Some(nearest), .. } => {
                write!(f, "unknown key `{key}`; is it `{nearest}`?")
            }
            Self::UnknownKey { key, nearest: None, known } => {
                write!(f, "unknown key `{key}`; known here: {}", known.join(", "))
            }
            Self::Twice { key } => write!(f, "`{key}` is said twice"),
            Self::Type { key, found, wanted } => write!(f, "{key} = {found}: wanted {wanted}"),
            Self::Unit { key, found, why, units } => {
                write!(f, "{key} = {found}: {why}; units: {units}")
            }
            Self::Value { key, found, allowed } => {
                write!(f, "{key} = {found} is not allowed: {allowed}")
            }
            Self::Conflict(error) => error.fmt(f),
            Self::Form { key, why } => write!(f, "{key}: {why}"),
            Self::File { key, file, why } => write!(f, "{key} = {file:?}: {why}"),
            Self::Inside(error) => error.fmt(f),
        }
    }
}

/// The candidate that is most similar to `path`; `None` unless at most a third of the letters of its last part differ.
pub(super) fn nearest<'a>(path: &str, candidates: &'a [String]) -> Option<&'a String> {
    let last = |path: &str| path.rsplit('.').next().unwrap_or(path).to_lowercase();
    let key = last(path);
    let distance = |candidate: &String| strsim::damerau_levenshtein(&last(candidate), &key);
    let best = candidates.iter().min_by_key(|candidate| distance(candidate))?;
    (distance(best) <= key.chars().count() / 3).then_some(best)
}

/// Line and column (from 1) of a byte offset.
pub(super) fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
