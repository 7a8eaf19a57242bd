//! What can be wrong with a scene file, told with file, line and column.

use super::error::SceneError;
use super::units::UnitError;
use std::fmt;

/// A scene file that cannot be used: everything that is wrong with it, in the file's order.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadError {
    /// The file's name.
    pub file: String,
    /// At least one.
    pub problems: Vec<Problem>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What.
    pub fault: Fault,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The file is not TOML.
    Syntax(String),
    /// A key that means nothing.
    UnknownKey {
        /// As found.
        key: String,
        /// A key that it may be a slip of.
        nearest: Option<String>,
        /// Keys that may stand in this place.
        known: Vec<String>,
    },
    /// The same thing said twice.
    Twice {
        /// As found.
        key: String,
    },
    /// A value of the wrong type.
    Type {
        /// Whose value.
        key: String,
        /// As found.
        found: String,
        /// What may stand there.
        wanted: String,
    },
    /// A text that is no quantity of the right kind.
    Unit {
        /// Whose value.
        key: String,
        /// As found.
        found: String,
        /// Why not.
        why: UnitError,
        /// Units that would do.
        units: String,
    },
    /// A value outside its range or list.
    Value {
        /// Whose value.
        key: String,
        /// As found.
        found: String,
        /// The range or list.
        allowed: String,
    },
    /// Values that do not go together.
    Conflict(SceneError),
    /// A table without its form.
    Form {
        /// Whose value.
        key: String,
        /// What the form asks for.
        why: String,
    },
    /// A file that cannot be read.
    File {
        /// Whose value names it.
        key: String,
        /// As named.
        file: String,
        /// Why not.
        why: String,
    },
    /// A fault in a file that the scene names.
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

/// The path that another may be a slip of: at most a third of the letters of its last part wrong.
pub(super) fn nearest<'a>(path: &str, candidates: &'a [String]) -> Option<&'a String> {
    let last = |path: &str| path.rsplit('.').next().unwrap_or(path).to_lowercase();
    let key = last(path);
    let distance = |candidate: &String| strsim::damerau_levenshtein(&last(candidate), &key);
    let best = candidates.iter().min_by_key(|candidate| distance(candidate))?;
    (distance(best) <= key.chars().count() / 3).then_some(best)
}

/// Line and column of a byte offset.
pub(super) fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
