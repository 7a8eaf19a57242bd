//! Reads a variable's value from text.

use super::description::{Description, Kind, Variable};
use super::error::HostError;

/// A value of one of FMI's types.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// fmi2Real.
    Real(f64),
    /// fmi2Integer, or an item of an enumeration.
    Integer(i32),
    /// fmi2Boolean.
    Boolean(bool),
    /// fmi2String.
    String(String),
}

/// A setting `name=value` of the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Name of the variable.
    pub name: String,
    /// Text of its value.
    pub value: String,
}

impl Setting {
    /// A setting of a joint's parameter, such as `law` of joint C.
    pub fn joint(joint: &str, parameter: &str, value: &str) -> Self {
        Self { name: format!("joint.{joint}.{parameter}"), value: value.into() }
    }
}

impl std::str::FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("expected name=value")?;
        Ok(Self { name: name.trim().into(), value: value.trim().into() })
    }
}

impl Value {
    /// Reads `text` as a value of `variable`. An item of an enumeration is given by its number or its name.
    pub fn parse(description: &Description, variable: &Variable, text: &str) -> Result<Self, HostError> {
        let items = description.items(variable);
        let value = match variable.kind {
            Kind::Real => text.parse().ok().filter(|number: &f64| number.is_finite()).map(Self::Real),
            Kind::Integer => text.parse().ok().map(Self::Integer),
            Kind::Boolean => match text {
                "true" | "1" => Some(Self::Boolean(true)),
                "false" | "0" => Some(Self::Boolean(false)),
                _ => None,
            },
            Kind::String => Some(Self::String(text.into())),
            Kind::Other => None,
            Kind::Enumeration => {
                let named = items.iter().find(|(name, _)| name == text).map(|(_, value)| *value);
                named.or_else(|| text.parse().ok()).map(Self::Integer)
            }
        };
        value.ok_or_else(|| {
            let wanted = match variable.kind {
                Kind::Real => "a finite number".into(),
                Kind::Integer => "a whole number".into(),
                Kind::Boolean => "true or false".into(),
                Kind::String => "a text".into(),
                Kind::Other => "of a type that this program can set".into(),
                Kind::Enumeration => {
                    let names: Vec<&str> = items.iter().map(|(name, _)| name.as_str()).collect();
                    format!("one of {}", names.join(", "))
                }
            };
            HostError::Value { name: variable.name.clone(), value: text.into(), wanted }
        })
    }
}
