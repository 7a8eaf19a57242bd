//! Elastic force as a function of penetration.

use super::ContactParameters;
use crate::math;

/// F(δ), δ > 0.
pub trait Elastic {
    /// [N] at the penetration `depth` [m].
    fn force(parameters: &ContactParameters, depth: f64) -> f64;
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
    fn force(parameters: &ContactParameters, depth: f64) -> f64 {
        parameters.stiffness * depth * depth.sqrt()
    }
}

impl Elastic for Power {
    #[inline(always)]
    fn force(parameters: &ContactParameters, depth: f64) -> f64 {
        parameters.stiffness * math::powf(depth, parameters.exponent)
    }
}

impl Elastic for Linear {
    #[inline(always)]
    fn force(parameters: &ContactParameters, depth: f64) -> f64 {
        parameters.stiffness * depth
    }
}

impl Elastic for Liu {
    #[inline(always)]
    fn force(parameters: &ContactParameters, depth: f64) -> f64 {
        parameters.stiffness * depth * (depth / (2.0 * (parameters.clearance + depth))).sqrt()
    }
}
