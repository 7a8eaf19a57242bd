//! Errors of pointers that the importer passes.

use std::fmt;

/// A pointer of the importer cannot be used. Each error has the argument's name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArgumentError {
    /// The pointer is NULL, but data are needed.
    Null(&'static str),
    /// The pointer is not aligned for its type.
    Misaligned(&'static str),
    /// The number of elements is larger than in any sensible call.
    TooLong(&'static str, usize),
}

impl fmt::Display for ArgumentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null(argument) => write!(f, "argument '{argument}' is NULL"),
            Self::Misaligned(argument) => {
                write!(f, "argument '{argument}' is not aligned for its type")
            }
            Self::TooLong(argument, length) => {
                write!(f, "argument '{argument}' cannot have {length} elements")
            }
        }
    }
}
