//! A journal in its bearing: its motion, and the load that acts between the two.

use crate::math::Real;
use crate::model::plane::Vec2;

/// Motion of a journal relative to its bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JournalMotion<R = f64> {
    /// [m] Eccentricity e.
    pub eccentricity: Vec2<R>,
    /// [m/s] Rate ė of the eccentricity.
    pub rate: Vec2<R>,
    /// [rad/s] Angular velocity of the journal's body.
    pub journal_speed: R,
    /// [rad/s] Angular velocity of the bearing's body.
    pub bearing_speed: R,
}

impl<R: Real> JournalMotion<R> {
    /// ε [m] and n; `None` if the journal is centred, where n is undefined.
    #[inline(always)]
    pub(super) fn distance_and_normal(&self) -> Option<(R, Vec2<R>)> {
        let mut square = self.eccentricity.norm_squared();
        if R::MANY {
            // A centred journal is treated as one with a tiny eccentricity.
            square = square.max(f64::MIN_POSITIVE);
        } else if square < f64::MIN_POSITIVE {
            return None;
        }
        // The root and the reciprocal are computed independently of each other.
        let epsilon = square.sqrt();
        Some((epsilon, (epsilon * square.recip()) * self.eccentricity))
    }
}

/// The load of a contact or an oil film on both bodies: a force on the journal at its centre, the opposite force on the bearing at its
/// centre, and a couple on each body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R = f64> {
    /// [N] Force on the journal's body.
    pub force: Vec2<R>,
    /// [N·m] Couple on the journal's body, about the journal's centre.
    pub journal_couple: R,
    /// [N·m] Couple on the bearing's body, about the bearing's centre.
    pub bearing_couple: R,
    /// [m/s] Rate of the bristle deflection.
    pub bristle_rate: R,
}
