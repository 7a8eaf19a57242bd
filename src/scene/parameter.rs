//! A scene's parameters by name: what `modelDescription/variables.toml` declares of them.

use super::Scene;
use super::enumerations::*;
use std::fmt;

include!(concat!(env!("OUT_DIR"), "/parameters.rs"));

/// One parameter: its name, its legal range and where the scene holds it.
pub struct Parameter {
    /// As on the FMU's face, such as `joint.C.clearance`.
    pub name: &'static str,
    /// One line of explanation.
    pub description: &'static str,
    /// Type, range and place.
    pub kind: Kind,
}

/// Type, range and place of a parameter.
pub enum Kind {
    /// A real number in SI units.
    Real {
        /// SI unit, as on the FMU's face, such as `rad/s`.
        unit: &'static str,
        /// Value of an untouched scene.
        start: f64,
        /// Least legal value.
        min: f64,
        /// Greatest legal value.
        max: f64,
        /// Reads the scene.
        get: fn(&Scene) -> f64,
        /// Writes the scene.
        set: fn(&mut Scene, f64),
    },
    /// One of a list of named values.
    Enumeration {
        /// Value of an untouched scene.
        start: i32,
        /// Names and values.
        items: &'static [(&'static str, i32)],
        /// Reads the scene.
        get: fn(&Scene) -> i32,
        /// Writes the scene; `None` for a value that is not in the list.
        set: fn(&mut Scene, i32) -> Option<()>,
    },
}

/// A value that a parameter cannot take.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// Of the parameter.
    pub name: &'static str,
    /// What was asked for, in SI units or an item's value.
    pub found: f64,
    /// What is legal, in words.
    pub allowed: String,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} is not allowed: {}", self.name, self.found, self.allowed)
    }
}

impl std::error::Error for Refusal {}

impl Parameter {
    /// The parameter of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name)
    }

    /// Value in a scene; an enumeration's by its item's value.
    pub fn value(&self, scene: &Scene) -> f64 {
        match self.kind {
            Kind::Real { get, .. } => get(scene),
            Kind::Enumeration { get, .. } => f64::from(get(scene)),
        }
    }

    /// Value of an untouched scene.
    pub fn start(&self) -> f64 {
        match self.kind {
            Kind::Real { start, .. } => start,
            Kind::Enumeration { start, .. } => f64::from(start),
        }
    }

    /// Writes a legal value into a scene, and leaves the scene alone otherwise.
    pub fn write(&self, scene: &mut Scene, value: f64) -> Result<(), Refusal> {
        let written = match self.kind {
            Kind::Real { min, max, set, .. } => (min..=max).contains(&value).then(|| set(scene, value)),
            // A fraction is no item; the cast saturates, and i32::MAX is none either.
            Kind::Enumeration { set, .. } if value.fract() == 0.0 => set(scene, value as i32),
            Kind::Enumeration { .. } => None,
        };
        written.ok_or_else(|| Refusal { name: self.name, found: value, allowed: self.allowed() })
    }

    /// The legal values in words: `1e-9 to 0.1 m`, `1 (ideal) or 2 (clearance)`.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Real { unit, min, max, .. } => {
                let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
                format!("{min:?} to {max:?}{unit}")
            }
            Kind::Enumeration { items, .. } => {
                items.iter().map(|(name, value)| format!("{value} ({name})")).collect::<Vec<_>>().join(", ")
            }
        }
    }
}
