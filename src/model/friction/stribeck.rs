//! Stribeck: a coefficient that decreases with the sliding speed, μ(v) = μ_k + (μ_s − μ_k)·exp(−(v/v_s)²), smoothed:
//! f_t/f_n = μ(v)·tanh(v/v1).
//!
//! R. Stribeck, Z. VDI 46 (1902) 1341; the exponential form as in B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit,
//! Automatica 30 (1994) 1083.
//!
//! Limits: nothing sticks: a body at rest under a force creeps. If v1 is near v_s, the peak stays below μ_s.

use super::law::{Law, FrictionResponse};
use crate::math::{self, Real};
use crate::scene;

/// f_t/f_n = μ(v)·tanh(v/v1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck {
    coefficient: StribeckCurve,
    /// [s/m] 1/v1.
    per_width: f64,
}

/// The Stribeck curve: a coefficient between μ_s at rest and μ_k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StribeckCurve {
    /// Kinetic coefficient μ_k.
    kinetic: f64,
    /// Static coefficient μ_s.
    pub still: f64,
    /// [s/m] 1/v_s.
    per_stribeck: f64,
}

impl StribeckCurve {
    /// The curve with the parameters of the scene.
    pub fn new(friction: &scene::Friction) -> Self {
        Self {
            kinetic: friction.coefficient,
            still: friction.static_coefficient,
            per_stribeck: 1.0 / friction.v_stribeck,
        }
    }

    /// exp(−(v/v_s)²) at the sliding speed `v` [m/s].
    #[inline(always)]
    pub fn fading<R: Real>(&self, v: R) -> R {
        let share = v * self.per_stribeck;
        math::exp(-share * share)
    }

    /// μ_k + (μ_s − μ_k)·`fading`, with `fading` from [`fading`](Self::fading).
    #[inline(always)]
    pub fn at<R: Real>(&self, fading: R) -> R {
        fading * (self.still - self.kinetic) + self.kinetic
    }
}

impl Law for Stribeck {
    fn new(friction: &scene::Friction) -> Self {
        Self { coefficient: StribeckCurve::new(friction), per_width: 1.0 / friction.v1 }
    }

    fn response<R: Real>(&self, v: R, _: R) -> FrictionResponse<R> {
        let coefficient = self.coefficient.at(self.coefficient.fading(v));
        FrictionResponse::without_bristles(coefficient * math::tanh(v * self.per_width))
    }
}
