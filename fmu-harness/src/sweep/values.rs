//! Values in study files: numbers in SI units, texts with a unit, truth values, lists and ranges. An error says what is
//! allowed; the reader of TOML adds line and key.

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::units;
use std::fmt;

/// A value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// A number in SI units.
    Plain(f64),
    /// A number with a unit, such as `"20 um"`, or an item of a list.
    Text(String),
    /// A truth value.
    Boolean(bool),
}

/// Values of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// A list.
    List(Vec<Number>),
    /// Evenly spaced values.
    Range(Range),
}

/// Evenly spaced values, with both ends.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Range {
    from: Number,
    to: Number,
    count: usize,
    #[serde(default)]
    logarithmic: bool,
}

impl Number {
    /// A number in this SI unit.
    ///
    /// # Errors
    /// If it is no number, or has a wrong unit.
    pub fn in_unit(&self, unit: &str) -> Result<f64> {
        match self {
            Self::Plain(value) => Ok(*value),
            Self::Text(text) => units::quantity(text, unit)
                .map_err(|error| anyhow!("{self}: {error}; units are {}", units::alternatives(unit).join(", "))),
            Self::Boolean(_) => bail!("{self} is no number"),
        }
    }

    /// The value of a parameter in SI units.
    ///
    /// # Errors
    /// If the unit is wrong, or if the parameter cannot have this value.
    pub fn value(&self, parameter: &Parameter) -> Result<f64> {
        let (name, kind) = (parameter.name, &parameter.kind);
        let found = match (self, kind) {
            (Self::Plain(value), _) => Some(*value),
            (Self::Text(_), Kind::Real { unit, .. }) => Some(self.in_unit(unit).with_context(|| name.to_owned())?),
            (Self::Text(text), Kind::Enumeration { items, .. }) => {
                items.iter().find(|(name, _)| name == text).map(|(_, value)| f64::from(*value))
            }
            (Self::Boolean(value), Kind::Boolean { .. }) => Some(f64::from(u8::from(*value))),
            _ => None,
        };
        let value = found.with_context(|| format!("{name} = {self} is not allowed: {}", parameter.allowed()))?;
        parameter.admit(value)?;
        Ok(value)
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plain(value) => write!(f, "{value}"),
            Self::Text(text) => write!(f, "\"{text}\""),
            Self::Boolean(value) => write!(f, "{value}"),
        }
    }
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::List(numbers) => numbers.len(),
            Self::Range(Range { count, .. }) => *count,
        }
    }

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All values in SI units.
    ///
    /// # Errors
    /// As [`Number::value`].
    pub fn list(&self, parameter: &Parameter) -> Result<Vec<f64>> {
        match self {
            Self::List(numbers) => {
                ensure!(!numbers.is_empty(), "`{}` has no values", parameter.name);
                numbers.iter().map(|number| number.value(parameter)).collect()
            }
            Self::Range(Range { from, to, count, logarithmic }) => {
                let (from, to) = (from.value(parameter)?, to.value(parameter)?);
                Ok(crate::dynamics::bifurcation::Range::new(parameter.name, from, to, *count, *logarithmic)?.values)
            }
        }
    }
}

/// Reads a [`Number`].
struct OneNumber;

impl Visitor<'_> for OneNumber {
    type Value = Number;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number in SI units, a text with a number and its unit, an item of a list, true or false")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Number, E> {
        Ok(Number::Plain(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Number, E> {
        Ok(Number::Plain(value as f64))
    }

    fn visit_str<E>(self, text: &str) -> Result<Number, E> {
        Ok(Number::Text(text.into()))
    }

    fn visit_bool<E>(self, value: bool) -> Result<Number, E> {
        Ok(Number::Boolean(value))
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneNumber)
    }
}

/// Reads [`Values`].
struct AllValues;

impl<'de> Visitor<'de> for AllValues {
    type Value = Values;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of values, or a range { from, to, count, logarithmic }")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Values, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(Values::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, range: A) -> Result<Values, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(range)).map(Values::Range)
    }
}

impl<'de> Deserialize<'de> for Values {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AllValues)
    }
}

/// A number in this SI unit.
fn in_unit<'de, D: Deserializer<'de>>(deserializer: D, unit: &str) -> Result<f64, D::Error> {
    let number = Number::deserialize(deserializer)?.in_unit(unit).map_err(D::Error::custom)?;
    if number.is_finite() { Ok(number) } else { Err(D::Error::custom(format!("{number} {unit} is not finite"))) }
}

/// A time [s].
pub fn seconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    in_unit(deserializer, "s")
}

/// An angle [rad], if there is one.
pub fn radians<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    in_unit(deserializer, "rad").map(Some)
}
