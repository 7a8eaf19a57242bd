//! A revolute joint with clearance: a journal in a bearing.
//!
//! e = journal centre − bearing centre, ε = |e|, n = e/ε, t = perp(n), δ = ε − c. Both bodies get the
//! contact force at the one point P + R_b·n. The journal's material speed there against the bearing's
//! is v_t = ė·t + (R_b − ε)·ω_journal − R_b·ω_bearing: force times this speed is the power lost.

use super::{Kernel, KernelFamily, Kernels, choose, compliance, parameters};
use crate::integrator::{Guard, Kinks};
use crate::math::Real;
use crate::model::contact::{self, Account, ContactMode, ContactParameters, Damped, Elastic, Forces, force};
use crate::model::friction::Friction;
use crate::model::plane::{Vec2, perp};
use crate::model::scalar::Scalar;
use crate::scene::{self, Elasticity};

/// Where the journal is in its bearing, and how both move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Play<R = f64> {
    /// [m] e.
    pub eccentricity: Vec2<R>,
    /// [m/s] ė.
    pub rate: Vec2<R>,
    /// [rad/s] Of the journal's body.
    pub journal_speed: R,
    /// [rad/s] Of the bearing's body.
    pub bearing_speed: R,
}

/// What the contact does to both bodies: a force on the journal at its centre, the opposite force on
/// the bearing at its centre, and a couple on each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R = f64> {
    /// [N] On the journal's body.
    pub force: Vec2<R>,
    /// [N·m] On the journal's body, about the journal centre.
    pub journal_couple: R,
    /// [N·m] On the bearing's body, about the bearing centre.
    pub bearing_couple: R,
    /// [m/s] Rate of the bristles' deflection.
    pub bristle_rate: R,
}

/// The force on the journal's body [N] at per_approach, e, ė, ω_journal, ω_bearing and the bristles' deflection. Only
/// friction adds to the load. All that the motion waits for goes in and out by registers.
type LoadKernel<R> = fn(&Revolute, f64, Vec2<R>, Vec2<R>, R, R, R, &mut Load<R>) -> Vec2<R>;

/// What is compiled for each combination of laws.
#[derive(Clone, Copy, Debug)]
pub struct ByLaws<R> {
    load: LoadKernel<R>,
    account: fn(&Revolute, f64, &Play<R>, R) -> Account<R>,
}

/// A revolute joint with clearance.
#[derive(Clone, Copy, Debug)]
pub struct Revolute {
    /// [m] R_b.
    pub(super) radius: f64,
    /// [m] c.
    clearance: f64,
    /// The contact's numbers.
    pub contact: ContactParameters,
    kernels: Kernels<Family>,
}

#[derive(Clone, Copy, Debug)]
struct Family;

impl Kernel for Family {
    type Of<R: Real> = ByLaws<R>;
}

impl KernelFamily for Family {
    type Kernel = Self;
    fn kernel<R: Real, E: Elastic, D: Damped, F: Friction>() -> ByLaws<R> {
        ByLaws { load: load::<R, E, D, F>, account: account::<R, E, D, F> }
    }
}

#[expect(clippy::too_many_arguments, reason = "as many as there are registers for")]
fn load<R: Real, E: Elastic, D: Damped, F: Friction>(
    joint: &Revolute,
    per_approach: f64,
    eccentricity: Vec2<R>,
    rate: Vec2<R>,
    journal_speed: R,
    bearing_speed: R,
    z: R,
    load: &mut Load<R>,
) -> Vec2<R> {
    let epsilon = eccentricity.norm();
    let depth = epsilon - joint.clearance;
    if depth <= 0.0 && !(F::BRISTLES && epsilon > 0.0) {
        return Vec2::ZERO;
    }
    let play = Play { eccentricity, rate, journal_speed, bearing_speed };
    let n = eccentricity / epsilon;
    let t = perp(n);
    let sliding = || joint.sliding(&play, epsilon, t);
    let Forces { normal, tangential, bristle_rate } =
        force::<R, E, D, F>(&joint.contact, per_approach, depth, rate.dot(n), z, sliding);
    if !F::PRESENT {
        return -normal * n;
    }
    load.journal_couple = (epsilon - joint.radius) * tangential;
    load.bearing_couple = tangential * joint.radius;
    load.bristle_rate = bristle_rate;
    -normal * n - tangential * t
}

fn account<R: Real, E: Elastic, D: Damped, F: Friction>(
    joint: &Revolute,
    per_approach: f64,
    play: &Play<R>,
    z: R,
) -> Account<R> {
    let epsilon = play.eccentricity.norm();
    if epsilon == 0.0 {
        return Account::default();
    }
    let n = play.eccentricity / epsilon;
    let sliding = joint.sliding(play, epsilon, perp(n));
    let (depth, rate) = (epsilon - joint.clearance, play.rate.dot(n));
    contact::account::<R, E, D, F>(&joint.contact, per_approach, depth, rate, z, sliding)
}

impl Revolute {
    /// From the scene's.
    pub fn new(joint: &scene::Revolute) -> Self {
        let contact = &joint.contact;
        let (bearing, clearance) = (joint.radius, joint.clearance);
        let compliance = compliance(contact);
        let (stiffness, conformal_clearance) = match joint.elasticity {
            // H. M. Lankarani, P. E. Nikravesh 1990, with the journal's radius R_b − c.
            Elasticity::Hertz if contact.stiffness > 0.0 => (contact.stiffness, 0.0),
            Elasticity::Hertz => {
                let curvature = bearing * (bearing - clearance) / clearance;
                (4.0 / (3.0 * compliance) * curvature.sqrt(), 0.0)
            }
            Elasticity::Liu => (std::f64::consts::FRAC_PI_2 / compliance * contact.width, clearance),
        };
        let mut contact = parameters(contact, stiffness, conformal_clearance);
        if joint.elasticity == Elasticity::Liu {
            contact.exponent = 1.5; // of small penetrations; the law itself has none
        }
        Self { radius: bearing, clearance, contact, kernels: choose::<Family>(joint.elasticity, &joint.contact) }
    }

    /// [m] δ, negative when open.
    #[inline(always)]
    pub fn penetration(&self, play: &Play) -> f64 {
        play.eccentricity.norm() - self.clearance
    }

    /// [m/s] δ̇; 0 where the journal is centred and n undefined.
    #[inline(always)]
    pub fn penetration_rate(&self, play: &Play) -> f64 {
        let epsilon = play.eccentricity.norm();
        if epsilon > 0.0 { play.rate.dot(play.eccentricity) / epsilon } else { 0.0 }
    }

    /// The event at which the contact changes: closing when open, opening when closed.
    #[inline(always)]
    pub fn guard(&self, mode: &ContactMode, play: &Play) -> Guard {
        guard(mode, self.penetration(play), self.penetration_rate(play))
    }

    /// Adds the kinks of the closed contact's force.
    pub fn kinks(&self, mode: &ContactMode, play: &Play, kinks: &mut Kinks) {
        let epsilon = play.eccentricity.norm().max(f64::MIN_POSITIVE);
        let n = play.eccentricity / epsilon;
        self.contact.kinks(mode, play.rate.dot(n), self.sliding(play, epsilon, perp(n)), kinks);
    }

    /// [m/s] v_t at the contact point, ε from the bearing's centre along the normal of tangent `t`.
    #[inline(always)]
    pub(super) fn sliding<R: Real>(&self, play: &Play<R>, epsilon: R, t: Vec2<R>) -> R {
        play.rate.dot(t) + (-epsilon + self.radius) * play.journal_speed - play.bearing_speed * self.radius
    }

    /// Energy and losses of the closed contact with its bristles deflected by `z` [m].
    pub fn account<R: Scalar>(&self, mode: &ContactMode, play: &Play<R>, z: R) -> Account<R> {
        (R::kernel(&self.kernels).account)(self, mode.per_approach, play, z)
    }

    /// The load of the closed contact with its bristles deflected by `z` [m].
    #[inline(always)]
    pub fn load<R: Scalar>(&self, mode: &ContactMode, play: &Play<R>, z: R) -> Load<R> {
        let Play { eccentricity, rate, journal_speed, bearing_speed } = *play;
        let (kernel, mut load) = (R::kernel(&self.kernels).load, Load::default());
        load.force = kernel(self, mode.per_approach, eccentricity, rate, journal_speed, bearing_speed, z, &mut load);
        load
    }
}

/// −δ of an open contact, δ of a closed one.
#[inline(always)]
pub fn guard(mode: &ContactMode, depth: f64, rate: f64) -> Guard {
    if mode.closed { Guard { value: depth, rate } } else { Guard { value: -depth, rate: -rate } }
}
