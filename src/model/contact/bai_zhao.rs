//! Bai and Zhao: an elastic foundation beneath conformal cylinders, F = L·K_n(δ)·δ, K_n = (π/8)·E*·√(2δ·(3c + 2δ)²/(c +
//! δ)³), E* = 1/(σ_b + σ_j), σ = (1 − ν²)/E.
//!
//! Z. F. Bai, Y. Zhao, A hybrid contact force model of revolute joint with clearance for planar mechanical systems,
//! Int. J. Mech. Sci. 54 (2012) 190. K_n is the slope of the force per length of [`Liu`], so that F = F_liu·(3c +
//! 2δ)/(2(c + δ)). The paper prints K_n·δ^(3/2), which is not a force in SI units: its value depends on the unit of
//! length. The exponent must be 1. L is the axial length, `joint.J.width`; `joint.J.stiffness` and `joint.J.exponent`
//! are not used. The authors' damping is `zhiying_qishao` with `joint.J.ratio_limit` at or below 0; any other damping
//! law may be combined with this one.
//!
//! Limits: 3/2 of Liu's force for δ ≪ c, and Liu's force for δ ≫ c.

use super::elastic_law::{ElasticLaw, PowerLaw};
use super::liu::Liu;
use crate::math::Real;
use crate::scene::Revolute;

/// F_liu·(3c + 2δ)/(2(c + δ)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaiZhao {
    liu: Liu,
    /// [m] c.
    clearance: f64,
}

impl ElasticLaw for BaiZhao {
    fn new(joint: &Revolute) -> Self {
        Self { liu: Liu::new(joint), clearance: joint.clearance }
    }

    fn force<R: Real>(&self, depth: R) -> R {
        let c = self.clearance;
        self.liu.force(depth) * (depth * 2.0 + 3.0 * c) / ((depth + c) * 2.0)
    }

    /// ∫δ dF_liu = δ·F_liu − ∫F_liu dδ.
    fn energy<R: Real>(&self, depth: R) -> R {
        depth * self.liu.force(depth) - self.liu.energy(depth)
    }

    fn for_small_penetrations(&self) -> PowerLaw {
        let PowerLaw { stiffness, exponent } = self.liu.for_small_penetrations();
        PowerLaw { stiffness: exponent * stiffness, exponent }
    }
}
