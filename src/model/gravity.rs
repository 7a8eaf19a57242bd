//! Gravity.

use super::plane::Vec2;
use crate::math;
use crate::scene::Scene;
use std::f64::consts::FRAC_PI_2;

/// [m/s²] The acceleration of free fall: `gravity` in the direction `gravity.angle`. At the start value of the angle,
/// −π/2, it is exactly along −y.
pub fn free_fall(scene: &Scene) -> Vec2 {
    if scene.gravity == 0.0 || scene.gravity_angle == -FRAC_PI_2 {
        return Vec2::new(0.0, -scene.gravity);
    }
    let (sin, cos) = math::sin_cos(scene.gravity_angle);
    Vec2::new(scene.gravity * cos, scene.gravity * sin)
}
