//! The parameters of a scene by name, as declared in `modelDescription/variables.toml`.

#![allow(clippy::approx_constant, reason = "start values are declared as numbers")]

use super::data::{Crank, Drive, Energy, GuideLines, Joints, Rod, Scene, Slider, Solver};
use super::enumerations::*;
use crate::model_description::number::number;
use std::fmt;

include!(concat!(env!("OUT_DIR"), "/parameters.rs"));

/// A parameter: its name, its range and its place in the scene.
pub struct Parameter {
    /// Name in the FMU's interface, such as `joint.C.clearance`.
    pub name: &'static str,
    /// Description in one line.
    pub description: &'static str,
    /// Type, range, and access to the scene.
    pub kind: Kind,
}

/// Type of a parameter, with range and access to the scene.
pub enum Kind {
    /// A real number in SI units.
    Real {
        /// SI unit in the FMU's interface, such as `rad/s`.
        unit: &'static str,
        /// Start value.
        start: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
        /// Reads the value from a scene.
        get: fn(&Scene) -> f64,
        /// Writes the value into a scene.
        set: fn(&mut Scene, f64),
    },
    /// An integer.
    Integer {
        /// Start value.
        start: i32,
        /// Smallest allowed value.
        min: i32,
        /// Largest allowed value.
        max: i32,
        /// Reads the value from a scene.
        get: fn(&Scene) -> i32,
        /// Writes the value into a scene.
        set: fn(&mut Scene, i32),
    },
    /// A Boolean.
    Boolean {
        /// Start value.
        start: bool,
        /// Reads the value from a scene.
        get: fn(&Scene) -> bool,
        /// Writes the value into a scene.
        set: fn(&mut Scene, bool),
    },
    /// An item of an enumeration.
    Enumeration {
        /// Start value.
        start: i32,
        /// Names and values of the items.
        items: &'static [(&'static str, i32)],
        /// Reads the value from a scene.
        get: fn(&Scene) -> i32,
        /// Writes the value into a scene; `None` for a value that is not in the list.
        set: fn(&mut Scene, i32) -> Option<()>,
    },
}

impl Default for Scene {
    fn default() -> Self {
        let mut scene = Self {
            drive: Drive::default(),
            gravity: 0.0,
            gravity_angle: 0.0,
            crank: Crank::default(),
            rod: Rod::default(),
            slider: Slider::default(),
            guide: GuideLines::default(),
            joint: Joints::default(),
            energy: Energy::default(),
            solver: Solver::default(),
        };
        for parameter in PARAMETERS {
            // build.rs rejects a start value outside its range.
            let _ = parameter.write(&mut scene, parameter.start());
        }
        scene
    }
}

/// A value that is not allowed for a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// Name of the parameter.
    pub name: &'static str,
    /// The value, as defined in [`Parameter::value`].
    pub found: f64,
    /// The allowed values, in words.
    pub allowed: String,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} is not allowed: {}", self.name, number(self.found), self.allowed)
    }
}

impl std::error::Error for Refusal {}

impl Parameter {
    /// The parameter with this name; `None` if there is none.
    pub fn named(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name)
    }

    /// Unit of its value; `1` without one.
    pub fn unit(&self) -> &'static str {
        if let Kind::Real { unit, .. } = self.kind { unit } else { "1" }
    }

    /// Value in a scene: in SI units; of an enumeration the value of its item, of a Boolean 0 or 1.
    pub fn value(&self, scene: &Scene) -> f64 {
        match self.kind {
            Kind::Real { get, .. } => get(scene),
            Kind::Integer { get, .. } | Kind::Enumeration { get, .. } => f64::from(get(scene)),
            Kind::Boolean { get, .. } => f64::from(u8::from(get(scene))),
        }
    }

    /// Start value.
    pub fn start(&self) -> f64 {
        match self.kind {
            Kind::Real { start, .. } => start,
            Kind::Integer { start, .. } | Kind::Enumeration { start, .. } => f64::from(start),
            Kind::Boolean { start, .. } => f64::from(u8::from(start)),
        }
    }

    /// Checks that a value is within the range or list.
    ///
    /// # Errors
    /// The refusal of a value that is not allowed.
    pub fn admit(&self, value: f64) -> Result<(), Refusal> {
        let legal = match self.kind {
            Kind::Real { min, max, .. } => (min..=max).contains(&value),
            Kind::Integer { min, max, .. } => {
                value.fract() == 0.0 && (f64::from(min)..=f64::from(max)).contains(&value)
            }
            Kind::Boolean { .. } => value == 0.0 || value == 1.0,
            Kind::Enumeration { items, .. } => items.iter().any(|(_, item)| f64::from(*item) == value),
        };
        if legal { Ok(()) } else { Err(Refusal { name: self.name, found: value, allowed: self.allowed() }) }
    }

    /// Writes a value into a scene.
    ///
    /// # Errors
    /// The refusal of a value that is not allowed; the scene is then unchanged.
    pub fn write(&self, scene: &mut Scene, value: f64) -> Result<(), Refusal> {
        self.admit(value)?;
        match self.kind {
            Kind::Real { set, .. } => set(scene, value),
            Kind::Integer { set, .. } => set(scene, value as i32),
            Kind::Boolean { set, .. } => set(scene, value != 0.0),
            Kind::Enumeration { set, .. } => set(scene, value as i32).unwrap_or_default(),
        }
        Ok(())
    }

    /// The allowed values in words: `1e-9 to 0.1 m`, `an integer, 0 to 8`, `1 (ideal), 2 (clearance)`, `true or false`.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Real { unit, min, max, .. } => format!("{} to {}", number(min), with_unit(max, unit)),
            Kind::Integer { min, max, .. } => format!("an integer, {min} to {max}"),
            Kind::Boolean { .. } => "true or false".to_owned(),
            Kind::Enumeration { items, .. } => {
                items.iter().map(|(name, value)| format!("{value} ({name})")).collect::<Vec<_>>().join(", ")
            }
        }
    }
}

/// A number with its unit, if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    format!("{}{unit}", number(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn allowed(name: &str) -> String {
        Parameter::named(name).expect("a parameter").allowed()
    }

    #[test]
    fn ranges_are_told_in_few_digits_and_every_one_has_two_ends() {
        assert_eq!(allowed("joint.C.clearance"), "1e-9 to 0.1 m");
        assert_eq!(allowed("joint.C.young.bearing"), "1000 to 1e14 Pa");
        assert_eq!(allowed("joint.C.ratio_limit"), "-1e9 to 1e9");
        assert_eq!(allowed("rod.flexible.bending_modes"), "an integer, 0 to 8");
        assert_eq!(allowed("energy.audit"), "true or false");
        assert_eq!(allowed("joint.T.surface"), "1 (corner), 2 (foundation)");
        for parameter in PARAMETERS {
            let text = parameter.allowed();
            let endless = ["inf", "e308", "NaN", "2147483647"].iter().any(|word| text.contains(word));
            assert!(!endless && text.len() < 400, "{}: {text}", parameter.name);
        }
    }

    #[test]
    fn what_is_refused_leaves_the_scene_alone() {
        let mut scene = Scene::default();
        let before = scene.clone();
        for (name, value) in [
            ("rod.flexible.bending_modes", 8.5),
            ("rod.flexible.bending_modes", 9.0),
            ("rod.flexible.axial_modes", f64::NAN),
            ("energy.audit", 2.0),
            ("energy.audit", 0.5),
            ("joint.T.surface", 1.5),
            ("rod.length", f64::INFINITY),
        ] {
            let parameter = Parameter::named(name).expect("a parameter");
            let refusal = parameter.write(&mut scene, value).expect_err("an illegal value");
            assert_eq!((refusal.name, refusal.allowed), (name, parameter.allowed()));
        }
        assert_eq!(scene, before);
    }
}
