//! Rigid bodies.

use super::plane::Vec2;

/// A rigid body: its mass properties and its second joint, which lies on the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// [kg] Mass.
    pub mass: f64,
    /// [kg·m²] Moment of inertia about the centre of mass.
    pub inertia: f64,
    /// [m] Centre of mass from the reference point, in body axes.
    pub com: Vec2,
    /// [m] Distance of the second joint from the reference point, along the body's x axis.
    pub length: f64,
}

/// Crank, rod and slider.
pub type Bodies = [Body; 3];
