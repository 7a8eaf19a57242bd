//! Normal contact: f_n = max(0, F(δ)·(1 + χ·s)), s = min(δ̇/δ̇⁻, s_max).
//!
//! F is an [`Elastic`] law, χ a number from the damping law and the restitution
//! ([`damping::factor`]). Which elastic law, whether χ is there at all and which friction law follow
//! from the scene; each combination is compiled on its own.

pub mod damping;
mod elastic;

pub use elastic::{Elastic, HertzThreeHalves, Linear, Liu, Power};

use super::friction::{Friction, FrictionParameters, Rubbing};
use crate::integrator::Kinks;
use crate::math::{self, Real};

/// Numbers of one contact, ready for the inner loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactParameters {
    /// [N/m^p] Stiffness K; for Liu's law (π/2)·E*·L [N/m].
    pub stiffness: f64,
    /// Exponent p.
    pub exponent: f64,
    /// [m] Clearance c, for the conformal law.
    pub clearance: f64,
    /// χ.
    pub damping: f64,
    /// s_max.
    pub ratio_limit: f64,
    /// [m/s] v_floor.
    pub speed_floor: f64,
    /// Friction.
    pub friction: FrictionParameters,
}

/// The memory of one contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactMode {
    /// Closed: δ has risen through zero and not fallen since.
    pub closed: bool,
    /// [m/s] δ̇⁻, while closed.
    pub approach: f64,
    /// [s/m] 1/δ̇⁻.
    pub per_approach: f64,
}

impl ContactMode {
    /// A contact that closes at the approach speed `rate` [m/s].
    pub fn closing(rate: f64, speed_floor: f64) -> Self {
        let approach = rate.max(speed_floor);
        Self { closed: true, approach, per_approach: 1.0 / approach }
    }
}

/// Whether χ is in the law.
pub trait Damped {
    /// 1 + χ·s.
    fn factor<R: Real>(parameters: &ContactParameters, rate: R, per_approach: f64) -> R;
}

/// Hysteresis damping.
pub struct Hysteresis;

/// χ = 0.
pub struct Undamped;

impl Damped for Hysteresis {
    #[inline(always)]
    fn factor<R: Real>(parameters: &ContactParameters, rate: R, per_approach: f64) -> R {
        (rate * per_approach).min(parameters.ratio_limit).times_plus(parameters.damping, R::ONE)
    }
}

impl Damped for Undamped {
    #[inline(always)]
    fn factor<R: Real>(_: &ContactParameters, _: R, _: f64) -> R {
        R::ONE
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

/// Forces at the penetration `depth` [m], its `rate` [m/s], the bristles' deflection `z` [m] and the
/// sliding speed that `sliding` gives [m/s]. They are 0 while f_n would pull: no adhesion.
#[inline(always)]
pub fn force<R: Real, E: Elastic, D: Damped, F: Friction>(
    parameters: &ContactParameters,
    per_approach: f64,
    depth: R,
    rate: R,
    z: R,
    sliding: impl FnOnce() -> R,
) -> Forces<R> {
    let mut normal = R::ZERO;
    if R::MANY || depth > 0.0 {
        normal = (E::force(parameters, depth.max(0.0)) * D::factor(parameters, rate, per_approach)).max(0.0);
    }
    if !F::PRESENT || (!F::BRISTLES && normal == 0.0) {
        return Forces { normal, ..Forces::default() };
    }
    let Rubbing { ratio, bristle_rate } = F::rub(&parameters.friction, sliding(), z);
    Forces { normal, tangential: normal * ratio, bristle_rate }
}

/// What a contact does to energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account<R = f64> {
    /// [J] Elastic energy.
    pub energy: R,
    /// [W] That normal forces take, f_n·δ̇: the rate of `energy` and what hysteresis loses.
    pub normal_power: R,
    /// [W] That friction takes, bristles included.
    pub friction_loss: R,
}

impl<R: Real> std::ops::AddAssign for Account<R> {
    fn add_assign(&mut self, other: Self) {
        self.energy += other.energy;
        self.normal_power += other.normal_power;
        self.friction_loss += other.friction_loss;
    }
}

/// The account of the [`force`] of the same arguments: what the bodies lose to it is f_n·δ̇ + f_t·v_t.
pub fn account<R: Real, E: Elastic, D: Damped, F: Friction>(
    parameters: &ContactParameters,
    per_approach: f64,
    depth: R,
    rate: R,
    z: R,
    sliding: R,
) -> Account<R> {
    let Forces { normal, tangential, .. } = force::<R, E, D, F>(parameters, per_approach, depth, rate, z, || sliding);
    Account {
        energy: E::energy(parameters, depth.max(0.0)),
        normal_power: normal * rate,
        friction_loss: tangential * sliding,
    }
}

impl ContactParameters {
    /// Adds the kinks of the force in the closed contact of memory `mode`, whose penetration grows at `rate` [m/s] and
    /// whose surfaces slide at `sliding` [m/s]: where s reaches its limit, where the force is cut off at 0, where the
    /// friction law has corners.
    pub fn kinks(&self, mode: &ContactMode, rate: f64, sliding: f64, kinks: &mut Kinks) {
        if self.damping > 0.0 {
            kinks.push(rate + mode.approach / self.damping);
            if self.ratio_limit.is_finite() {
                kinks.push(rate - mode.approach * self.ratio_limit);
            }
        }
        for corner in self.friction.corners.into_iter().flatten() {
            kinks.push(sliding - corner);
            kinks.push(sliding + corner);
        }
    }

    /// [s] How long a free impact of `mass` [kg] at `speed` [m/s] lasts: 2.94·δ_max/v, with δ_max
    /// from ½·m·v² = K·δ^(p+1)/(p + 1) (Hertz; exact for p = 3/2).
    pub fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        2.94 * self.penetration_of_energy(0.5 * mass * speed * speed) / speed
    }

    /// [m] The penetration that stores `energy` [J].
    fn penetration_of_energy(&self, energy: f64) -> f64 {
        let p = self.exponent;
        math::powf((p + 1.0) * energy / self.small_stiffness(), 1.0 / (p + 1.0))
    }

    /// [1/s] Frequency of `mass` [kg] on this contact at the penetration `depth` [m].
    pub fn frequency(&self, mass: f64, depth: f64) -> f64 {
        let p = self.exponent;
        (p * self.small_stiffness() * math::powf(depth, p - 1.0) / mass).sqrt()
    }

    /// [N/m^p] K of the power law that holds for small penetrations.
    fn small_stiffness(&self) -> f64 {
        self.stiffness * if self.clearance > 0.0 { 1.0 / (2.0 * self.clearance).sqrt() } else { 1.0 }
    }
}
