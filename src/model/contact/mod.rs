//! Normal contact: f_n = max(0, F(δ)·(1 + χ·s)), s = min(δ̇/δ̇⁻, s_max).
//!
//! F is an [`Elastic`] law, one a file; χ is a number that the damping law makes of the restitution
//! ([`damping::factor`]). Which laws they are is data and looked up where the force is computed.

// Defines `elasticities!`, which hands the list of the declared elasticities to another macro.
include!(concat!(env!("OUT_DIR"), "/elasticities.rs"));

pub mod compliance;
pub mod damping;
mod elastic;
mod elastic_law;
mod linear;

/// The file of each declared elasticity.
macro_rules! files {
    ($($law:ident in $file:ident,)+) => { $(mod $file; pub use $file::$law;)+ };
}
elasticities!(files);

pub use elastic::Elastic;
pub use elastic_law::{ElasticLaw, PowerLaw};
pub use linear::Linear;

use super::friction::{Friction, FrictionResponse};
use crate::integrator::Discontinuities;
use crate::math::{self, Real};
use crate::scene;

/// Numbers of one contact, ready for the inner loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactParameters {
    /// F.
    pub elastic: Elastic,
    /// χ.
    pub damping: f64,
    /// s_max.
    pub ratio_limit: f64,
    /// [m/s] v_floor.
    pub speed_floor: f64,
    /// Friction.
    pub friction: Friction,
}

/// The memory of one contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
    /// Closed: δ has risen through zero and not fallen since.
    pub closed: bool,
    /// [m/s] δ̇⁻, while closed.
    pub approach: f64,
    /// [s/m] 1/δ̇⁻.
    pub per_approach: f64,
}

impl ContactState {
    /// A contact that closes at the approach speed `rate` [m/s].
    pub fn closing(rate: f64, speed_floor: f64) -> Self {
        let approach = rate.max(speed_floor);
        Self { closed: true, approach, per_approach: 1.0 / approach }
    }
}

/// Forces in a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces<R = f64> {
    /// [N] f_n.
    pub normal: R,
    /// [N] f_t.
    pub tangential: R,
    /// [m/s] Rate of the bristles' deflection.
    pub bristle_rate: R,
}

/// What a contact does to energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactEnergy<R = f64> {
    /// [J] Elastic energy.
    pub energy: R,
    /// [W] That normal forces take, f_n·δ̇: the rate of `energy` and what hysteresis loses.
    pub normal_power: R,
    /// [W] That friction takes, bristles included.
    pub friction_loss: R,
}

impl<R: Real> std::ops::AddAssign for ContactEnergy<R> {
    fn add_assign(&mut self, other: Self) {
        self.energy += other.energy;
        self.normal_power += other.normal_power;
        self.friction_loss += other.friction_loss;
    }
}

impl ContactParameters {
    /// Of a contact with this elastic law.
    pub fn new(contact: &scene::Contact, elastic: Elastic) -> Self {
        let limit = contact.ratio_limit;
        Self {
            elastic,
            damping: damping::factor(contact.law, contact.restitution),
            ratio_limit: if limit > 0.0 { limit } else { f64::INFINITY },
            speed_floor: contact.speed_floor,
            friction: Friction::new(&contact.friction),
        }
    }

    /// [N] f_n at the penetration `depth` [m] and its `rate` [m/s]; 0 where it would pull: no adhesion.
    #[inline(always)]
    fn normal_force<R: Real>(&self, per_approach: f64, depth: R, rate: R) -> R {
        if !R::MANY && depth <= 0.0 {
            return R::ZERO;
        }
        let ratio = (rate * per_approach).min(self.ratio_limit);
        (self.elastic.force(depth.max(0.0)) * ratio.multiply_add(self.damping, R::ONE)).max(0.0)
    }

    /// Forces at the penetration `depth` [m], its `rate` [m/s], the bristles' deflection `z` [m] and the sliding speed
    /// that `sliding` gives [m/s]. Numbers with derivatives fit no registers: these are better off behind a call.
    #[inline(always)]
    pub fn forces<R: Real>(
        &self,
        per_approach: f64,
        depth: R,
        rate: R,
        z: R,
        sliding: impl FnOnce() -> R,
    ) -> Forces<R> {
        if R::PLAIN || R::MANY {
            self.forces_in_line(per_approach, depth, rate, z, sliding)
        } else {
            self.forces_by_call(per_approach, depth, rate, z, sliding())
        }
    }

    #[inline(never)]
    fn forces_by_call<R: Real>(&self, per_approach: f64, depth: R, rate: R, z: R, sliding: R) -> Forces<R> {
        self.forces_in_line(per_approach, depth, rate, z, || sliding)
    }

    #[inline(always)]
    fn forces_in_line<R: Real>(
        &self,
        per_approach: f64,
        depth: R,
        rate: R,
        z: R,
        sliding: impl FnOnce() -> R,
    ) -> Forces<R> {
        let normal = self.normal_force(per_approach, depth, rate);
        if self.friction == Friction::None {
            return Forces { normal, ..Forces::default() };
        }
        let FrictionResponse { ratio, bristle_rate } = self.friction.response(sliding(), z);
        Forces { normal, tangential: normal * ratio, bristle_rate }
    }

    /// The account of the [`forces`](Self::forces) of the same arguments: what the bodies lose to it is f_n·δ̇ + f_t·v_t.
    pub fn contact_energy<R: Real>(&self, per_approach: f64, depth: R, rate: R, z: R, sliding: R) -> ContactEnergy<R> {
        let Forces { normal, tangential, .. } = self.forces(per_approach, depth, rate, z, || sliding);
        ContactEnergy {
            energy: self.elastic.energy(depth.max(0.0)),
            normal_power: normal * rate,
            friction_loss: tangential * sliding,
        }
    }

    /// Adds the discontinuities of the force in the closed contact of memory `state`, whose penetration grows at `rate` [m/s] and
    /// whose surfaces slide at `sliding` [m/s]: where s reaches its limit, where the force is cut off at 0, where the
    /// friction law has corners.
    pub fn discontinuities(
        &self,
        state: &ContactState,
        rate: f64,
        sliding: f64,
        discontinuities: &mut Discontinuities,
    ) {
        if self.damping > 0.0 {
            discontinuities.push(rate + state.approach / self.damping);
            if self.ratio_limit.is_finite() {
                discontinuities.push(rate - state.approach * self.ratio_limit);
            }
        }
        for corner in self.friction.corners().into_iter().flatten() {
            discontinuities.push(sliding - corner);
            discontinuities.push(sliding + corner);
        }
    }

    /// [s] How long a free impact of `mass` [kg] at `speed` [m/s] lasts: 2.94·δ_max/v, with δ_max
    /// from ½·m·v² = K·δ^(p+1)/(p + 1) (Hertz; exact for p = 3/2).
    pub fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        2.94 * self.penetration_of_energy(0.5 * mass * speed * speed) / speed
    }

    /// [m] The penetration that stores `energy` [J].
    fn penetration_of_energy(&self, energy: f64) -> f64 {
        let PowerLaw { stiffness, exponent: p } = self.elastic.for_small_penetrations();
        math::powf((p + 1.0) * energy / stiffness, 1.0 / (p + 1.0))
    }

    /// [1/s] Frequency of `mass` [kg] on this contact at the penetration `depth` [m].
    pub fn frequency(&self, mass: f64, depth: f64) -> f64 {
        let PowerLaw { stiffness, exponent: p } = self.elastic.for_small_penetrations();
        (p * stiffness * math::powf(depth, p - 1.0) / mass).sqrt()
    }
}
