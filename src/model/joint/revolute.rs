//! A revolute joint with clearance: a journal in a bearing.
//!
//! e is the vector from the bearing's centre P to the journal's centre (eccentricity), ε = |e|, n = e/ε, t = perp(n), δ
//! = ε − c the penetration (with an oil film ε − c + 3σ, see [`film`](super::film)). The contact force acts on both bodies at the point P + R_b·n. The velocity of the journal's
//! material relative to the bearing's there is v_t = ė·t + (R_b − ε)·ω_journal − R_b·ω_bearing: force times this
//! velocity is the dissipated power.

use super::film::Film;
pub use super::journal::{JournalMotion, Load};
use crate::integrator::{Discontinuities, EventFunction};
use crate::math::Real;
use crate::model::contact::{ContactEnergy, ContactParameters, ContactState, Elastic, Forces, Rubbing};
use crate::model::friction::Friction;
use crate::model::plane::{Vec2, perp};
use crate::scene;

/// A revolute joint with clearance.
#[derive(Clone, Copy, Debug)]
pub struct Revolute {
    /// [m] R_b: radius of the bearing.
    pub(super) radius: f64,
    /// [m] Eccentricity at which journal and bearing touch: the clearance c of a dry joint.
    free: f64,
    /// Contact parameters.
    pub contact: ContactParameters,
}

impl Revolute {
    /// The joint of a scene.
    pub fn new(joint: &scene::Revolute) -> Self {
        let contact = ContactParameters::new(&joint.contact, Elastic::new(joint));
        Self { radius: joint.radius, free: Film::free_eccentricity(joint), contact }
    }

    /// [m] Penetration δ; negative if open.
    #[inline(always)]
    pub fn penetration<R: Real>(&self, journal: &JournalMotion<R>) -> R {
        journal.eccentricity.norm() - self.free
    }

    /// [m/s] Penetration rate δ̇; 0 if the journal is centred, where n is undefined.
    #[inline(always)]
    pub fn penetration_rate<R: Real>(&self, journal: &JournalMotion<R>) -> R {
        let epsilon = journal.eccentricity.norm();
        if epsilon > 0.0 { journal.rate.dot(journal.eccentricity) / epsilon } else { R::ZERO }
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
        let (depth, rate) = (epsilon - self.free, journal.rate.dot(n));
        self.contact.contact_energy(state.per_approach, depth, rate, z, sliding)
    }

    /// Sliding and forces of the closed contact at the bristle deflection `z` [m].
    pub fn rubbing(&self, state: &ContactState, journal: &JournalMotion, z: f64) -> Rubbing {
        let Some((epsilon, n)) = journal.distance_and_normal() else {
            return Rubbing::default();
        };
        let speed = self.sliding(journal, epsilon, perp(n));
        self.contact.rubbing(state.per_approach, epsilon - self.free, journal.rate.dot(n), z, speed)
    }

    /// The load of the closed contact at the bristle deflection `z` [m].
    #[inline(always)]
    pub fn load<R: Real>(&self, state: &ContactState, journal: &JournalMotion<R>, z: R) -> Load<R> {
        let Some((epsilon, n)) = journal.distance_and_normal() else {
            return Load::default();
        };
        let contact = &self.contact;
        let (depth, rate) = (epsilon - self.free, journal.rate.dot(n));
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
