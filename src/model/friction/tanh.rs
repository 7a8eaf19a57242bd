//! Coulomb friction smoothed by a hyperbolic tangent: f_t/f_n = μ·tanh(v/v1).
//!
//! Limits: nothing sticks: a body at rest under a force creeps.

use super::law::{Law, FrictionResponse};
use crate::math::{self, Real};
use crate::scene;

/// f_t/f_n = μ·tanh(v/v1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tanh {
    /// μ.
    kinetic: f64,
    /// [s/m] 1/v1.
    per_width: f64,
}

impl Law for Tanh {
    fn new(friction: &scene::Friction) -> Self {
        Self { kinetic: friction.coefficient, per_width: 1.0 / friction.v1 }
    }

    fn response<R: Real>(&self, v: R, _: R) -> FrictionResponse<R> {
        FrictionResponse::without_bristles(math::tanh(v * self.per_width) * self.kinetic)
    }
}
