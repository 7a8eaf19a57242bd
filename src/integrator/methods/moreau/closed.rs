//! The contacts that are closed in a step.

use super::middle::{Middle, State};
use crate::integrator::complementarity::{MOST_CONTACTS, NORMAL, Pairs, TANGENTIAL, Touching};
use crate::integrator::unilateral::{ContactLaw, MOST_STATES, Unilateral};

/// Share of what a lasting contact is too deep by that one step takes back. With all of it at once, contacts that
/// share a body keep throwing each other open.
const SHARE: f64 = 0.1;
/// Share of a just noticeable length within which a gap is none: rounding neither opens nor closes a contact.
const SKIN: f64 = 1e-6;

/// The closed contacts of a step, in the order in which they are solved for.
pub struct Closed {
    /// Their numbers.
    pub contacts: [usize; MOST_CONTACTS],
    touching: Touching,
    /// M⁻¹·W: changes of all velocities by a unit impulse in each part of each.
    response: [[State; 2]; MOST_CONTACTS],
    restitution: [f64; MOST_CONTACTS],
    /// [m/s] (h/2)·Ẇᵀu: by how much γ at the step's end is more than the same velocities have in its middle.
    turning: Pairs,
    /// [m/s] γ_A.
    arriving: Pairs,
    /// [m/s] γ at the step's end without impulses.
    leaving: Pairs,
}

impl Closed {
    /// The contacts whose gap is gone by the middle of a step that would have the velocities `free` without them.
    pub fn new<D: Copy>(system: &dyn Unilateral<Discrete = D>, middle: &Middle<'_>, free: &State) -> Self {
        let mut closed = Self {
            contacts: [0; MOST_CONTACTS],
            touching: Touching::default(),
            response: [[[0.0; MOST_STATES]; 2]; MOST_CONTACTS],
            restitution: [0.0; MOST_CONTACTS],
            turning: Pairs::default(),
            arriving: Pairs::default(),
            leaving: Pairs::default(),
        };
        let start = system.contacts(middle.start.t, &middle.start.y);
        let skin = SKIN * system.event_scale();
        for (contact, (gap, velocity)) in start.gap.iter().zip(&start.velocity).enumerate() {
            if gap + 0.5 * middle.h * velocity[NORMAL] <= skin {
                let slot = closed.count();
                closed.contacts[slot] = contact;
                closed.arriving[slot] = *velocity;
                closed.touching.count += 1;
            }
        }
        if closed.count() > 0 {
            closed.linearize(system, middle, free);
        }
        closed
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.touching.count
    }

    /// Laws, turning, responses and Delassus' matrix.
    fn linearize<D: Copy>(&mut self, system: &dyn Unilateral<Discrete = D>, middle: &Middle<'_>, free: &State) {
        let laws = system.contact_laws();
        let here = velocities(system, middle, free);
        let there = system.contacts(middle.start.t + middle.h, middle.of(&middle.end(free))).velocity;
        let still = velocities(system, middle, &[0.0; MOST_STATES]);
        let count = self.count();
        for (slot, &contact) in self.contacts.iter().enumerate().take(count) {
            let ContactLaw { restitution, friction } = laws[contact];
            self.restitution[slot] = restitution;
            self.turning[slot] = [NORMAL, TANGENTIAL].map(|part| there[contact][part] - here[contact][part]);
            self.touching.friction[slot] = friction;
            for part in self.parts(slot) {
                let mut response = [0.0; MOST_STATES];
                let n = middle.state().len();
                system.response(middle.t, middle.state(), contact, part, &mut response[..n]);
                let moved = velocities(system, middle, &response);
                for (other, &to) in self.contacts.iter().enumerate().take(count) {
                    for a in [NORMAL, TANGENTIAL] {
                        self.touching.delassus[other][a][slot][part] = moved[to][a] - still[to][a];
                    }
                }
                self.response[slot][part] = response;
            }
        }
    }

    /// The parts in which a contact may exert an impulse: without friction, its normal.
    fn parts(&self, slot: usize) -> std::ops::Range<usize> {
        NORMAL..if self.touching.friction[slot] > 0.0 { TANGENTIAL + 1 } else { TANGENTIAL }
    }

    /// How many responses were asked for.
    pub fn responses(&self) -> u64 {
        (0..self.count()).map(|slot| self.parts(slot).len() as u64).sum()
    }

    /// Sets what the laws hold for without impulses, when the step then has the velocities `free`.
    pub fn set_bias<D: Copy>(&mut self, system: &dyn Unilateral<Discrete = D>, middle: &Middle<'_>, free: &State) {
        let without = velocities(system, middle, free);
        for slot in 0..self.count() {
            let velocity = without[self.contacts[slot]];
            let [normal, tangential] = [NORMAL, TANGENTIAL].map(|part| velocity[part] + self.turning[slot][part]);
            self.leaving[slot] = [normal, tangential];
            self.touching.bias[slot] = [normal + self.restitution[slot] * self.arriving[slot][NORMAL], tangential];
        }
    }

    /// The impulses of the laws, sought first among those of contacts that do as with the impulses `before`. A wedge
    /// that friction locks may have none that return speed; it has some that return nothing.
    pub fn solve(&self, before: &Pairs) -> Option<Pairs> {
        self.touching.impulses(before).or_else(|| {
            let mut plastic = self.touching.clone();
            plastic.bias = self.leaving;
            plastic.impulses(before)
        })
    }

    /// The forces of the last step, in the order of these contacts.
    pub fn last(&self, middle: &Middle<'_>) -> Pairs {
        let mut forces = self.contacts.map(|contact| middle.start.discrete.forces[contact]);
        forces[self.count()..].fill([0.0; 2]);
        forces
    }

    /// The velocities of `free` with these impulses.
    pub fn after(&self, middle: &Middle<'_>, free: &State, impulses: &Pairs) -> State {
        let mut y = *free;
        for (responses, impulse) in self.response.iter().zip(impulses).take(self.count()) {
            for (response, impulse) in responses.iter().zip(impulse) {
                for i in middle.positions..2 * middle.positions {
                    y[i] += response[i] * impulse;
                }
            }
        }
        y
    }

    /// Takes back some of what lasting contacts are too deep at the end of the step, `y`. Where there is no way out,
    /// as in a jam, it stays.
    pub fn press_back<D: Copy>(
        &self,
        system: &dyn Unilateral<Discrete = D>,
        middle: &Middle<'_>,
        impulses: &Pairs,
        y: &mut State,
    ) {
        let gaps = system.contacts(middle.start.t + middle.h, middle.of(y)).gap;
        let mut places = self.touching.clone();
        places.friction = [0.0; MOST_CONTACTS];
        let mut deep = false;
        for slot in 0..places.count {
            let fastest = self.arriving[slot][NORMAL].abs().max(self.leaving[slot][NORMAL].abs());
            let spare = gaps[self.contacts[slot]] + SKIN * system.event_scale() + middle.h * fastest;
            // A contact that parts is not lifted, and nothing is pushed too deep.
            let lifted = spare < 0.0 && impulses[slot][NORMAL] > 0.0;
            places.bias[slot] = [if lifted { SHARE * spare } else { spare.max(0.0) }, 0.0];
            deep |= lifted;
        }
        let Some(shifts) = deep.then(|| places.impulses(impulses)).flatten() else {
            return;
        };
        for (response, shift) in self.response.iter().zip(shifts).take(places.count) {
            for i in 0..middle.positions {
                y[i] += response[NORMAL][middle.positions + i] * shift[NORMAL];
            }
        }
    }
}

/// Velocities in the contacts at the middle's positions with the velocities of `moving`.
fn velocities<D: Copy>(system: &dyn Unilateral<Discrete = D>, middle: &Middle<'_>, moving: &State) -> Pairs {
    let mut y = middle.y;
    let rates = middle.positions..2 * middle.positions;
    y[rates.clone()].copy_from_slice(&moving[rates]);
    system.contacts(middle.t, middle.of(&y)).velocity
}
