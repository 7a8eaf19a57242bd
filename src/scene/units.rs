//! Units: the only place with millimetres, revolutions per minute and degrees; converts text to SI.
//!
//! A quantity is a number and a unit, `"50 mm"`. A unit is symbols with exponents, joined by `.`
//! (or `·`, `*`) and `/`, which divides by the next symbol only: `kg.mm2`, `N.m.s/rad`, `N/m1.5`.

use std::f64::consts::{PI, TAU};
use std::fmt;

/// Twice the exponents of kg, m, s and rad; twice, because the stiffness of a Hertzian contact has a half-integer
/// exponent.
type Dimension = [i32; 4];

const NONE: Dimension = [0, 0, 0, 0];
const MASS: Dimension = [2, 0, 0, 0];
const LENGTH: Dimension = [0, 2, 0, 0];
const TIME: Dimension = [0, 0, 2, 0];
const ANGLE: Dimension = [0, 0, 0, 2];
const SPEED: Dimension = [0, 0, -2, 2];
const FORCE: Dimension = [2, 2, -4, 0];
const TORQUE: Dimension = [2, 4, -4, 0];
const PRESSURE: Dimension = [2, -2, -4, 0];
/// Torque times angle, so that a torque in joules is rejected.
const ENERGY: Dimension = [2, 4, -4, 2];
const POWER: Dimension = [2, 4, -6, 2];

/// Symbol, dimension, and the factor to SI as a quotient, so that 50 mm is 50/1000 m to the bit.
const SYMBOLS: &[(&str, Dimension, f64, f64)] = &[
    ("1", NONE, 1.0, 1.0),
    ("%", NONE, 1.0, 1e2),
    ("kg", MASS, 1.0, 1.0),
    ("g", MASS, 1.0, 1e3),
    ("mg", MASS, 1.0, 1e6),
    ("t", MASS, 1e3, 1.0),
    ("m", LENGTH, 1.0, 1.0),
    ("mm", LENGTH, 1.0, 1e3),
    ("um", LENGTH, 1.0, 1e6),
    ("µm", LENGTH, 1.0, 1e6),
    ("μm", LENGTH, 1.0, 1e6),
    ("nm", LENGTH, 1.0, 1e9),
    ("cm", LENGTH, 1.0, 1e2),
    ("s", TIME, 1.0, 1.0),
    ("ms", TIME, 1.0, 1e3),
    ("us", TIME, 1.0, 1e6),
    ("µs", TIME, 1.0, 1e6),
    ("μs", TIME, 1.0, 1e6),
    ("min", TIME, 60.0, 1.0),
    ("rad", ANGLE, 1.0, 1.0),
    ("mrad", ANGLE, 1.0, 1e3),
    ("deg", ANGLE, PI, 180.0),
    ("°", ANGLE, PI, 180.0),
    ("rev", ANGLE, TAU, 1.0),
    ("rpm", SPEED, TAU, 60.0),
    ("spm", SPEED, TAU, 60.0), // a press makes one stroke per turn
    ("N", FORCE, 1.0, 1.0),
    ("kN", FORCE, 1e3, 1.0),
    ("MN", FORCE, 1e6, 1.0),
    ("Nm", TORQUE, 1.0, 1.0),
    ("kNm", TORQUE, 1e3, 1.0),
    ("J", ENERGY, 1.0, 1.0),
    ("mJ", ENERGY, 1.0, 1e3),
    ("kJ", ENERGY, 1e3, 1.0),
    ("MJ", ENERGY, 1e6, 1.0),
    ("W", POWER, 1.0, 1.0),
    ("kW", POWER, 1e3, 1.0),
    ("Pa", PRESSURE, 1.0, 1.0),
    ("mPa", PRESSURE, 1.0, 1e3),
    ("kPa", PRESSURE, 1e3, 1.0),
    ("MPa", PRESSURE, 1e6, 1.0),
    ("GPa", PRESSURE, 1e9, 1.0),
    ("bar", PRESSURE, 1e5, 1.0),
];

/// Compound units that messages suggest; other compound units are accepted, too.
const COMPOUNDS: &[&str] = &["mm2", "cm2", "mm4", "cm4", "g/cm3", "N/mm2", "N/mm3", "1/mm", "s/mm"];

/// A text is not a quantity of the required dimension.
#[derive(Clone, Debug, PartialEq)]
pub enum UnitError {
    /// The text does not begin with a number.
    NoNumber,
    /// The number is too large.
    Overflow,
    /// The text has no unit.
    NoUnit,
    /// The unit contains an unknown symbol.
    Unknown(String),
    /// The unit has another dimension.
    Dimension(String),
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNumber => f.write_str("no number before the unit"),
            Self::Overflow => f.write_str("the number is beyond 1.8e308"),
            Self::NoUnit => f.write_str("no unit; a number in SI units stands without quotation marks"),
            Self::Unknown(symbol) => write!(f, "unknown unit `{symbol}`"),
            Self::Dimension(unit) => write!(f, "`{unit}` measures something else"),
        }
    }
}

impl std::error::Error for UnitError {}

/// The number in SI units of a text such as `50 mm`; `wanted` is the SI unit.
pub fn quantity(text: &str, wanted: &str) -> Result<f64, UnitError> {
    let (number, unit) = split(text).ok_or(UnitError::NoNumber)?;
    if !number.is_finite() {
        return Err(UnitError::Overflow);
    }
    if unit.is_empty() {
        return Err(UnitError::NoUnit);
    }
    let (dimension, times, over) = parse(unit)?;
    let (wanted, ..) = parse(wanted)?;
    if dimension != wanted {
        return Err(UnitError::Dimension(unit.to_owned()));
    }
    Ok(number * times / over)
}

/// Units in which a quantity with this SI unit may be given, the SI unit first.
pub fn alternatives(unit: &str) -> Vec<&str> {
    let dimension = parse(unit).map_or(NONE, |(dimension, ..)| dimension);
    let others = SYMBOLS
        .iter()
        .filter(|(symbol, of, ..)| *of == dimension && *symbol != unit && symbol.is_ascii())
        .map(|(symbol, ..)| *symbol);
    let fits = |compound: &&str| *compound != unit && parse(compound).is_ok_and(|(of, ..)| of == dimension);
    std::iter::once(unit).chain(others).chain(COMPOUNDS.iter().copied().filter(fits)).collect()
}

/// The longest number in digits at the beginning of a text, and the rest of the text.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let ends = (1..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
    let mut starts = ends.map(|end| (text[..end].trim_end(), text[end..].trim_start()));
    let in_digits = |number: &str| number.ends_with(|c: char| c.is_ascii_digit() || c == '.');
    starts.find_map(|(number, rest)| Some((number.parse().ok().filter(|_| in_digits(number))?, rest)))
}

/// Dimension and factor to SI of a unit.
fn parse(unit: &str) -> Result<(Dimension, f64, f64), UnitError> {
    let (mut dimension, mut times, mut over) = (NONE, 1.0, 1.0);
    let mut sign = 1;
    let mut rest = unit;
    loop {
        let (symbol, after) = rest.split_at(rest.find(|c| !in_symbol(c)).unwrap_or(rest.len()));
        let (symbol, after) =
            if after.len() == rest.len() && rest.starts_with('1') { rest.split_at(1) } else { (symbol, after) };
        let (doubled, after) = exponent(after);
        let (_, of, up, down) = SYMBOLS
            .iter()
            .find(|(known, ..)| *known == symbol)
            .ok_or_else(|| UnitError::Unknown(if symbol.is_empty() { unit } else { symbol }.into()))?;
        for (total, exponent) in dimension.iter_mut().zip(of) {
            *total += sign * exponent * doubled / 2;
        }
        let (up, down) = (power(*up, doubled), power(*down, doubled));
        (times, over) = if sign > 0 { (times * up, over * down) } else { (times * down, over * up) };
        let Some(joint) = after.chars().next() else {
            return Ok((dimension, times, over));
        };
        sign = match joint {
            '.' | '·' | '*' => 1,
            '/' => -1,
            _ => return Err(UnitError::Unknown(unit.to_owned())),
        };
        rest = &after[joint.len_utf8()..];
    }
}

fn in_symbol(c: char) -> bool {
    c.is_alphabetic() || c == '%' || c == '°'
}

/// Twice the exponent at the beginning of a text (1 without an exponent), and the rest of the text.
fn exponent(text: &str) -> (i32, &str) {
    for (digits, doubled) in [("1.5", 3), ("2", 4), ("²", 4), ("3", 6), ("³", 6), ("4", 8), ("⁴", 8)] {
        if let Some(rest) = text.strip_prefix(digits) {
            return (doubled, rest);
        }
    }
    (2, text)
}

/// factor^(doubled/2), exact for integer exponents.
fn power(factor: f64, doubled: i32) -> f64 {
    match doubled % 2 {
        0 => factor.powi(doubled / 2),
        _ => libm::pow(factor, f64::from(doubled) / 2.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_s_units_are_si_to_the_bit() {
        for (text, unit, si) in [
            ("50 mm", "m", 0.05),
            ("500um", "m", 5e-4),
            ("500 µm", "m", 5e-4),
            ("5e-1 mm", "m", 5e-4),
            ("-300 kN", "N", -3e5),
            ("90 deg", "rad", PI / 2.0),
            ("360 °", "rad", TAU),
            ("5000 rpm", "rad/s", 523.598_775_598_298_9),
            ("300 spm", "rad/s", 10.0 * PI),
            ("207 GPa", "Pa", 207e9),
            ("10 us", "s", 1e-5),
            ("300 g", "kg", 0.3),
            ("100 kg.mm2", "kg.m2", 1e-4),
            ("100 kg·mm²", "kg.m2", 1e-4),
            ("2 N.mm.s/deg", "N.m.s/rad", 2.0 * 180.0 / (1e3 * PI)),
            ("2 kNm", "N.m", 2000.0),
            ("9810 mm/s2", "m/s2", 9.81),
            ("90 %", "1", 0.9),
            ("3 N/mm1.5", "N/m1.5", 3.0 * 1e3_f64.powf(1.5)),
        ] {
            assert_eq!(quantity(text, unit), Ok(si), "{text}");
        }
    }

    #[test]
    fn what_is_no_quantity_is_refused_by_name() {
        let unknown = |unit: &str| Err(UnitError::Unknown(unit.into()));
        assert_eq!(quantity("mm", "m"), Err(UnitError::NoNumber));
        assert_eq!(quantity("inf mm", "m"), Err(UnitError::NoNumber));
        assert_eq!(quantity("1e400 mm", "m"), Err(UnitError::Overflow));
        assert_eq!(quantity("50", "m"), Err(UnitError::NoUnit));
        assert_eq!(quantity("50 furlong", "m"), unknown("furlong"));
        assert_eq!(quantity("50 mm7", "m"), unknown("mm7"));
        assert_eq!(quantity("50 mm.", "m"), unknown("mm."));
        assert_eq!(quantity("50 mm", "rad"), Err(UnitError::Dimension("mm".into())));
        assert_eq!(quantity("50 1/s", "rad/s"), Err(UnitError::Dimension("1/s".into())));
    }

    #[test]
    fn display_units_of_the_declaration_mean_the_same_here() {
        let declaration = crate::model_description::load().expect("the declaration");
        for unit in &declaration.units {
            assert!(quantity(&format!("1 {}", unit.name), &unit.name) == Ok(1.0), "{}", unit.name);
            for display in &unit.display {
                let shown = format!("{:?} {}", display.factor, display.name);
                let si = quantity(&shown, &unit.name).expect("a known unit");
                // Two roundings: of the declared factor and of the quotient.
                assert!((si - 1.0).abs() <= 2.0 * f64::EPSILON, "{shown} is {si}");
            }
        }
    }
}
