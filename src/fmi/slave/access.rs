//! Which variable a value reference means, and whether a call may read or write it.

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
    /// An item of an enumeration; it passes as an integer.
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

/// Which variables a call may touch, as the importer's lifecycle has it at this moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Permission {
    /// Whether the call may touch inputs.
    pub inputs: bool,
    /// Whether the call may read outputs; no call may write one.
    pub outputs: bool,
    /// Whether the call may touch parameters.
    pub parameters: bool,
    /// Name of the lifecycle's state, for a refusal.
    pub state: &'static str,
}

impl Permission {
    /// Refuses to read what may not be read now.
    pub fn check_read(self, variable: &Variable) -> Result<(), VariableError> {
        self.check(variable, false)
    }

    /// Refuses to write what may not be written now.
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

/// The variable of this value reference, which must be of the type asked for; an enumeration passes
/// as an integer.
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

/// A value that may be handed out: extreme loads may make an output NaN or infinite.
pub fn finite_output(variable: &Variable, value: f64) -> Result<f64, Error> {
    finite_number(variable.name, value)
}

/// The same, of the output of this name.
pub fn finite_number(name: &'static str, value: f64) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::OutputNotFinite(name, value)) }
}

/// Order of the derivatives that we know.
const FIRST: i32 = 1;

/// Refuses derivatives of every order but the first.
pub fn check_first_order(variable: &Variable, order: i32) -> Result<(), VariableError> {
    if order == FIRST { Ok(()) } else { Err(VariableError::Order(variable.name, order)) }
}

/// How a real output is read.
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
    input(variable, "a real input")
}

/// The same, of what outputs are differentiated with respect to, where parameters are out of the question.
pub fn known_input(variable: &Variable) -> Result<RealInput, VariableError> {
    input(variable, "a real input, nor a real parameter in initialization mode")
}

fn input(variable: &Variable, wanted: &'static str) -> Result<RealInput, VariableError> {
    match variable.access {
        Access::Input { get, set, .. } => Ok(RealInput { get, set }),
        _ => Err(VariableError::Kind(variable.name, wanted)),
    }
}

/// The real parameter that a variable is.
pub fn real_parameter(variable: &Variable) -> Option<&'static Parameter> {
    match variable.access {
        Access::Parameter(parameter @ Parameter { kind: Kind::Real { .. }, .. }) => Some(parameter),
        _ => None,
    }
}
