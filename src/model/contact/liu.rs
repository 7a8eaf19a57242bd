//! Liu: conformal cylinders, F = K·δ·√(δ/(2(c + δ))), K = (π/2)·E*·L, E* = 1/(σ_b + σ_j), σ = (1 − ν²)/E.
//!
//! C. Liu, K. Zhang, R. Yang, The FEM analysis and approximate model for cylindrical joints with clearances, Mech.
//! Mach. Theory 42 (2007) 183. L is the axial length, `joint.J.width`; `joint.J.stiffness` and `joint.J.exponent` are
//! not used.
//!
//! Limits: K/√(2c)·δ^(3/2) for δ ≪ c, and K·δ/√2 for δ ≫ c. Fitted to cylinders of equal materials.

use super::compliance::compliance;
use super::elastic_law::{ElasticLaw, PowerLaw};
use crate::math::{self, Real};
use crate::scene::Revolute;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// K·δ·√(δ/(2(c + δ))).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Liu {
    /// [N/m] K.
    stiffness: f64,
    /// [m] c.
    clearance: f64,
}

impl ElasticLaw for Liu {
    fn new(joint: &Revolute) -> Self {
        let contact = &joint.contact;
        Self { stiffness: FRAC_PI_2 / compliance(contact) * contact.width, clearance: joint.clearance }
    }

    #[inline(always)]
    fn force<R: Real>(&self, depth: R) -> R {
        depth * self.stiffness * (depth / ((depth + self.clearance) * 2.0)).sqrt()
    }

    /// K·c²/√2·∫u^(3/2)/√(1 + u) du with u = δ/c; a series for small u, where the closed form is a small difference of
    /// large numbers.
    fn energy<R: Real>(&self, depth: R) -> R {
        let c = self.clearance;
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
        integral * (self.stiffness * c * c * FRAC_1_SQRT_2)
    }

    fn for_small_penetrations(&self) -> PowerLaw {
        PowerLaw { stiffness: self.stiffness / (2.0 * self.clearance).sqrt(), exponent: 1.5 }
    }
}
