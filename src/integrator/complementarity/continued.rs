//! Contacts that go on as they were: open, sticking or slipping either way. What they do then follows from linear
//! equations, and the laws say whether it is a solution.

use super::{MAX_CONTACTS, NORMAL, Pairs, Scaled, TANGENTIAL};
use crate::integrator::linear::{factorize, substitute};

/// Most equations.
const MOST: usize = 2 * MAX_CONTACTS;
/// A pivot this small, of elements of about 1, is one of redundant contacts.
const LEAST_PIVOT: f64 = 1e-9;
/// A tangential impulse this close to its limit is at it.
const LIMIT: f64 = 1.0 - 1e-9;

/// An unknown: the normal impulse of a contact, with the tangential one that slipping makes of it, or the tangential
/// impulse of a sticking contact. Its equation is that the velocity in that part is 0.
#[derive(Clone, Copy, Default)]
struct Unknown {
    contact: usize,
    part: usize,
    /// Tangential over normal impulse.
    slip: f64,
}

impl Scaled<'_> {
    /// Scaled impulses if every contact does what it did with the impulses `before`; `None` where that is not known.
    pub fn continued(&self, before: &Pairs) -> Option<Pairs> {
        let mut unknowns = [Unknown::default(); MOST];
        let mut count = 0;
        for (contact, [normal, tangential]) in before.iter().enumerate().take(self.count()) {
            if *normal > 0.0 {
                let most = self.problem.friction[contact] * normal;
                let sticks = tangential.abs() < LIMIT * most;
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
        let mut found = [0.0; MOST];
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
        let (mut factors, mut pivot) = ([0.0; MOST * MOST], [0; MOST]);
        let (factors, pivot) = (&mut factors[..count * count], &mut pivot[..count]);
        if factorize(factors, pivot, element) < LEAST_PIVOT {
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
