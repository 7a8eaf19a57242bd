//! Values in study files: numbers in SI units, texts with a unit, truth values, lists and ranges. An error says what is
//! allowed; the reader of TOML adds line and key.

use super::study::{Number, Values};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

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
    Number::deserialize(deserializer)?.in_unit(unit).map_err(D::Error::custom)
}

/// A time [s].
pub fn seconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    in_unit(deserializer, "s")
}

/// An angle [rad], if there is one.
pub fn radians<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    in_unit(deserializer, "rad").map(Some)
}
