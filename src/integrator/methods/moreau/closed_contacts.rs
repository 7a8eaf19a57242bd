//! The closed contacts of a step and their impulses.

use super::midpoint::{Midpoint, State};
use crate::integrator::complementarity::{ActiveContacts, MAX_CONTACTS, NORMAL, Pairs, TANGENTIAL};
use crate::integrator::unilateral::{ContactLaw, MAX_RIGID_CONTACT_STATES, Unilateral};

/// Share of the excess penetration of a lasting contact that one step corrects. If all of it were corrected at once,
/// contacts of the same body would keep opening each other.
const CORRECTED_SHARE: f64 = 0.1;
/// [share of the event scale] A contact whose gap is below this counts as touching, so that rounding neither opens nor
/// closes it.
const TOUCHING_GAP: f64 = 1e-6;

/// The closed contacts of a step. All lists have the order in which their impulses are solved for.
pub struct ClosedContacts {
    /// Index of each closed contact among all contacts.
    pub contacts: [usize; MAX_CONTACTS],
    touching: ActiveContacts,
    /// M⁻¹·W: changes of all velocities by a unit impulse in each direction of each closed contact.
    response: [[State; 2]; MAX_CONTACTS],
    restitution: [f64; MAX_CONTACTS],
    /// [m] Clearances.
    clearance: [f64; MAX_CONTACTS],
    /// [m/s] (h/2)·Ẇᵀu: relative velocity γ at the step's end less that at its middle, for the same u.
    transport: Pairs,
    /// [m/s] γ_A: relative velocity at the step's start.
    approach: Pairs,
    /// [m/s] γ at the step's end without impulses.
    departure: Pairs,
}

impl ClosedContacts {
    /// Finds the contacts whose gap closes by the middle of the step. `free` are the velocities at its end without
    /// contacts.
    pub fn new<D: Copy>(system: &dyn Unilateral<Discrete = D>, midpoint: &Midpoint<'_, D>, free: &State) -> Self {
        let mut closed = Self {
            contacts: [0; MAX_CONTACTS],
            touching: ActiveContacts::default(),
            response: [[[0.0; MAX_RIGID_CONTACT_STATES]; 2]; MAX_CONTACTS],
            restitution: [0.0; MAX_CONTACTS],
            clearance: [0.0; MAX_CONTACTS],
            transport: Pairs::default(),
            approach: Pairs::default(),
            departure: Pairs::default(),
        };
        let start = system.contacts(midpoint.start.t, &midpoint.start.y);
        let touching_gap = TOUCHING_GAP * system.event_scale();
        for (contact, (gap, velocity)) in start.gap.iter().zip(&start.velocity).enumerate() {
            if gap + 0.5 * midpoint.h * velocity[NORMAL] <= touching_gap {
                let slot = closed.count();
                closed.contacts[slot] = contact;
                closed.approach[slot] = *velocity;
                closed.touching.count += 1;
            }
        }
        if closed.count() > 0 {
            closed.linearize(system, midpoint, free);
        }
        closed
    }

    /// Number of closed contacts.
    pub fn count(&self) -> usize {
        self.touching.count
    }

    /// Sets the contact laws, the change of relative velocities, the responses and the Delassus matrix.
    fn linearize<D: Copy>(&mut self, system: &dyn Unilateral<Discrete = D>, midpoint: &Midpoint<'_, D>, free: &State) {
        let laws = system.contact_laws();
        let here = velocities(system, midpoint, free);
        let there = system.contacts(midpoint.start.t + midpoint.h, midpoint.of(&midpoint.end(free))).velocity;
        let still = velocities(system, midpoint, &[0.0; MAX_RIGID_CONTACT_STATES]);
        let count = self.count();
        for (slot, &contact) in self.contacts.iter().enumerate().take(count) {
            let ContactLaw { restitution, friction, clearance } = laws[contact];
            (self.restitution[slot], self.clearance[slot]) = (restitution, clearance);
            self.transport[slot] = [NORMAL, TANGENTIAL].map(|part| there[contact][part] - here[contact][part]);
            self.touching.friction[slot] = friction;
            for part in self.parts(slot) {
                let mut response = [0.0; MAX_RIGID_CONTACT_STATES];
                let n = midpoint.state().len();
                system.response(midpoint.t, midpoint.state(), contact, part, &mut response[..n]);
                let moved = velocities(system, midpoint, &response);
                for (other, &to) in self.contacts.iter().enumerate().take(count) {
                    for a in [NORMAL, TANGENTIAL] {
                        self.touching.delassus[other][a][slot][part] = moved[to][a] - still[to][a];
                    }
                }
                self.response[slot][part] = response;
            }
        }
    }

    /// The directions in which a contact may exert an impulse: without friction, only the normal direction.
    fn parts(&self, slot: usize) -> std::ops::Range<usize> {
        NORMAL..if self.touching.friction[slot] > 0.0 { TANGENTIAL + 1 } else { TANGENTIAL }
    }

    /// Number of evaluated responses.
    pub fn responses(&self) -> u64 {
        (0..self.count()).map(|slot| self.parts(slot).len() as u64).sum()
    }

    /// Sets the bias of the contact laws: relative velocities without impulses, where the step ends with the velocities
    /// `free`.
    pub fn set_bias<D: Copy>(
        &mut self,
        system: &dyn Unilateral<Discrete = D>,
        midpoint: &Midpoint<'_, D>,
        free: &State,
    ) {
        let without = velocities(system, midpoint, free);
        for slot in 0..self.count() {
            let velocity = without[self.contacts[slot]];
            let [normal, tangential] = [NORMAL, TANGENTIAL].map(|part| velocity[part] + self.transport[slot][part]);
            self.departure[slot] = [normal, tangential];
            self.touching.bias[slot] = [normal + self.restitution[slot] * self.approach[slot][NORMAL], tangential];
        }
    }

    /// Impulses that satisfy the contact laws; the solver first assumes that contacts behave as with the impulses
    /// `before`. A wedge locked by friction may have no solution with restitution; the plastic solution is then
    /// returned. `None` without either.
    pub fn solve(&self, before: &Pairs) -> Option<Pairs> {
        self.touching.impulses(before).or_else(|| {
            let mut plastic = self.touching.clone();
            plastic.bias = self.departure;
            plastic.impulses(before)
        })
    }

    /// The forces of the last step for these contacts.
    pub fn last<D: Copy>(&self, midpoint: &Midpoint<'_, D>) -> Pairs {
        let mut forces = self.contacts.map(|contact| midpoint.start.discrete.forces[contact]);
        forces[self.count()..].fill([0.0; 2]);
        forces
    }

    /// The velocities `free` plus the changes by `impulses`.
    pub fn after<D: Copy>(&self, midpoint: &Midpoint<'_, D>, free: &State, impulses: &Pairs) -> State {
        let mut y = *free;
        for (responses, impulse) in self.response.iter().zip(impulses).take(self.count()) {
            for (response, impulse) in responses.iter().zip(impulse) {
                for i in midpoint.positions..2 * midpoint.positions {
                    y[i] += response[i] * impulse;
                }
            }
        }
        y
    }

    /// A contact whose penetration exceeds its clearance at the end of the step: the step has lost it.
    pub fn lost(&self, gaps: &[f64; MAX_CONTACTS]) -> Option<usize> {
        let mut closed = self.contacts.iter().zip(&self.clearance).take(self.count());
        closed.find(|(contact, clearance)| gaps[**contact] < -**clearance).map(|(contact, _)| *contact)
    }

    /// Corrects part of the excess penetration of lasting contacts at the end of the step, `y`, with its `gaps` [m]. A jam, in
    /// which no correction exists, is left as it is.
    pub fn correct_penetration<D: Copy>(
        &self,
        system: &dyn Unilateral<Discrete = D>,
        midpoint: &Midpoint<'_, D>,
        impulses: &Pairs,
        gaps: &[f64; MAX_CONTACTS],
        y: &mut State,
    ) {
        let mut corrections = self.touching.clone();
        corrections.friction = [0.0; MAX_CONTACTS];
        let mut any_corrected = false;
        for slot in 0..corrections.count {
            let fastest = self.approach[slot][NORMAL].abs().max(self.departure[slot][NORMAL].abs());
            let excess_gap = gaps[self.contacts[slot]] + TOUCHING_GAP * system.event_scale() + midpoint.h * fastest;
            // Contacts that separate are not corrected, and no contact is pushed deeper than its gap allows.
            let corrected = excess_gap < 0.0 && impulses[slot][NORMAL] > 0.0;
            corrections.bias[slot] = [if corrected { CORRECTED_SHARE * excess_gap } else { excess_gap.max(0.0) }, 0.0];
            any_corrected |= corrected;
        }
        let Some(shifts) = any_corrected.then(|| corrections.impulses(impulses)).flatten() else {
            return;
        };
        for (response, shift) in self.response.iter().zip(shifts).take(corrections.count) {
            for i in 0..midpoint.positions {
                y[i] += response[NORMAL][midpoint.positions + i] * shift[NORMAL];
            }
        }
    }
}

/// Relative velocities of all contacts at the positions of the midpoint with the velocities of `moving`.
fn velocities<D: Copy>(system: &dyn Unilateral<Discrete = D>, midpoint: &Midpoint<'_, D>, moving: &State) -> Pairs {
    let mut y = midpoint.y;
    let rates = midpoint.positions..2 * midpoint.positions;
    y[rates.clone()].copy_from_slice(&moving[rates]);
    system.contacts(midpoint.t, midpoint.of(&y)).velocity
}
