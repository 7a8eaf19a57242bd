//! LuGre: f_t/f_n = σ0·z + σ1·exp(−(v/v_s)²)·ż + σ2·v with ż = v − σ0·|v|·z/g(v), g(v) = μ_k + (μ_s −
//! μ_k)·exp(−(v/v_s)²).
//!
//! C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, IEEE Trans. Autom. Control 40 (1995) 419, with a damping
//! that decays with the sliding speed, so that a fast first touch causes no spurious impulse. z, the mean deflection of
//! bristles between the surfaces, is a state that is reset when the contact opens.
//!
//! Limits: needs 0 < μ_k ≤ μ_s. The law is stiff for large σ0: bristles at rest slip at z = μ_s/σ0.

use super::law::{Law, FrictionResponse};
use super::stribeck::StribeckCurve;
use crate::math::Real;
use crate::scene;

/// f_t/f_n = σ0·z + σ1·exp(−(v/v_s)²)·ż + σ2·v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lugre {
    steady: StribeckCurve,
    /// [1/m] σ0.
    sigma0: f64,
    /// [s/m] σ1.
    sigma1: f64,
    /// [s/m] σ2.
    sigma2: f64,
}

impl Law for Lugre {
    fn new(friction: &scene::Friction) -> Self {
        let scene::Friction { sigma0, sigma1, sigma2, .. } = *friction;
        Self { steady: StribeckCurve::new(friction), sigma0, sigma1, sigma2 }
    }

    fn response<R: Real>(&self, v: R, z: R) -> FrictionResponse<R> {
        let fading = self.steady.fading(v);
        let rate = v - v.abs() * self.sigma0 * z / self.steady.at(fading);
        FrictionResponse { ratio: z * self.sigma0 + fading * self.sigma1 * rate + v * self.sigma2, bristle_rate: rate }
    }

    fn max_deflection(&self) -> Option<f64> {
        Some(self.steady.still / self.sigma0)
    }
}
