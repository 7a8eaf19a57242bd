//! Contacts that keep their state from the step before: open, sticking, or sliding in the same direction. Their
//! impulses then follow from linear equations; the caller checks the result against the contact laws.

use super::{MAX_CONTACTS, NORMAL, Pairs, Scaled, TANGENTIAL};

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
        let mut rows = [[0.0; MAX_EQUATIONS + 1]; MAX_EQUATIONS];
        for (row, at) in rows.iter_mut().zip(unknowns) {
            for (element, of) in row.iter_mut().zip(unknowns) {
                *element = self.delassus(at.contact, at.part, of.contact, of.part);
                if of.slip != 0.0 {
                    *element += of.slip * self.delassus(at.contact, at.part, of.contact, TANGENTIAL);
                }
            }
            row[count] = -self.bias(at.contact, at.part);
        }
        solve(&mut rows[..count])?;
        let mut impulses = Pairs::default();
        for (unknown, row) in unknowns.iter().zip(&rows) {
            impulses[unknown.contact][unknown.part] += row[count];
            impulses[unknown.contact][TANGENTIAL] += unknown.slip * row[count];
        }
        Some(impulses)
    }
}

/// Gauss–Jordan elimination with partial pivoting; the solution is left in the last column. `None` if singular.
fn solve(rows: &mut [[f64; MAX_EQUATIONS + 1]]) -> Option<()> {
    let size = rows.len();
    for column in 0..size {
        let largest = |a: &usize, b: &usize| rows[*a][column].abs().total_cmp(&rows[*b][column].abs());
        let pivot = (column..size).max_by(largest)?;
        rows.swap(column, pivot);
        let pivot_row = rows[column];
        if pivot_row[column].abs() < MIN_PIVOT {
            return None;
        }
        for (index, row) in rows.iter_mut().enumerate() {
            let factor = row[column] / pivot_row[column];
            for (element, pivot) in row.iter_mut().zip(&pivot_row).take(size + 1).skip(column) {
                *element = if index == column { *element / pivot_row[column] } else { *element - factor * pivot };
            }
        }
    }
    Some(())
}
