//! The ideal slider-crank: rod and slider as functions of the crank's angle.

use super::plane::Rotation;
use crate::scene::Scene;

/// Lengths of an ideal slider-crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealMechanism {
    /// [m] Crank.
    pub crank: f64,
    /// [m] Rod.
    pub rod: f64,
    /// [m] Height of the slider's pin, h − gy.
    pub height: f64,
}

/// Where the rod and the slider are, and how they move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealMotion {
    /// Rotation of the rod.
    pub rod: Rotation,
    /// dφ/dθ: rod speed over crank speed.
    pub rod_ratio: f64,
    /// [rad/s²] Rod acceleration at a steady crank speed.
    pub rod_bias: f64,
    /// [m] Pin along the guide.
    pub x: f64,
    /// [m] dx/dθ.
    pub x_ratio: f64,
    /// [m/s²] d²x/dt² at a steady crank speed.
    pub x_bias: f64,
}

impl IdealMechanism {
    /// Of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self { crank: scene.crank.length, rod: scene.rod.length, height: scene.guide.offset - scene.slider.centre.y }
    }

    /// At the crank's rotation and speed [rad/s]. Not finite where the mechanism cannot be.
    #[inline(always)]
    pub fn motion(&self, crank: Rotation, speed: f64) -> IdealMotion {
        let Self { crank: r, rod: l, height } = *self;
        let sin = (height - r * crank.sin) / l;
        let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
        // r·sin θ + l·sin φ = height, once and twice differentiated.
        let per_reach = 1.0 / (l * cos);
        let rod_ratio = -r * crank.cos * per_reach;
        let rod_speed = rod_ratio * speed;
        let rod_bias = (r * crank.sin * speed * speed + l * sin * rod_speed * rod_speed) * per_reach;
        IdealMotion {
            rod: Rotation { cos, sin },
            rod_ratio,
            rod_bias,
            x: r * crank.cos + l * cos,
            x_ratio: -r * crank.sin - l * sin * rod_ratio,
            x_bias: -r * crank.cos * speed * speed - l * (cos * rod_speed * rod_speed + sin * rod_bias),
        }
    }
}
