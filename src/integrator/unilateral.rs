//! What time stepping asks of a system whose contacts are rigid.

use super::complementarity::{MAX_CONTACTS, NORMAL, Pairs};
use super::system::System;

/// Most states of a system with rigid contacts.
pub const MAX_RIGID_CONTACT_STATES: usize = 20;

/// Restitution and friction of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLaw {
    /// Newton's restitution e_N.
    pub restitution: f64,
    /// Coulomb's μ.
    pub friction: f64,
}

/// How the surfaces of all contacts lie and move to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// [m] Gaps, negative in penetration; +∞ where there is no contact.
    pub gap: [f64; MAX_CONTACTS],
    /// [m/s] Rates of the gaps, and sliding speeds.
    pub velocity: Pairs,
}

/// A system of second order with unilateral contacts. Whatever is not asked for here stays as the defaults have it:
/// no contact at all.
///
/// Its discrete state is one in which no contact exerts a force: [`rates`](super::Ode::rates) are those of the motion without
/// contacts.
pub trait Unilateral: System {
    /// Of every contact.
    fn contact_laws(&self) -> [ContactLaw; MAX_CONTACTS] {
        [ContactLaw::default(); MAX_CONTACTS]
    }

    /// Gaps and relative velocities in the state `y`. Velocities are affine in the rates of `y`.
    fn contacts(&self, _t: f64, _y: &[f64]) -> Relative {
        Relative { gap: [f64::INFINITY; MAX_CONTACTS], velocity: Pairs::default() }
    }

    /// Writes by how much the rates of every state change under a unit impulse in one part of one contact, M⁻¹·W:
    /// positions do not, velocities do.
    fn response(&self, _t: f64, _y: &[f64], _contact: usize, _part: usize, response: &mut [f64]) {
        response.fill(0.0);
    }
}

/// What the contacts did in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulses {
    /// [s] Middle of the step, where they act.
    pub t: f64,
    /// State there, and zeros.
    pub y: [f64; MAX_RIGID_CONTACT_STATES],
    /// [N] Impulses over the length of the step.
    pub forces: Pairs,
    /// Which contacts were closed in the step that led to the present state. It is the step of `forces` but for an
    /// interrupted one, whose forces are those of the whole step.
    pub closed: [bool; MAX_CONTACTS],
}

impl Impulses {
    /// Before the first step.
    pub fn none(t: f64, y: &[f64]) -> Self {
        Self { t, y: padded(y), forces: Pairs::default(), closed: [false; MAX_CONTACTS] }
    }

    /// The contact exerts a force.
    pub fn acts(&self, contact: usize) -> bool {
        self.forces[contact][NORMAL] > 0.0
    }
}

/// A state in an array with room, behind which there are zeros.
pub fn padded(y: &[f64]) -> [f64; MAX_RIGID_CONTACT_STATES] {
    let mut array = [0.0; MAX_RIGID_CONTACT_STATES];
    array[..y.len()].copy_from_slice(y);
    array
}
