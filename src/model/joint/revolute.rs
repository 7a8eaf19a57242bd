//! A revolute joint with clearance: a journal in a bearing.
//!
//! e = journal centre − bearing centre, ε = |e|, n = e/ε, t = perp(n), δ = ε − c. Both bodies get the
//! contact force at the one point P + R_b·n. The journal's material speed there against the bearing's
//! is v_t = ė·t + (R_b − ε)·ω_journal − R_b·ω_bearing: force times this speed is the power lost.

use super::{Kernel, KernelFamily, Kernels, choose, compliance, parameters};
use crate::integrator::{Guard, Kinks};
use crate::math::Real;
use crate::model::contact::{self, Account, ContactMode, ContactParameters, Damped, Elastic, Forces, force};
use crate::model::friction::{Friction, Frictionless};
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

impl<R: Real> Play<R> {
    /// ε [m] and n; none where the journal is centred and n undefined.
    #[inline(always)]
    pub(super) fn distance_and_normal(&self) -> Option<(R, Vec2<R>)> {
        let mut square = self.eccentricity.norm_squared();
        if R::MANY {
            // Then no distance counts as one.
            square = square.max(f64::MIN_POSITIVE);
        } else if square < f64::MIN_POSITIVE {
            return None;
        }
        // Root and reciprocal do not wait for one another.
        let epsilon = square.sqrt();
        Some((epsilon, (epsilon * square.recip()) * self.eccentricity))
    }
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

/// The forces of a contact, from per_approach, δ [m] and δ̇ [m/s] on. All that the motion waits for goes in and out by
/// registers.
#[derive(Clone, Copy, Debug)]
enum ForceKernel<R> {
    /// Without friction: f_n [N].
    Smooth(fn(&ContactParameters, f64, R, R) -> R),
    /// With friction: (f_n, f_t) [N] at the sliding speed [m/s] and the bristles' deflection [m] too; writes the rate of
    /// that.
    Rubbing(fn(&ContactParameters, f64, R, R, R, R, &mut R) -> Vec2<R>),
}

/// What is compiled for each combination of laws.
#[derive(Clone, Copy, Debug)]
pub struct ByLaws<R> {
    force: ForceKernel<R>,
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
        let force = if F::PRESENT {
            ForceKernel::Rubbing(rubbing::<R, E, D, F>)
        } else {
            ForceKernel::Smooth(smooth::<R, E, D>)
        };
        ByLaws { force, account: account::<R, E, D, F> }
    }
}

fn smooth<R: Real, E: Elastic, D: Damped>(contact: &ContactParameters, per_approach: f64, depth: R, rate: R) -> R {
    force::<R, E, D, Frictionless>(contact, per_approach, depth, rate, R::ZERO, || R::ZERO).normal
}

fn rubbing<R: Real, E: Elastic, D: Damped, F: Friction>(
    contact: &ContactParameters,
    per_approach: f64,
    depth: R,
    rate: R,
    sliding: R,
    z: R,
    moving: &mut R,
) -> Vec2<R> {
    let Forces { normal, tangential, bristle_rate } =
        force::<R, E, D, F>(contact, per_approach, depth, rate, z, || sliding);
    if F::BRISTLES {
        *moving = bristle_rate;
    }
    Vec2::new(normal, tangential)
}

fn account<R: Real, E: Elastic, D: Damped, F: Friction>(
    joint: &Revolute,
    per_approach: f64,
    play: &Play<R>,
    z: R,
) -> Account<R> {
    let Some((epsilon, n)) = play.distance_and_normal() else {
        return Account::default();
    };
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
        let journal = (-epsilon + self.radius).times_plus(play.journal_speed, play.rate.dot(t));
        (-play.bearing_speed).times_plus(self.radius, journal)
    }

    /// Energy and losses of the closed contact with its bristles deflected by `z` [m].
    pub fn account<R: Scalar>(&self, mode: &ContactMode, play: &Play<R>, z: R) -> Account<R> {
        (R::kernel(&self.kernels).account)(self, mode.per_approach, play, z)
    }

    /// The load of the closed contact with its bristles deflected by `z` [m].
    #[inline(always)]
    pub fn load<R: Scalar>(&self, mode: &ContactMode, play: &Play<R>, z: R) -> Load<R> {
        let Some((epsilon, n)) = play.distance_and_normal() else {
            return Load::default();
        };
        let (depth, rate) = (epsilon - self.clearance, play.rate.dot(n));
        match R::kernel(&self.kernels).force {
            ForceKernel::Smooth(force) => {
                Load { force: -force(&self.contact, mode.per_approach, depth, rate) * n, ..Load::default() }
            }
            ForceKernel::Rubbing(force) => {
                let t = perp(n);
                let sliding = self.sliding(play, epsilon, t);
                let mut bristle_rate = R::ZERO;
                let Vec2 { x: normal, y: tangential } =
                    force(&self.contact, mode.per_approach, depth, rate, sliding, z, &mut bristle_rate);
                Load {
                    force: n.times_plus(-normal, -tangential * t),
                    journal_couple: (epsilon - self.radius) * tangential,
                    bearing_couple: tangential * self.radius,
                    bristle_rate,
                }
            }
        }
    }
}

/// −δ of an open contact, δ of a closed one.
#[inline(always)]
pub fn guard(mode: &ContactMode, depth: f64, rate: f64) -> Guard {
    if mode.closed { Guard { value: depth, rate } } else { Guard { value: -depth, rate: -rate } }
}
