//! Why a pointer from outside cannot be used.

use std::fmt;

/// Why a pointer from outside cannot be used. Each holds the argument's name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArgumentError {
    /// NULL where data are needed.
    Null(&'static str),
    /// Not where such a datum can lie.
    Misaligned(&'static str),
    /// More elements than any sensible call has.
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
