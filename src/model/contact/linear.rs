//! Linear: F = K·δ, a bed of springs of the stiffness K at the mean penetration δ.
//!
//! E. Winkler, Die Lehre von der Elastizität und Festigkeit, Prag 1867. The slider's faces are such beds; the law
//! cannot be selected for a revolute joint.

use super::elastic_law::PowerLaw;
use crate::math::Real;

/// K·δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// [N/m] K.
    pub stiffness: f64,
}

impl Linear {
    /// [N] F at the mean penetration `depth` [m].
    #[inline(always)]
    pub fn force<R: Real>(&self, depth: R) -> R {
        depth * self.stiffness
    }

    /// [J] ½·K·δ² of a bed with uniform penetration `depth` [m].
    pub fn energy<R: Real>(&self, depth: R) -> R {
        depth * 0.5 * self.force(depth)
    }

    /// This law as a power law.
    pub fn for_small_penetrations(&self) -> PowerLaw {
        PowerLaw { stiffness: self.stiffness, exponent: 1.0 }
    }
}
