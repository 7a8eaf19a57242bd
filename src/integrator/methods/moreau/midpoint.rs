//! The middle of a step, where velocities change.

use crate::integrator::state::StepPoint;
use crate::integrator::unilateral::{Impulses, MAX_RIGID_CONTACT_STATES, Unilateral, padded};

/// A state, and zeros.
pub type State = [f64; MAX_RIGID_CONTACT_STATES];

/// The middle of a step: where velocities change.
pub struct Midpoint<'a, D> {
    /// The discrete state with every contact open.
    pub open: D,
    /// Where the step starts.
    pub start: &'a StepPoint<Impulses>,
    /// [s] How long it is.
    pub h: f64,
    /// [s] Time in its middle.
    pub t: f64,
    /// Positions there, with the velocities of the start.
    pub y: State,
    /// Number of positions.
    pub positions: usize,
}

impl<'a, D: Copy> Midpoint<'a, D> {
    /// Of a step of `h` from `start`.
    pub fn new(system: &dyn Unilateral<Discrete = D>, open: D, start: &'a StepPoint<Impulses>, h: f64) -> Self {
        let positions = system.layout().positions;
        let mut y = padded(&start.y);
        for (position, velocity) in y.iter_mut().zip(&start.y[positions..2 * positions]) {
            *position += 0.5 * h * velocity;
        }
        Self { open, start, h, t: start.t + 0.5 * h, y, positions }
    }

    /// The middle's positions with the velocities that the step ends with when no contact acts and forces are those at
    /// the velocities of `moving`.
    pub fn free(&self, system: &dyn Unilateral<Discrete = D>, moving: &State) -> State {
        let n = self.states();
        let mut rates = [0.0; MAX_RIGID_CONTACT_STATES];
        system.rates(&self.open, self.t, &moving[..n], &mut rates[..n]);
        let mut y = self.y;
        for i in self.positions..2 * self.positions {
            y[i] += self.h * rates[i];
        }
        y
    }

    fn states(&self) -> usize {
        self.start.y.len()
    }

    /// The middle's positions with the velocities of the start.
    pub fn state(&self) -> &[f64] {
        self.of(&self.y)
    }

    /// As much of an array as there are states.
    pub fn of<'y>(&self, y: &'y State) -> &'y [f64] {
        &y[..self.states()]
    }

    /// The middle's positions with velocities half-way between the start's and those of `last`.
    pub fn halfway(&self, last: &State) -> State {
        let mut y = self.y;
        for i in self.positions..2 * self.positions {
            y[i] = 0.5 * (y[i] + last[i]);
        }
        y
    }

    /// Where the step ends with the velocities of `y`.
    pub fn end(&self, y: &State) -> State {
        let mut end = *y;
        for i in 0..self.positions {
            end[i] += 0.5 * self.h * y[self.positions + i];
        }
        end
    }
}
