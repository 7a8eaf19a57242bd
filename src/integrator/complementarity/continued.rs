//! Contacts that keep their state from the step before: open, sticking, or sliding in the same direction. Their
//! impulses then follow from linear equations; the caller checks the result against the contact laws.

use super::{MAX_CONTACTS, NORMAL, Pairs, Scaled, TANGENTIAL};
use crate::integrator::linear::{factorise, substitute};

/// Maximum number of equations.
const MAX_EQUATIONS: usize = 2 * MAX_CONTACTS;
/// Scaled elements are about 1; a smaller pivot means that contacts are redundant.
const MIN_PIVOT: f64 = 1e-9;
/// A tangential impulse within this share of its friction limit counts as sliding.
const SLIDING_SHARE: f64 = 1.0 - 1e-9;

/// An unknown: the normal impulse of a contact, with the tangential impulse that sliding adds, or the tangential
/// impulse of a sticking contact. Its equation states that the velocity in that direction is 0.
#[derive(Clone, Copy, Default)]
struct Unknown {
    contact: usize,
    part: usize,
    /// Tangential impulse over normal impulse while sliding; 0 without sliding.
    slip: f64,
}

impl Scaled<'_> {
    /// Scaled impulses if every contact keeps the state that it had with the impulses `before`; `None` if the equations
    /// are singular.
    pub fn continued(&self, before: &Pairs) -> Option<Pairs> {
        let mut unknowns = [Unknown::default(); MAX_EQUATIONS];
        let mut count = 0;
        for (contact, [normal, tangential]) in before.iter().enumerate().take(self.count()) {
            if *normal > 0.0 {
                let most = self.problem.friction[contact] * normal;
                let sticks = tangential.abs() < SLIDING_SHARE * most;
                let slip = if sticks || most == 0.0 { 0.0 } else { self.friction(contact).copysign(*tangential) };
                unknowns[count] = Unknown { contact, part: NORMAL, slip };
                count += 1;
                if sticks {
                    unknowns[count] = Unknown { contact, part: TANGENTIAL, slip: 0.0 };
                    count += 1;
                }
            }
        }
        let unknowns = &unknowns[..count];
        let mut found = [0.0; MAX_EQUATIONS];
        for (found, at) in found.iter_mut().zip(unknowns) {
            *found = -self.bias(at.contact, at.part);
        }
        let element = |row: usize, column: usize| {
            let (at, of) = (unknowns[row], unknowns[column]);
            let normal = self.delassus(at.contact, at.part, of.contact, of.part);
            if of.slip == 0.0 {
                return normal;
            }
            normal + of.slip * self.delassus(at.contact, at.part, of.contact, TANGENTIAL)
        };
        let (mut factors, mut pivot) = ([0.0; MAX_EQUATIONS * MAX_EQUATIONS], [0; MAX_EQUATIONS]);
        let (factors, pivot) = (&mut factors[..count * count], &mut pivot[..count]);
        if factorise(factors, pivot, element) < MIN_PIVOT {
            return None;
        }
        substitute(factors, pivot, &mut found[..count]);
        let mut impulses = Pairs::default();
        for (unknown, impulse) in unknowns.iter().zip(found) {
            impulses[unknown.contact][unknown.part] += impulse;
            impulses[unknown.contact][TANGENTIAL] += unknown.slip * impulse;
        }
        Some(impulses)
    }
}
