//! The loop at the start: A → crank pin → rod → slider pin, closed with every eccentricity in its place.

use super::data::{Guide, Point, Revolute, Scene};
use super::enumerations::JointModel;
use crate::math;

/// sin of the rod's angle at the start: l·sin θ2 = height of the small end − height of the big end.
/// The loop closes if it lies within (−1, 1); at ±1 the rod's speed has no bound.
pub fn rod_sine(scene: &Scene) -> f64 {
    rise(scene) / scene.rod.length
}

/// [m] Small end above big end at the start.
pub(super) fn rise(scene: &Scene) -> f64 {
    let joints = &scene.joint;
    let (sin, _) = math::sin_cos(scene.crank.angle_start);
    let crank_pin = joints.a.eccentricity_at_start().y + sin * scene.crank.length;
    let big_end = crank_pin - joints.b.eccentricity_at_start().y;
    let pin = scene.guide.offset + joints.t.offset_at_start() - scene.slider.centre.y;
    pin - joints.c.eccentricity_at_start().y - big_end
}

impl Revolute {
    /// [m] Journal centre minus bearing centre; an ideal joint's is zero whatever is given.
    pub fn eccentricity_at_start(&self) -> Point {
        match self.model {
            JointModel::Ideal => Point::default(),
            JointModel::Clearance => self.eccentricity_start,
        }
    }
}

impl Guide {
    /// [m] Rectangle's centre above the middle line; an ideal guide's is zero whatever is given.
    pub fn offset_at_start(&self) -> f64 {
        match self.model {
            JointModel::Ideal => 0.0,
            JointModel::Clearance => self.offset_start,
        }
    }
}
