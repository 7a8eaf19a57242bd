//! Value references and types as FMI 3.0 has them.

use crate::fmi::slave::access::variable;
use crate::fmi::slave::error::VariableError;
use crate::fmi::slave::variables::{Access, VARIABLES, Variable};
use crate::fmi::slave::{Error, ValueType};
use crate::model_description::arrays::{CONTACTS as CORNER_CONTACTS, CORNERS, PENETRATIONS};
use crate::model_description::clocks::FIRST_CLOCK;
use crate::model_description::exchange::FIRST_INDICATOR;
use crate::simulation::CONTACTS;

/// Name of the independent variable.
pub const TIME: &str = "time";
/// The standard's name of a clock's type.
pub const CLOCK: &str = "Clock";

/// Value reference of the independent variable: behind all others, which have those of FMI 2.0.
pub fn time_reference() -> u32 {
    VARIABLES.len() as u32
}

/// What a value reference means.
pub enum Meaning {
    /// What it means in FMI 2.0, too.
    Neutral(&'static Variable),
    /// The independent variable.
    Time,
    /// The event indicator at this place.
    Indicator(usize),
    /// The clock of the contact at this place among all.
    Clock(usize),
    /// Penetrations of the slider's corners, an array.
    CornerPenetrations,
    /// Contacts of the slider's corners, an array.
    CornerContacts,
}

impl Meaning {
    /// Of this value reference.
    pub fn of(reference: u32) -> Result<Self, VariableError> {
        let place = |first: u32| reference.checked_sub(first).map(|place| place as usize).filter(|at| *at < CONTACTS);
        Ok(match (place(FIRST_INDICATOR), place(FIRST_CLOCK)) {
            _ if reference == time_reference() => Self::Time,
            _ if reference == PENETRATIONS => Self::CornerPenetrations,
            _ if reference == CORNER_CONTACTS => Self::CornerContacts,
            (Some(place), _) => Self::Indicator(place),
            (_, Some(contact)) => Self::Clock(contact),
            _ => Self::Neutral(variable(reference)?),
        })
    }

    /// How many values it has.
    pub fn size(&self) -> usize {
        if matches!(self, Self::CornerPenetrations | Self::CornerContacts) { CORNERS } else { 1 }
    }

    /// The variable's name, or what it is.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Neutral(variable) => variable.name,
            Self::Time => TIME,
            Self::Indicator(_) => "an event indicator",
            Self::Clock(_) => "a clock",
            Self::CornerPenetrations => "joint.T.corner.penetration",
            Self::CornerContacts => "joint.T.corner.contact",
        }
    }

    /// The standard's name of its type.
    fn type_name(&self) -> &'static str {
        match self {
            Self::Neutral(variable) => type_name(ValueType::of(variable)),
            Self::Time | Self::Indicator(_) | Self::CornerPenetrations => type_name(ValueType::Real),
            Self::CornerContacts => type_name(ValueType::Boolean),
            Self::Clock(_) => CLOCK,
        }
    }
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

/// Refuses references that are not of the type of this name. Unlike in FMI 2.0, an enumeration is no integer of 32 bits.
pub fn check_type(references: &[u32], asked: &'static str) -> Result<(), Error> {
    for &reference in references {
        let meaning = Meaning::of(reference)?;
        let (name, is) = (meaning.name(), meaning.type_name());
        if is != asked {
            return Err(VariableError::Type { name, is, asked }.into());
        }
    }
    Ok(())
}

/// Whether all of these mean what they mean in FMI 2.0.
pub fn are_neutral(references: &[u32]) -> bool {
    references.iter().all(|reference| matches!(Meaning::of(*reference), Ok(Meaning::Neutral(_))))
}

/// Whether a variable has values within a step.
pub fn has_intermediate_values(reference: u32) -> bool {
    variable(reference).is_ok_and(|variable| matches!(variable.access, Access::Input { .. } | Access::RealOutput(_)))
}
