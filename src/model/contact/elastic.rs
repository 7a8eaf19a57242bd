//! Elastic force as a function of penetration.

use super::ContactParameters;
use crate::math::{self, Real};

/// F(δ), δ > 0.
pub trait Elastic {
    /// [N] at the penetration `depth` [m].
    fn force<R: Real>(parameters: &ContactParameters, depth: R) -> R;
    /// [J] ∫F dδ from 0 to `depth` [m].
    fn energy<R: Real>(parameters: &ContactParameters, depth: R) -> R;
}

/// K·δ^(3/2): Hertz's exponent without a power function.
pub struct HertzThreeHalves;

/// K·δ^p for any p.
pub struct Power;

/// K·δ: a bed of springs of the stiffness K, pressed in by δ on average.
pub struct Linear;

/// Conformal cylinders: F = (π/2)·E*·L·δ·√(δ/(2(c + δ))); C. Liu, K. Zhang, R. Yang, The FEM
/// analysis and approximate model for cylindrical joints with clearances, Mech. Mach. Theory 42
/// (2007) 183-197.
pub struct Liu;

impl Elastic for HertzThreeHalves {
    #[inline(always)]
    fn force<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        depth * parameters.stiffness * depth.sqrt()
    }
    fn energy<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        depth * 0.4 * Self::force(parameters, depth)
    }
}

impl Elastic for Power {
    #[inline(always)]
    fn force<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        math::powf(depth, parameters.exponent) * parameters.stiffness
    }
    fn energy<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        depth * Self::force(parameters, depth) / (parameters.exponent + 1.0)
    }
}

impl Elastic for Linear {
    #[inline(always)]
    fn force<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        depth * parameters.stiffness
    }
    fn energy<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        depth * 0.5 * Self::force(parameters, depth)
    }
}

impl Elastic for Liu {
    #[inline(always)]
    fn force<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        depth * parameters.stiffness * (depth / ((depth + parameters.clearance) * 2.0)).sqrt()
    }
    /// With u = δ/c: K·c²/√2·∫u^(3/2)/√(1 + u) du; a series where the closed form is a small difference.
    fn energy<R: Real>(parameters: &ContactParameters, depth: R) -> R {
        let c = parameters.clearance;
        let u = depth / c;
        let series = || {
            // Coefficients of (1 + u)^(−1/2), each divided by its power + 5/2.
            let mut coefficient = R::ONE;
            let mut sum = R::ZERO;
            for k in 0..20 {
                let k = f64::from(k);
                sum += coefficient / (k + 2.5);
                coefficient = coefficient * (-u * (k + 0.5) / (k + 1.0));
            }
            sum * u * u * u.sqrt()
        };
        let closed_form = || (u * (u + 1.0)).sqrt() * 0.25 * (u * 2.0 - 3.0) + math::asinh(u.sqrt()) * 0.75;
        let integral = (-u + 0.1).choose(series, closed_form);
        integral * (parameters.stiffness * c * c * std::f64::consts::FRAC_1_SQRT_2)
    }
}
