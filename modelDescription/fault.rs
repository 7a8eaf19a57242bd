//! What can be wrong with `variables.toml`.

use std::fmt;

/// A declaration that cannot be.
#[derive(Debug)]
pub struct RowError {
    /// Line of variables.toml, from 1.
    pub line: usize,
    /// What is wrong there.
    pub fault: Fault,
}

/// What is wrong with a declaration.
#[derive(Debug)]
pub enum Fault {
    /// Not TOML, or not of this form.
    Toml(String),
    /// No such causality, variability and type in FMI 2.0, or not one that we use.
    Triple {
        /// As declared.
        causality: String,
        /// As declared.
        variability: String,
        /// Type as declared.
        kind: String,
    },
    /// An attribute is missing.
    Missing(&'static str),
    /// An attribute has no meaning here.
    Superfluous(&'static str),
    /// Not min ≤ start ≤ max, or a nominal that is not positive.
    Range,
    /// A bound or start value of an integer that is none.
    Fraction(f64),
    /// A type, item, group or variable that is not declared.
    Unknown(String),
    /// Declared twice.
    Duplicate(String),
    /// An enumeration whose items do not rise in value.
    Disorder(String),
    /// Not a name of the structured convention.
    Name(String),
}

impl fmt::Display for RowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "modelDescription/variables.toml:{}: ", self.line)?;
        match &self.fault {
            Fault::Toml(text) => f.write_str(text),
            Fault::Triple { causality, variability, kind } => {
                write!(f, "a variable cannot be {causality}, {variability} and {kind}")
            }
            Fault::Missing(attribute) => write!(f, "`{attribute}` is missing"),
            Fault::Superfluous(attribute) => write!(f, "`{attribute}` has no meaning here"),
            Fault::Range => f.write_str("not min <= start <= max and nominal > 0"),
            Fault::Fraction(value) => write!(f, "{value} is no integer"),
            Fault::Unknown(name) => write!(f, "`{name}` is not declared"),
            Fault::Duplicate(name) => write!(f, "`{name}` is declared twice"),
            Fault::Disorder(name) => write!(f, "the items of `{name}` do not rise in value"),
            Fault::Name(name) => write!(f, "`{name}` is not a structured name"),
        }
    }
}

impl std::error::Error for RowError {}
