//! A scene's parameters by name: what `modelDescription/variables.toml` declares of them.

use super::Scene;

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
