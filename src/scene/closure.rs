//! Loop closure in the start pose: main bearing, crank pin, rod and slider pin with their eccentricities.

use super::data::{Guide, Point, Revolute, Scene};
use super::enumerations::JointModel;
use crate::math;

/// Sine of the rod angle in the start pose: l·sin θ2 = height of the small end − height of the big end. The loop closes
/// if the sine is within (−1, 1); at ±1 the rod's speed is unbounded.
pub fn rod_sine(scene: &Scene) -> f64 {
    rise(scene) / scene.rod.length
}

/// [m] Height of the small end above the big end in the start pose.
pub(super) fn rise(scene: &Scene) -> f64 {
    let joints = &scene.joint;
    let (sin, _) = math::sin_cos(scene.crank.angle_start);
    let crank_pin = joints.a.eccentricity_at_start().y + sin * scene.crank.length;
    let big_end = crank_pin - joints.b.eccentricity_at_start().y;
    let pin = scene.guide.offset + joints.t.offset_at_start() - scene.slider.centre.y;
    pin - joints.c.eccentricity_at_start().y - big_end
}

impl Revolute {
    /// [m] Journal centre minus bearing centre in the start pose; zero for an ideal joint.
    pub fn eccentricity_at_start(&self) -> Point {
        match self.model {
            JointModel::Ideal => Point::default(),
            JointModel::Clearance => self.eccentricity_start,
        }
    }
}

impl Guide {
    /// [m] Height of the rectangle's centre above the middle line in the start pose; zero for an ideal guide.
    pub fn offset_at_start(&self) -> f64 {
        match self.model {
            JointModel::Ideal => 0.0,
            JointModel::Clearance => self.offset_start,
        }
    }
}
