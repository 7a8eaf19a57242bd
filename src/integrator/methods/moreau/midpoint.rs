//! The midpoint of a step, where velocities change.

use crate::integrator::state::StepPoint;
use crate::integrator::unilateral::{Impulses, MAX_RIGID_CONTACT_STATES, Unilateral, padded};

/// A state, padded with zeros.
pub type State = [f64; MAX_RIGID_CONTACT_STATES];

/// The midpoint of a step.
pub struct Midpoint<'a, D> {
    /// The discrete state with every contact open.
    pub open: D,
    /// Start of the step.
    pub start: &'a StepPoint<Impulses>,
    /// [s] Length of the step.
    pub h: f64,
    /// [s] Time at the midpoint.
    pub t: f64,
    /// Positions at the midpoint, with the velocities of the start.
    pub y: State,
    /// Number of positions.
    pub positions: usize,
}

impl<'a, D: Copy> Midpoint<'a, D> {
    /// The midpoint of a step of `h` [s] from `start`.
    pub fn new(system: &dyn Unilateral<Discrete = D>, open: D, start: &'a StepPoint<Impulses>, h: f64) -> Self {
        let positions = system.layout().positions;
        let mut y = padded(&start.y);
        for (position, velocity) in y.iter_mut().zip(&start.y[positions..2 * positions]) {
            *position += 0.5 * h * velocity;
        }
        Self { open, start, h, t: start.t + 0.5 * h, y, positions }
    }

    /// The positions of the midpoint with the velocities at the end of a step without contact impulses; forces are
    /// evaluated at the velocities of `moving`.
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

    /// The positions of the midpoint with the velocities of the start.
    pub fn state(&self) -> &[f64] {
        self.of(&self.y)
    }

    /// The part of `y` that holds states.
    pub fn of<'y>(&self, y: &'y State) -> &'y [f64] {
        &y[..self.states()]
    }

    /// The positions of the midpoint with the mean of the start's velocities and those of `last`.
    pub fn halfway(&self, last: &State) -> State {
        let mut y = self.y;
        for i in self.positions..2 * self.positions {
            y[i] = 0.5 * (y[i] + last[i]);
        }
        y
    }

    /// The end of the step if its velocities are those of `y`.
    pub fn end(&self, y: &State) -> State {
        let mut end = *y;
        for i in 0..self.positions {
            end[i] += 0.5 * self.h * y[self.positions + i];
        }
        end
    }
}
