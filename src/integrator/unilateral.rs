//! What time stepping asks of a system whose contacts are rigid.

use super::complementarity::{MOST_CONTACTS, NORMAL, Pairs};
use super::problem::Problem;

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
    pub gap: [f64; MOST_CONTACTS],
    /// [m/s] Rates of the gaps, and sliding speeds.
    pub velocity: Pairs,
}

/// A system of second order with unilateral contacts. Whatever is not asked for here stays as the defaults have it:
/// no contact at all.
///
/// The default of `Modes` are those in which no contact exerts a force: [`Problem::rates`] is then the motion
/// without contacts.
pub trait Unilateral<const N: usize>: Problem<N> {
    /// Of every contact.
    fn contact_laws(&self) -> [ContactLaw; MOST_CONTACTS] {
        [ContactLaw::default(); MOST_CONTACTS]
    }

    /// Gaps and relative velocities in the state `y`. Velocities are affine in the rates of `y`.
    fn contacts(&self, _t: f64, _y: &[f64; N]) -> Relative {
        Relative { gap: [f64::INFINITY; MOST_CONTACTS], velocity: Pairs::default() }
    }

    /// By how much the rates of every state change under a unit impulse in one part of one contact, M⁻¹·W: positions
    /// do not, velocities do.
    fn response(&self, _t: f64, _y: &[f64; N], _contact: usize, _part: usize) -> [f64; N] {
        [0.0; N]
    }
}

/// What the contacts did in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulses<const N: usize> {
    /// [s] Middle of the step, where they act.
    pub t: f64,
    /// State there.
    pub y: [f64; N],
    /// [N] Impulses over the length of the step.
    pub forces: Pairs,
    /// Which contacts were closed in the step that led to the present state. It is the step of `forces` but for an
    /// interrupted one, whose forces are those of the whole step.
    pub closed: [bool; MOST_CONTACTS],
}

impl<const N: usize> Impulses<N> {
    /// Before the first step.
    pub fn none(t: f64, y: [f64; N]) -> Self {
        Self { t, y, forces: Pairs::default(), closed: [false; MOST_CONTACTS] }
    }

    /// The contact exerts a force.
    pub fn acts(&self, contact: usize) -> bool {
        self.forces[contact][NORMAL] > 0.0
    }
}
