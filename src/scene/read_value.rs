//! One value of a scene file: a number in SI units, or a text with a unit.

use super::problem::Fault;
use super::units::{alternatives, quantity};
use toml::Spanned;
use toml::de::DeValue;

/// A value with its place in the file.
pub(super) type Value<'i> = Spanned<DeValue<'i>>;

/// A number in SI units, given as a number or as a text with a unit.
pub(super) fn number(text: &str, key: &str, value: &Value, unit: &str) -> Result<f64, Fault> {
    let wrong = || Fault::Type {
        key: key.to_owned(),
        found: source(text, value),
        wanted: match unit {
            "1" => "a finite number".to_owned(),
            _ => format!("a finite number in {unit} or a text with a unit"),
        },
    };
    let number: f64 = match value.get_ref() {
        DeValue::Float(float) => float.as_str().parse().map_err(|_| wrong())?,
        DeValue::Integer(_) => integer(value).ok_or_else(wrong)?,
        DeValue::String(quoted) => quantity(quoted, unit).map_err(|why| Fault::Unit {
            key: key.to_owned(),
            found: source(text, value),
            why,
            units: alternatives(unit).join(", "),
        })?,
        _ => return Err(wrong()),
    };
    number.is_finite().then_some(number).ok_or_else(wrong)
}

/// The value of a TOML integer; `None` for other types. Integers beyond 2^53 are rounded, far outside any range.
pub(super) fn integer(value: &Value) -> Option<f64> {
    let DeValue::Integer(integer) = value.get_ref() else {
        return None;
    };
    i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64)
}

/// The first line of a value as written in the file.
pub(super) fn source(text: &str, value: &Value) -> String {
    let whole = text.get(value.span()).unwrap_or_default();
    let mut lines = whole.lines();
    let first = lines.next().unwrap_or_default().to_owned();
    if lines.next().is_some() { first + " ..." } else { first }
}
