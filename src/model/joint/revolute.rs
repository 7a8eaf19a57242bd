//! A revolute joint with clearance: a journal in a bearing.
//!
//! e is the vector from the bearing's centre P to the journal's centre (eccentricity), ε = |e|, n = e/ε, t = perp(n), δ
//! = ε − c the penetration. The contact force acts on both bodies at the point P + R_b·n. The velocity of the journal's
//! material relative to the bearing's there is v_t = ė·t + (R_b − ε)·ω_journal − R_b·ω_bearing: force times this
//! velocity is the dissipated power.

use crate::integrator::{Discontinuities, EventFunction};
use crate::math::Real;
use crate::model::contact::{ContactEnergy, ContactParameters, ContactState, Elastic, Forces};
use crate::model::friction::Friction;
use crate::model::plane::{Vec2, perp};
use crate::scene;

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

/// The contact's load on both bodies: a force on the journal at its centre, the opposite force on the bearing at its
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

/// A revolute joint with clearance.
#[derive(Clone, Copy, Debug)]
pub struct Revolute {
    /// [m] R_b: radius of the bearing.
    pub(super) radius: f64,
    /// [m] c: radial clearance.
    clearance: f64,
    /// Contact parameters.
    pub contact: ContactParameters,
}

impl Revolute {
    /// The joint of a scene.
    pub fn new(joint: &scene::Revolute) -> Self {
        let contact = ContactParameters::new(&joint.contact, Elastic::new(joint));
        Self { radius: joint.radius, clearance: joint.clearance, contact }
    }

    /// [m] Penetration δ; negative if open.
    #[inline(always)]
    pub fn penetration(&self, journal: &JournalMotion) -> f64 {
        journal.eccentricity.norm() - self.clearance
    }

    /// [m/s] Penetration rate δ̇; 0 if the journal is centred, where n is undefined.
    #[inline(always)]
    pub fn penetration_rate(&self, journal: &JournalMotion) -> f64 {
        let epsilon = journal.eccentricity.norm();
        if epsilon > 0.0 { journal.rate.dot(journal.eccentricity) / epsilon } else { 0.0 }
    }

    /// The event function of the contact: closing if it is open, opening if it is closed.
    #[inline(always)]
    pub fn event_function(&self, state: &ContactState, journal: &JournalMotion) -> EventFunction {
        event_function(state, self.penetration(journal), self.penetration_rate(journal))
    }

    /// Adds the functions whose zeros are derivative discontinuities of the closed contact's force.
    pub fn discontinuities(
        &self,
        state: &ContactState,
        journal: &JournalMotion,
        discontinuities: &mut Discontinuities,
    ) {
        let epsilon = journal.eccentricity.norm().max(f64::MIN_POSITIVE);
        let n = journal.eccentricity / epsilon;
        self.contact.discontinuities(
            state,
            journal.rate.dot(n),
            self.sliding(journal, epsilon, perp(n)),
            discontinuities,
        );
    }

    /// [m/s] Sliding velocity v_t at the eccentricity `epsilon` [m] and the tangent `t`.
    #[inline(always)]
    pub(super) fn sliding<R: Real>(&self, journal: &JournalMotion<R>, epsilon: R, t: Vec2<R>) -> R {
        let journal_part = (-epsilon + self.radius).multiply_add(journal.journal_speed, journal.rate.dot(t));
        (-journal.bearing_speed).multiply_add(self.radius, journal_part)
    }

    /// Energy and powers of the closed contact at the bristle deflection `z` [m].
    pub fn contact_energy<R: Real>(&self, state: &ContactState, journal: &JournalMotion<R>, z: R) -> ContactEnergy<R> {
        let Some((epsilon, n)) = journal.distance_and_normal() else {
            return ContactEnergy::default();
        };
        let sliding = self.sliding(journal, epsilon, perp(n));
        let (depth, rate) = (epsilon - self.clearance, journal.rate.dot(n));
        self.contact.contact_energy(state.per_approach, depth, rate, z, sliding)
    }

    /// The load of the closed contact at the bristle deflection `z` [m].
    #[inline(always)]
    pub fn load<R: Real>(&self, state: &ContactState, journal: &JournalMotion<R>, z: R) -> Load<R> {
        let Some((epsilon, n)) = journal.distance_and_normal() else {
            return Load::default();
        };
        let contact = &self.contact;
        let (depth, rate) = (epsilon - self.clearance, journal.rate.dot(n));
        let t = perp(n);
        let Forces { normal, tangential, bristle_rate } =
            contact.forces(state.per_approach, depth, rate, z, || self.sliding(journal, epsilon, t));
        if contact.friction == Friction::None {
            return Load { force: -normal * n, ..Load::default() };
        }
        Load {
            force: n.multiply_add(-normal, -tangential * t),
            journal_couple: (epsilon - self.radius) * tangential,
            bearing_couple: tangential * self.radius,
            bristle_rate,
        }
    }
}

/// The event function of a contact: −δ if it is open, δ if it is closed.
#[inline(always)]
pub fn event_function(state: &ContactState, depth: f64, rate: f64) -> EventFunction {
    if state.closed { EventFunction { value: depth, rate } } else { EventFunction { value: -depth, rate: -rate } }
}
