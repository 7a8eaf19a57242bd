//! What a body's motion needs.

use super::body::Body;
use super::plane::{Rotation, Vec2, cross, perp};
use crate::math::Real;

/// What a body's motion needs of forces and of moments about its reference point, gravity subtracted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InertialLoad<R = f64> {
    /// [N]
    pub force: Vec2<R>,
    /// [N·m] About the body's reference point.
    pub moment: R,
}

impl<R: Real> InertialLoad<R> {
    /// Of a rigid body.
    pub fn new(body: &Body, rotation: Rotation<R>, speed: R, alpha: R, point: Vec2<R>, gravity: f64) -> Self {
        let com = rotation.apply(body.com);
        let acceleration = point + alpha * perp(com) - speed * speed * com;
        let force = (acceleration + Vec2::new(0.0, gravity)) * body.mass;
        Self { force, moment: alpha * body.inertia + cross(com, force) }
    }
}
