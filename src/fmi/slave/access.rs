//! Finds the variable of a value reference and decides whether a call may read or write it.

use super::error::{Error, VariableError};
use super::states;
use super::variables::{Access, VARIABLES, Variable};
use crate::model::signals::{Inputs, Outputs};
use crate::scene::parameter::{Kind, Parameter};

/// Type of a variable's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueType {
    /// A real number.
    Real,
    /// An integer.
    Integer,
    /// A truth value.
    Boolean,
    /// An item of an enumeration, passed as an integer.
    Enumeration,
}

impl ValueType {
    /// The type of a variable.
    pub fn of(variable: &Variable) -> Self {
        match &variable.access {
            Access::Input { .. } | Access::RealOutput(_) | Access::State(_) | Access::Derivative(_) => Self::Real,
            Access::IntegerOutput(_) => Self::Integer,
            Access::BooleanOutput(_) => Self::Boolean,
            Access::Parameter(Parameter { kind, .. }) => match kind {
                Kind::Real { .. } => Self::Real,
                Kind::Integer { .. } => Self::Integer,
                Kind::Boolean { .. } => Self::Boolean,
                Kind::Enumeration { .. } => Self::Enumeration,
            },
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::Enumeration => "Enumeration",
        }
    }
}

/// The variables that a call may use in the current state of the life cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Permission {
    /// Whether the call may use inputs.
    pub inputs: bool,
    /// Whether the call may read outputs; no call may write one.
    pub outputs: bool,
    /// Whether the call may use parameters.
    pub parameters: bool,
    /// Name of the state, for error messages.
    pub state: &'static str,
}

impl Permission {
    /// Returns an error if the variable may not be read now.
    pub fn check_read(self, variable: &Variable) -> Result<(), VariableError> {
        self.check(variable, false)
    }

    /// Returns an error if the variable may not be written now.
    pub fn check_write(self, variable: &Variable) -> Result<(), VariableError> {
        self.check(variable, true)
    }

    /// Refuses to read something that is read where outputs are.
    pub fn check_output(self, name: &'static str, causality: &'static str) -> Result<(), VariableError> {
        let Self { outputs, state, .. } = self;
        if outputs { Ok(()) } else { Err(VariableError::Moment { name, write: false, causality, state }) }
    }

    fn check(self, variable: &Variable, write: bool) -> Result<(), VariableError> {
        let Self { inputs, outputs, parameters, state } = self;
        let (causality, allowed) = match variable.access {
            Access::Input { .. } => ("input", inputs),
            Access::Parameter(_) => ("fixed parameter", parameters),
            Access::RealOutput(_) | Access::IntegerOutput(_) | Access::BooleanOutput(_) => {
                ("output", outputs && !write)
            }
            Access::State(_) | Access::Derivative(_) => ("local variable", outputs && !write),
        };
        if allowed { Ok(()) } else { Err(VariableError::Moment { name: variable.name, write, causality, state }) }
    }
}

/// The variable of this value reference.
pub fn variable(reference: u32) -> Result<&'static Variable, VariableError> {
    let found = usize::try_from(reference).ok().and_then(|index| VARIABLES.get(index));
    found.or_else(|| states::variable(reference)).ok_or(VariableError::Unknown(reference))
}

/// The variable of this value reference, which must have this type. An enumeration counts as an integer.
pub fn typed(reference: u32, asked: ValueType) -> Result<&'static Variable, VariableError> {
    let variable = variable(reference)?;
    match (ValueType::of(variable), asked) {
        (ValueType::Enumeration, ValueType::Integer) => Ok(variable),
        (is, asked) if is == asked => Ok(variable),
        (is, asked) => Err(VariableError::Type { name: variable.name, is: is.name(), asked: asked.name() }),
    }
}

/// Refuses NaN and infinity.
pub fn finite(variable: &Variable, value: f64) -> Result<f64, VariableError> {
    if value.is_finite() { Ok(value) } else { Err(VariableError::NotFinite(variable.name, value)) }
}

/// A value that may be returned. Extreme loads may make an output NaN or infinite.
pub fn finite_output(variable: &Variable, value: f64) -> Result<f64, Error> {
    finite_number(variable.name, value)
}

/// A value of the output of this name that may be returned.
pub fn finite_number(name: &'static str, value: f64) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::OutputNotFinite(name, value)) }
}

/// Order of the derivatives that exist.
const FIRST: i32 = 1;

/// Returns an error unless the order is 1.
pub fn check_first_order(variable: &Variable, order: i32) -> Result<(), VariableError> {
    if order == FIRST { Ok(()) } else { Err(VariableError::Order(variable.name, order)) }
}

/// Reads a real output.
pub fn real_output(variable: &Variable) -> Result<fn(&Outputs) -> f64, VariableError> {
    match variable.access {
        Access::RealOutput(get) => Ok(get),
        _ => Err(VariableError::Kind(variable.name, "a real output")),
    }
}

/// How a real input is read and written.
pub struct RealInput {
    /// Reads it.
    pub get: fn(&Inputs) -> f64,
    /// Writes it.
    pub set: fn(&mut Inputs, f64),
}

/// How a real input is read and written.
pub fn real_input(variable: &Variable) -> Result<RealInput, VariableError> {
    match variable.access {
        Access::Input { get, set, .. } => Ok(RealInput { get, set }),
        _ => Err(VariableError::Kind(variable.name, "a real input")),
    }
}

/// The real parameter of a variable.
pub fn real_parameter(variable: &Variable) -> Option<&'static Parameter> {
    match variable.access {
        Access::Parameter(parameter @ Parameter { kind: Kind::Real { .. }, .. }) => Some(parameter),
        _ => None,
    }
}

/// Refuses an array that has not as many entries as are needed.
pub fn check_count(of: &'static str, given: usize, needed: usize) -> Result<(), Error> {
    if given == needed { Ok(()) } else { Err(Error::Count { of, given, needed }) }
}
