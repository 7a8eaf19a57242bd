//! Hertz: F = K·δ^p, with p = 3/2 unless the scene gives another exponent.
//!
//! H. Hertz, J. reine angew. Math. 92 (1882) 156. In a revolute joint, as used by H. M. Lankarani, P. E. Nikravesh, J.
//! Mech. Des. 112 (1990) 369: K = 4/(3(σ_b + σ_j))·√(R_b·R_j/(R_b − R_j)), R_j = R_b − c, σ = (1 − ν²)/E. A corner of
//! the slider on the guide is a sphere on a plane: K = 4/(3(σ_b + σ_j))·√R_c.
//!
//! Limits: the contact must be small compared with both radii, and the axial length does not enter. In a tight joint, c
//! ≪ R_b, a conformal law is valid for larger penetrations.

use super::compliance::compliance;
use super::elastic_law::{ElasticLaw, PowerLaw};
use crate::math::{self, Real};
use crate::scene::{Contact, Guide, Revolute};

/// K·δ^p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz(PowerLaw);

impl Hertz {
    /// The contact of a corner of the slider.
    pub fn corner(joint: &Guide) -> Self {
        Self::with_curvature(&joint.contact, joint.corner_radius)
    }

    /// The contact of a sphere of radius `curvature` [m] with a plane.
    fn with_curvature(contact: &Contact, curvature: f64) -> Self {
        let given = contact.stiffness;
        let stiffness = if given > 0.0 { given } else { 4.0 / (3.0 * compliance(contact)) * curvature.sqrt() };
        Self(PowerLaw { stiffness, exponent: contact.exponent })
    }
}

impl ElasticLaw for Hertz {
    fn new(joint: &Revolute) -> Self {
        let (bearing, clearance) = (joint.radius, joint.clearance);
        Self::with_curvature(&joint.contact, bearing * (bearing - clearance) / clearance)
    }

    #[inline(always)]
    fn force<R: Real>(&self, depth: R) -> R {
        let PowerLaw { stiffness, exponent } = self.0;
        // The usual exponent needs no power function.
        if exponent == 1.5 { depth * stiffness * depth.sqrt() } else { power(depth, exponent) * stiffness }
    }

    fn energy<R: Real>(&self, depth: R) -> R {
        depth * self.force(depth) / (self.0.exponent + 1.0)
    }

    fn for_small_penetrations(&self) -> PowerLaw {
        self.0
    }
}

#[cold]
#[inline(never)]
fn power<R: Real>(depth: R, exponent: f64) -> R {
    math::powf(depth, exponent)
}
