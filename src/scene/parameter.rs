//! A scene's parameters by name: what `modelDescription/variables.toml` declares of them.

use super::data::{Crank, Drive, Energy, GuideLines, Joints, Rod, Scene, Slider, Solver};
use super::enumerations::*;
use crate::model_description::number::number;
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
    /// A number to count with.
    Integer {
        /// Value of an untouched scene.
        start: i32,
        /// Least legal value.
        min: i32,
        /// Greatest legal value.
        max: i32,
        /// Reads the scene.
        get: fn(&Scene) -> i32,
        /// Writes the scene.
        set: fn(&mut Scene, i32),
    },
    /// True or false.
    Boolean {
        /// Value of an untouched scene.
        start: bool,
        /// Reads the scene.
        get: fn(&Scene) -> bool,
        /// Writes the scene.
        set: fn(&mut Scene, bool),
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

impl Default for Scene {
    fn default() -> Self {
        let mut scene = Self {
            drive: Drive::default(),
            gravity: 0.0,
            crank: Crank::default(),
            rod: Rod::default(),
            slider: Slider::default(),
            guide: GuideLines::default(),
            joint: Joints::default(),
            energy: Energy::default(),
            solver: Solver::default(),
        };
        for parameter in PARAMETERS {
            // A start value outside its own range does not pass build.rs.
            let _ = parameter.write(&mut scene, parameter.start());
        }
        scene
    }
}

/// A value that a parameter cannot take.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// Of the parameter.
    pub name: &'static str,
    /// What was asked for, as [`Parameter::value`] tells it.
    pub found: f64,
    /// What is legal, in words.
    pub allowed: String,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} is not allowed: {}", self.name, number(self.found), self.allowed)
    }
}

impl std::error::Error for Refusal {}

impl Parameter {
    /// The parameter of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name)
    }

    /// Value in a scene: in SI units, an enumeration's by its item's value, a Boolean's as 0 or 1.
    pub fn value(&self, scene: &Scene) -> f64 {
        match self.kind {
            Kind::Real { get, .. } => get(scene),
            Kind::Integer { get, .. } | Kind::Enumeration { get, .. } => f64::from(get(scene)),
            Kind::Boolean { get, .. } => f64::from(u8::from(get(scene))),
        }
    }

    /// Value of an untouched scene.
    pub fn start(&self) -> f64 {
        match self.kind {
            Kind::Real { start, .. } => start,
            Kind::Integer { start, .. } | Kind::Enumeration { start, .. } => f64::from(start),
            Kind::Boolean { start, .. } => f64::from(u8::from(start)),
        }
    }

    /// Refuses a value outside the range or list.
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

    /// Writes a legal value into a scene, and leaves the scene alone otherwise.
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

    /// The legal values in words: `1e-9 to 0.1 m`, `1 (ideal), 2 (clearance)`, `true or false`.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Real { unit, min, max, .. } => {
                let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
                format!("{} to {}{unit}", number(min), number(max))
            }
            Kind::Integer { min, max, .. } => format!("{min} to {max}"),
            Kind::Boolean { .. } => "true or false".to_owned(),
            Kind::Enumeration { items, .. } => {
                items.iter().map(|(name, value)| format!("{value} ({name})")).collect::<Vec<_>>().join(", ")
            }
        }
    }
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
        assert_eq!(allowed("rod.flexible.bending_modes"), "0 to 8");
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
