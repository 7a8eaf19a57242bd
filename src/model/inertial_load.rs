//! Force and moment that the motion of a body requires.

use super::body::Body;
use super::plane::{Rotation, Vec2, cross, perp};
use crate::math::Real;

/// Force and moment about the reference point that the motion of a body requires, less those of gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InertialLoad<R = f64> {
    /// [N] Force.
    pub force: Vec2<R>,
    /// [N·m] Moment about the body's reference point.
    pub moment: R,
}

impl<R: Real> InertialLoad<R> {
    /// The load of a rigid body with this rotation, speed [rad/s] and angular acceleration `alpha` [rad/s²], whose
    /// reference point accelerates with `point` [m/s²].
    pub fn new(body: &Body, rotation: Rotation<R>, speed: R, alpha: R, point: Vec2<R>, gravity: Vec2) -> Self {
        let com = rotation.apply(body.com);
        let acceleration = point + alpha * perp(com) - speed * speed * com;
        let force = (acceleration - gravity) * body.mass;
        Self { force, moment: alpha * body.inertia + cross(com, force) }
    }
}
