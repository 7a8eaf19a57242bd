//! Normal contact: f_n = max(0, F(δ)·(1 + χ·s)), s = min(δ̇/δ̇⁻, s_max).
//!
//! F is an [`Elastic`] law; each has a file. χ is the factor that the damping law derives from the restitution
//! ([`damping::factor`]). The laws are data: the force evaluation branches on them.

// Defines `elasticities!`, which passes the list of declared elasticities to another macro.
include!(concat!(env!("OUT_DIR"), "/elasticities.rs"));

pub mod compliance;
pub mod damping;
mod elastic;
mod elastic_law;
mod linear;

/// Declares the file of each declared elasticity.
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

/// Parameters of one contact, precomputed for force evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactParameters {
    /// Elastic law F.
    pub elastic: Elastic,
    /// Damping factor χ.
    pub damping: f64,
    /// Upper limit s_max of the speed ratio.
    pub ratio_limit: f64,
    /// [m/s] Lower limit v_floor of the approach speed.
    pub speed_floor: f64,
    /// Friction law.
    pub friction: Friction,
}

/// The discrete state of one contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
    /// Whether the contact is closed: δ has risen through zero and not fallen through it since.
    pub closed: bool,
    /// [m/s] δ̇⁻, approach speed when the contact closed.
    pub approach: f64,
    /// [s/m] 1/δ̇⁻.
    pub per_approach: f64,
}

impl ContactState {
    /// The state of a contact that closes at the approach speed `rate` [m/s], limited to `speed_floor` [m/s] from
    /// below.
    pub fn closing(rate: f64, speed_floor: f64) -> Self {
        let approach = rate.max(speed_floor);
        Self { closed: true, approach, per_approach: 1.0 / approach }
    }
}

/// Forces in a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces<R = f64> {
    /// [N] f_n, normal force.
    pub normal: R,
    /// [N] f_t, tangential force.
    pub tangential: R,
    /// [m/s] Rate of the bristles' deflection.
    pub bristle_rate: R,
}

/// Sliding in a contact, with the forces that act meanwhile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rubbing {
    /// [m/s] v_t, sliding velocity.
    pub speed: f64,
    /// [N] f_n, normal force.
    pub normal: f64,
    /// [N] f_t, tangential force.
    pub friction: f64,
}

/// Energy and powers of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactEnergy<R = f64> {
    /// [J] Elastic energy.
    pub energy: R,
    /// [W] f_n·δ̇, power of the normal force on the contact: the rate of `energy` plus the hysteresis loss.
    pub normal_power: R,
    /// [W] f_t·v_t, power of friction, including that stored in bristles.
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
    /// Parameters of a contact with this elastic law.
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

    /// [N] f_n at the penetration `depth` [m] and its `rate` [m/s]; limited to 0, because there is no adhesion.
    #[inline(always)]
    fn normal_force<R: Real>(&self, per_approach: f64, depth: R, rate: R) -> R {
        if !R::MANY && depth <= 0.0 {
            return R::ZERO;
        }
        let ratio = (rate * per_approach).min(self.ratio_limit);
        (self.elastic.force(depth.max(0.0)) * ratio.multiply_add(self.damping, R::ONE)).max(0.0)
    }

    /// Forces at the penetration `depth` [m], its `rate` [m/s], the bristle deflection `z` [m] and the sliding speed
    /// that `sliding` computes [m/s]. Numbers with derivatives do not fit into registers and are faster behind a call.
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

    /// Sliding and forces for the arguments of [`forces`](Self::forces).
    pub fn rubbing(&self, per_approach: f64, depth: f64, rate: f64, z: f64, speed: f64) -> Rubbing {
        let Forces { normal, tangential, .. } = self.forces(per_approach, depth, rate, z, || speed);
        Rubbing { speed, normal, friction: tangential }
    }

    /// Energy and powers for the arguments of [`forces`](Self::forces). The bodies lose f_n·δ̇ + f_t·v_t to the
    /// contact.
    pub fn contact_energy<R: Real>(&self, per_approach: f64, depth: R, rate: R, z: R, sliding: R) -> ContactEnergy<R> {
        let Forces { normal, tangential, .. } = self.forces(per_approach, depth, rate, z, || sliding);
        ContactEnergy {
            energy: self.elastic.energy(depth.max(0.0)),
            normal_power: normal * rate,
            friction_loss: tangential * sliding,
        }
    }

    /// Adds the functions whose zeros are derivative discontinuities of the force of a closed contact with the discrete
    /// state `state`, penetration rate `rate` [m/s] and sliding speed `sliding` [m/s]: the limits of s and of the
    /// force, and the corners of the friction law.
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

    /// [s] Duration of a free impact of `mass` [kg] at `speed` [m/s]: 2.94·δ_max/v, with δ_max from ½·m·v² =
    /// K·δ^(p+1)/(p + 1) (Hertz; exact for p = 3/2).
    pub fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        2.94 * self.penetration_of_energy(0.5 * mass * speed * speed) / speed
    }

    /// [m] Penetration at which the contact stores `energy` [J].
    fn penetration_of_energy(&self, energy: f64) -> f64 {
        let PowerLaw { stiffness, exponent: p } = self.elastic.for_small_penetrations();
        math::powf((p + 1.0) * energy / stiffness, 1.0 / (p + 1.0))
    }

    /// [rad/s] Angular frequency of `mass` [kg] on this contact at the penetration `depth` [m].
    pub fn frequency(&self, mass: f64, depth: f64) -> f64 {
        let PowerLaw { stiffness, exponent: p } = self.elastic.for_small_penetrations();
        (p * stiffness * math::powf(depth, p - 1.0) / mass).sqrt()
    }
}
