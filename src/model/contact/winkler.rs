//! Winkler: an elastic layer on the bearing beneath a rigid journal, a bushing. The layer's pressure is k_w·u, its
//! compression u = (c + δ)·cos φ − c over |φ| < β, cos β = c/(c + δ).
//!
//! ```text
//!             F                 F = k_w·R_b·L·[(c + δ)·β − c·sin β]
//!             |
//!       \     v     /        ∫F dδ = ½·k_w·R_b·L·[((c + δ)² + 2c²)·β − 3c·(c + δ)·sin β]
//!     ___\_______ /___
//!         \ β|β  /             layer of thickness h, k_w = (1 − ν)·E/((1 + ν)·(1 − 2ν)·h)
//!      ====`-._.-'====         with the bearing's E and ν, unless a stiffness is given
//! ```
//!
//! P. Põdra, S. Andersson, Wear simulation with the Winkler surface model, Wear 207 (1997) 79; for joints with clearance S.
//! Mukras, N. H. Kim, N. A. Mauntler, T. L. Schmitz, W. G. Sawyer, J. Tribol. 132 (2010) 031604. k_w is that of a thin
//! layer whose strain along the surface is suppressed. L is the axial length, `joint.J.width`; `joint.J.stiffness`,
//! `joint.J.exponent` and the journal's modulus are not used. Friction acts at the middle of the contact.
//!
//! Limits: (4√2/3)·k_w·R_b·L·δ^(3/2)/√c for δ ≪ c, and k_w·R_b·L·(π/2·(c + δ) − 2c) for δ ≫ c. The layer is thin
//! compared with the radius, and its thickness is hard to know.

use super::elastic_law::{ElasticLaw, PowerLaw};
use crate::math::{self, Real};
use crate::scene::Revolute;
use std::f64::consts::SQRT_2;

/// Below this half angle [rad] of the contact, β − sin β is computed as a series.
const SMALL_ANGLE: f64 = 0.7;
/// Below this half angle [rad] of the contact, the energy is computed as a series.
const SMALL_ANGLE_OF_ENERGY: f64 = 0.5;
/// Number of terms of β − sin β.
const SINE_TERMS: u32 = 8;
/// Coefficients of tan β from β⁵ on.
const TANGENT: [f64; 9] = [
    2.0 / 15.0,
    17.0 / 315.0,
    62.0 / 2_835.0,
    1_382.0 / 155_925.0,
    21_844.0 / 6_081_075.0,
    929_569.0 / 638_512_875.0,
    6_404_582.0 / 10_854_718_875.0,
    443_861_162.0 / 1_856_156_927_625.0,
    18_888_466_084.0 / 194_896_477_400_625.0,
];
/// Number of further coefficients, which are 4/π² of the one before to the last digit that counts.
const FURTHER_TERMS: u32 = 10;
const RATIO: f64 = 0.405_284_734_569_351_1;

/// k_w·R_b·L·[(c + δ)·β − c·sin β].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winkler {
    /// [N/m] k_w·R_b·L.
    stiffness: f64,
    /// [m] c.
    clearance: f64,
}

impl Winkler {
    /// x = δ/c and β.
    #[inline(always)]
    fn half_angle<R: Real>(&self, depth: R) -> (R, R) {
        let x = depth / self.clearance;
        // acos(1/(1 + x)) loses digits as x goes to 0.
        (x, math::atan2((x * (x + 2.0)).sqrt(), R::ONE))
    }
}

impl ElasticLaw for Winkler {
    fn new(joint: &Revolute) -> Self {
        let (layer, contact) = (joint.layer, &joint.contact);
        let (young, poisson) = (contact.young.bearing, contact.poisson.bearing);
        let per_area = if layer.stiffness > 0.0 {
            layer.stiffness
        } else {
            (1.0 - poisson) * young / ((1.0 + poisson) * (1.0 - 2.0 * poisson) * layer.thickness)
        };
        Self { stiffness: per_area * joint.radius * contact.width, clearance: joint.clearance }
    }

    /// k_w·R_b·L·c·[x·β + (β − sin β)].
    fn force<R: Real>(&self, depth: R) -> R {
        let (x, beta) = self.half_angle(depth);
        let series = || {
            let square = beta * beta;
            let mut sum = R::ONE;
            for k in (1..SINE_TERMS).rev() {
                let n = f64::from(2 * k);
                sum = -(sum * square) / ((n + 2.0) * (n + 3.0)) + 1.0;
            }
            sum * square * beta / 6.0
        };
        let closed_form = || beta - (x * (x + 2.0)).sqrt() / (x + 1.0);
        let segment = (-beta + SMALL_ANGLE).choose(series, closed_form);
        (x * beta + segment) * (self.stiffness * self.clearance)
    }

    /// With c + δ = c/cos β, ½·[(1/cos²β + 2)·β − 3·tan β]·c², of which the series of tan β leaves Σ t_n·(n − 1)·β^(2n+1)
    /// from n = 2 on.
    fn energy<R: Real>(&self, depth: R) -> R {
        let (x, beta) = self.half_angle(depth);
        let series = || {
            let square = beta * beta;
            let (mut power, mut sum, mut coefficient) = (square * square * beta, R::ZERO, 0.0);
            for n in 0..TANGENT.len() as u32 + FURTHER_TERMS {
                coefficient = TANGENT.get(n as usize).copied().unwrap_or(coefficient * RATIO);
                sum += power * (coefficient * f64::from(n + 1));
                power = power * square;
            }
            sum
        };
        let closed_form = || {
            let secant = x + 1.0;
            ((secant * secant + 2.0) * beta - (x * (x + 2.0)).sqrt() * 3.0) * 0.5
        };
        let integral = (-beta + SMALL_ANGLE_OF_ENERGY).choose(series, closed_form);
        integral * (self.stiffness * self.clearance * self.clearance)
    }

    fn for_small_penetrations(&self) -> PowerLaw {
        PowerLaw { stiffness: 4.0 / 3.0 * SQRT_2 * self.stiffness / self.clearance.sqrt(), exponent: 1.5 }
    }
}
