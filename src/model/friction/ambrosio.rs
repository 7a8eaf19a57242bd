//! Ambrósio: Coulomb friction with a ramp, f_t/f_n = μ·sign(v)·clamp((|v| − v0)/(v1 − v0), 0, 1).
//!
//! J. A. C. Ambrósio, in Virtual Nonlinear Multibody Systems, Kluwer 2003.
//!
//! Limits: there is no force below v0, so that nothing sticks: a body at rest under a force creeps at a speed between
//! v0 and v1.

use super::law::{Law, FrictionResponse};
use crate::math::Real;
use crate::scene;

/// μ·sign(v)·clamp((|v| − v0)/(v1 − v0), 0, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambrosio {
    /// μ.
    kinetic: f64,
    /// [m/s] v0.
    v0: f64,
    /// [m/s] v1.
    v1: f64,
    /// [s/m] 1/(v1 − v0).
    per_width: f64,
}

impl Law for Ambrosio {
    fn new(friction: &scene::Friction) -> Self {
        let scene::Friction { coefficient, v0, v1, .. } = *friction;
        Self { kinetic: coefficient, v0, v1, per_width: 1.0 / (v1 - v0) }
    }

    #[inline(always)]
    fn response<R: Real>(&self, v: R, _: R) -> FrictionResponse<R> {
        let ramp = ((v.abs() - self.v0) * self.per_width).clamp(0.0, 1.0);
        FrictionResponse::without_bristles((ramp * self.kinetic).copysign(v))
    }

    fn corners(&self) -> [Option<f64>; 2] {
        [Some(self.v0).filter(|&v0| v0 > 0.0), Some(self.v1)]
    }
}
