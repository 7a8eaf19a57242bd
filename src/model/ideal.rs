//! The ideal slider-crank: rod and slider as functions of the crank angle.

use super::plane::Rotation;
use super::rod::Chord;
use crate::integrator::EventFunction;
use crate::math::{self, Real};
use crate::scene::Scene;
use std::f64::consts::{PI, TAU};

/// Smallest cosine of the rod angle. A rod that is longer than its crank by less than half a millionth cannot pass the
/// change point: rounding and integration errors would decide on which branch it continues.
const MIN_COSINE: f64 = 1e-3;

/// Dimensions of an ideal slider-crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealMechanism {
    /// [m] Length of the crank.
    pub crank: f64,
    /// [m] Length of the rod.
    pub rod: f64,
    /// [m] Height of the slider's pin, h − gy.
    pub height: f64,
}

/// Motion of rod and slider with the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IdealMotion<R = f64> {
    /// Rotation of the rod.
    pub rod: Rotation<R>,
    /// dφ/dθ: rod speed over crank speed, with φ the rod angle and θ the crank angle.
    pub rod_ratio: R,
    /// [rad/s²] Rod acceleration at constant crank speed.
    pub rod_bias: R,
    /// [m] Position of the pin along the guide.
    pub x: R,
    /// [m] dx/dθ.
    pub x_ratio: R,
    /// [m/s²] d²x/dt² at constant crank speed.
    pub x_bias: R,
    /// [rad/m] dφ/dL, with L the chord length of a flexible rod.
    pub rod_per_length: R,
}

impl IdealMechanism {
    /// The dimensions of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self { crank: scene.crank.length, rod: scene.rod.length, height: scene.guide.offset - scene.slider.centre.y }
    }

    /// Whether the crank can bring the rod perpendicular to the guide (change point), where the slider may continue on
    /// either side.
    pub fn has_change_point(&self) -> bool {
        self.crank + self.height.abs() > (1.0 - MIN_COSINE * MIN_COSINE) * self.rod
    }

    /// The event function of the change point, where the rod, of length `rod` [m] that grows at `rate` [m/s], is
    /// perpendicular to the guide: cos²φ less its smallest value, and its rate, both smooth there.
    pub fn change_point(&self, crank: Rotation, speed: f64, rod: f64, rate: f64) -> EventFunction {
        let sin = (self.height - crank.sin * self.crank) / rod;
        let sin_rate = -(crank.cos * self.crank * speed + sin * rate) / rod;
        EventFunction { value: (1.0 - sin) * (1.0 + sin) - MIN_COSINE * MIN_COSINE, rate: -2.0 * sin * sin_rate }
    }

    /// [s] How long a crank that turns at a constant `speed` [rad/s] from `angle` [rad] takes to where the rod stands
    /// across the guide; `None` if it never comes there.
    pub fn time_to_change_point(&self, angle: f64, speed: f64) -> Option<f64> {
        let limit = (1.0 - MIN_COSINE * MIN_COSINE).sqrt() * self.rod;
        let rise = self.height - math::sin_cos(angle).0 * self.crank;
        if rise.abs() >= limit || speed == 0.0 {
            return None;
        }
        // r·sin θ = height ∓ limit.
        let sines = [self.height - limit, self.height + limit].map(|rise| rise / self.crank);
        let sines = sines.into_iter().filter(|sine| sine.abs() <= 1.0);
        let angles = sines.flat_map(|sine| {
            let angle = math::atan2(sine, ((1.0 - sine) * (1.0 + sine)).sqrt());
            [angle, PI - angle]
        });
        let ahead = angles.map(|there| ((there - angle) * speed.signum()).rem_euclid(TAU));
        ahead.min_by(f64::total_cmp).map(|ahead| ahead / speed.abs())
    }

    /// [unit of the change point's event function] Scale of its tolerable error.
    pub const CHANGE_POINT_SCALE: f64 = MIN_COSINE * MIN_COSINE;

    /// The motion at the crank's rotation and speed [rad/s]; not finite where the mechanism cannot be assembled.
    #[inline(always)]
    pub fn motion<R: Real>(&self, crank: Rotation<R>, speed: R) -> IdealMotion<R> {
        let Self { crank: r, rod: l, height } = *self;
        let sin = (-(crank.sin * r) + height) / l;
        let cos = ((-sin + 1.0) * (sin + 1.0)).sqrt();
        // Derivatives of r·sin θ + l·sin φ = height.
        let per_reach = (cos * l).recip();
        let rod_ratio = crank.cos * -r * per_reach;
        let rod_speed = rod_ratio * speed;
        let rod_bias = (crank.sin * r * speed * speed + sin * l * rod_speed * rod_speed) * per_reach;
        IdealMotion {
            rod: Rotation { cos, sin },
            rod_ratio,
            rod_bias,
            x: crank.cos * r + cos * l,
            x_ratio: crank.sin * -r - sin * l * rod_ratio,
            x_bias: crank.cos * -r * speed * speed - (cos * rod_speed * rod_speed + sin * rod_bias) * l,
            rod_per_length: R::ZERO,
        }
    }

    /// The motion of a rod with a variable chord, at the crank's rotation and speed [rad/s]; the slider's fields are 0.
    /// The rod's speed is `rod_ratio` times the crank's plus `rod_per_length` times the chord's rate.
    #[inline(always)]
    pub fn flexible_motion<R: Real>(&self, crank: Rotation<R>, speed: R, chord: &Chord<R>) -> IdealMotion<R> {
        let Self { crank: r, height, .. } = *self;
        let Chord { length, rate, bias, .. } = *chord;
        let sin = (-(crank.sin * r) + height) / length;
        let cos = ((-sin + 1.0) * (sin + 1.0)).sqrt();
        // Derivatives of r·sin θ + L·sin φ = height.
        let per_reach = (cos * length).recip();
        let (rod_ratio, rod_per_length) = (crank.cos * -r * per_reach, -(sin * per_reach));
        let rod_speed = rod_ratio * speed + rod_per_length * rate;
        let centrifugal = crank.sin * r * speed * speed + sin * length * rod_speed * rod_speed;
        let rod_bias = (centrifugal - cos * rod_speed * rate * 2.0 - sin * bias) * per_reach;
        IdealMotion { rod: Rotation { cos, sin }, rod_ratio, rod_per_length, rod_bias, ..IdealMotion::default() }
    }
}
