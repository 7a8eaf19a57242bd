//! Value references and types as FMI 3.0 has them.

use crate::fmi::slave::access::variable;
use crate::fmi::slave::error::VariableError;
use crate::fmi::slave::variables::{Access, VARIABLES};
use crate::fmi::slave::{Error, ValueType};

/// Name of the independent variable.
pub const TIME: &str = "time";

/// Value reference of the independent variable: behind all others, which have those of FMI 2.0.
pub fn time_reference() -> u32 {
    VARIABLES.len() as u32
}

/// The standard's name of a type.
pub fn type_name(of: ValueType) -> &'static str {
    match of {
        ValueType::Real => "Float64",
        ValueType::Integer => "Int32",
        ValueType::Boolean => "Boolean",
        ValueType::Enumeration => "Int64 (Enumeration)",
    }
}

/// Refuses references that are not of this type. Unlike in FMI 2.0, an enumeration is no integer of 32 bits.
pub fn check_type(references: &[u32], asked: ValueType) -> Result<(), Error> {
    for &reference in references {
        let is = is_of(reference)?;
        if is != asked {
            return Err(mismatch(reference, is, type_name(asked)));
        }
    }
    Ok(())
}

/// Refuses every reference: no variable is of the type of this name.
pub fn check_absent(references: &[u32], asked: &'static str) -> Result<(), Error> {
    match references {
        [] => Ok(()),
        [first, ..] => Err(mismatch(*first, is_of(*first)?, asked)),
    }
}

/// Whether a variable has values within a step.
pub fn has_intermediate_values(reference: u32) -> bool {
    variable(reference).is_ok_and(|variable| matches!(variable.access, Access::Input { .. } | Access::RealOutput(_)))
}

fn is_of(reference: u32) -> Result<ValueType, VariableError> {
    if reference == time_reference() { Ok(ValueType::Real) } else { Ok(ValueType::of(variable(reference)?)) }
}

fn mismatch(reference: u32, is: ValueType, asked: &'static str) -> Error {
    let name = variable(reference).map_or(TIME, |variable| variable.name);
    VariableError::Type { name, is: type_name(is), asked }.into()
}
