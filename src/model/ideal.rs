//! The ideal slider-crank: rod and slider as functions of the crank's angle.

use super::plane::Rotation;
use super::rod::Chord;
use crate::integrator::EventFunction;
use crate::math::{self, Real};
use crate::scene::Scene;
use std::f64::consts::{PI, TAU};

/// Least cosine of the rod's angle. A rod that is longer than its crank by less than half a millionth does not pass it:
/// rounding and the errors of steps would decide on which side of standing across the guide it goes on.
const LEAST_COSINE: f64 = 1e-3;

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
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IdealMotion<R = f64> {
    /// Rotation of the rod.
    pub rod: Rotation<R>,
    /// dφ/dθ: rod speed over crank speed.
    pub rod_ratio: R,
    /// [rad/s²] Rod acceleration at a steady crank speed.
    pub rod_bias: R,
    /// [m] Pin along the guide.
    pub x: R,
    /// [m] dx/dθ.
    pub x_ratio: R,
    /// [m/s²] d²x/dt² at a steady crank speed.
    pub x_bias: R,
    /// [rad/m] dφ/dL, with the length L of a flexible rod's chord.
    pub rod_per_length: R,
}

impl IdealMechanism {
    /// Of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self { crank: scene.crank.length, rod: scene.rod.length, height: scene.guide.offset - scene.slider.centre.y }
    }

    /// The crank can bring the rod across the guide, where the slider may go on either way.
    pub fn has_change_point(&self) -> bool {
        self.crank + self.height.abs() > (1.0 - LEAST_COSINE * LEAST_COSINE) * self.rod
    }

    /// The event at which the rod, then `rod` [m] long and growing at `rate` [m/s], stands across the guide: cos²φ and
    /// its rate, which are smooth there.
    pub fn change_point(&self, crank: Rotation, speed: f64, rod: f64, rate: f64) -> EventFunction {
        let sin = (self.height - crank.sin * self.crank) / rod;
        let sin_rate = -(crank.cos * self.crank * speed + sin * rate) / rod;
        EventFunction { value: (1.0 - sin) * (1.0 + sin) - LEAST_COSINE * LEAST_COSINE, rate: -2.0 * sin * sin_rate }
    }

    /// [s] How long a crank that turns at a constant `speed` [rad/s] from `angle` [rad] takes to where the rod stands
    /// across the guide; `None` if it never comes there.
    pub fn time_to_change_point(&self, angle: f64, speed: f64) -> Option<f64> {
        let limit = (1.0 - LEAST_COSINE * LEAST_COSINE).sqrt() * self.rod;
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

    /// [unit of that event's value] What is just noticeable in it.
    pub const CHANGE_POINT_SCALE: f64 = LEAST_COSINE * LEAST_COSINE;

    /// At the crank's rotation and speed [rad/s]. Not finite where the mechanism cannot be.
    #[inline(always)]
    pub fn motion<R: Real>(&self, crank: Rotation<R>, speed: R) -> IdealMotion<R> {
        let Self { crank: r, rod: l, height } = *self;
        let sin = (-(crank.sin * r) + height) / l;
        let cos = ((-sin + 1.0) * (sin + 1.0)).sqrt();
        // r·sin θ + l·sin φ = height, once and twice differentiated.
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

    /// The rod at the crank's rotation and speed [rad/s], whose chord changes its length; nothing of the slider. Its speed
    /// is `rod_ratio` times the crank's and `rod_per_length` times the chord's rate.
    #[inline(always)]
    pub fn flexible_motion<R: Real>(&self, crank: Rotation<R>, speed: R, chord: &Chord<R>) -> IdealMotion<R> {
        let Self { crank: r, height, .. } = *self;
        let Chord { length, rate, bias, .. } = *chord;
        let sin = (-(crank.sin * r) + height) / length;
        let cos = ((-sin + 1.0) * (sin + 1.0)).sqrt();
        // r·sin θ + L·sin φ = height, once and twice differentiated.
        let per_reach = (cos * length).recip();
        let (rod_ratio, rod_per_length) = (crank.cos * -r * per_reach, -(sin * per_reach));
        let rod_speed = rod_ratio * speed + rod_per_length * rate;
        let centrifugal = crank.sin * r * speed * speed + sin * length * rod_speed * rod_speed;
        let rod_bias = (centrifugal - cos * rod_speed * rate * 2.0 - sin * bias) * per_reach;
        IdealMotion { rod: Rotation { cos, sin }, rod_ratio, rod_per_length, rod_bias, ..IdealMotion::default() }
    }
}
