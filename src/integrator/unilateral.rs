//! Interface between time stepping and a system with rigid contacts.

use super::complementarity::{MAX_CONTACTS, NORMAL, Pairs};
use super::system::System;

/// Maximum number of states of a system with rigid contacts.
pub const MAX_RIGID_CONTACT_STATES: usize = 20;

/// Restitution, friction and play of a rigid contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLaw {
    /// Newton's coefficient of restitution e_N.
    pub restitution: f64,
    /// Coulomb's coefficient of friction μ.
    pub friction: f64,
    /// [m] Width of the play that the contact bounds. A step that ends deeper than that has lost the contact.
    pub clearance: f64,
}

/// Gaps and relative velocities of all contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// [m] Gaps: negative in penetration, +∞ for a contact that does not exist.
    pub gap: [f64; MAX_CONTACTS],
    /// [m/s] Rates of the gaps and sliding speeds.
    pub velocity: Pairs,
}

/// A system of second order with unilateral rigid contacts. The default implementation has no contact.
///
/// In its discrete state no contact exerts a force: [`rates`](super::Ode::rates) are those of the motion without
/// contacts.
pub trait Unilateral: System {
    /// The contact law of every contact.
    fn contact_laws(&self) -> [ContactLaw; MAX_CONTACTS] {
        [ContactLaw::default(); MAX_CONTACTS]
    }

    /// Gaps and relative velocities in the state `y`. The relative velocities are affine in the velocities of `y`.
    fn contacts(&self, _t: f64, _y: &[f64]) -> Relative {
        Relative { gap: [f64::INFINITY; MAX_CONTACTS], velocity: Pairs::default() }
    }

    /// Writes the change of every state under a unit impulse in one direction (`part`) of one contact: M⁻¹·W for
    /// velocities, 0 for positions.
    fn response(&self, _t: f64, _y: &[f64], _contact: usize, _part: usize, response: &mut [f64]) {
        response.fill(0.0);
    }
}

/// The contact impulses of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulses {
    /// [s] Midpoint of the step, where the impulses act.
    pub t: f64,
    /// State at the midpoint, padded with zeros.
    pub y: [f64; MAX_RIGID_CONTACT_STATES],
    /// [N] Impulses over the length of the step.
    pub forces: Pairs,
    /// Which contacts were closed in the step that led to the present state. It is the step of `forces`, except after a
    /// step was shortened: `forces` are then those of the whole step.
    pub closed: [bool; MAX_CONTACTS],
}

impl Impulses {
    /// No impulses, before the first step from `y` at `t` [s].
    pub fn none(t: f64, y: &[f64]) -> Self {
        Self { t, y: padded(y), forces: Pairs::default(), closed: [false; MAX_CONTACTS] }
    }

    /// Whether the contact exerts a force.
    pub fn acts(&self, contact: usize) -> bool {
        self.forces[contact][NORMAL] > 0.0
    }
}

/// The state `y` padded with zeros.
pub fn padded(y: &[f64]) -> [f64; MAX_RIGID_CONTACT_STATES] {
    let mut array = [0.0; MAX_RIGID_CONTACT_STATES];
    array[..y.len()].copy_from_slice(y);
    array
}
