//! One step from end to end.

use super::closed::Closed;
use crate::integrator::complementarity::NORMAL;
use crate::integrator::error::IntegrationError;
use crate::integrator::state::{StepPoint, lost_state};
use crate::integrator::unilateral::{Impulses, MOST_STATES, Unilateral, padded};

/// A state, and zeros.
pub type State = [f64; MOST_STATES];

/// An attempted step.
pub struct Made {
    /// State at its end.
    pub y: State,
    /// What the contacts did.
    pub impulses: Impulses,
    /// Evaluations of accelerations.
    pub evaluations: u64,
}

/// The middle of a step: where velocities change.
pub struct Middle<'a> {
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

/// A step of `h` from `start`.
pub fn attempt<D: Copy + Default>(
    system: &dyn Unilateral<Discrete = D>,
    start: &StepPoint<Impulses>,
    h: f64,
) -> Result<Made, IntegrationError> {
    let middle = Middle::new(system, start, h);
    let free = middle.free(system, &middle.halfway(&middle.free(system, &middle.y)));
    let closed = Closed::new(system, &middle, &free);
    let made = if closed.count() == 0 {
        Made { y: middle.end(&free), impulses: Impulses::none(middle.t, middle.state()), evaluations: 2 }
    } else {
        through_contacts(system, &middle, closed, &free)?
    };
    match lost_state(&made.y) {
        None => Ok(made),
        Some(component) => Err(IntegrationError::NotFinite { time: start.t, component }),
    }
}

/// A step with closed contacts, which would have the velocities `free` without them. Its impulses are found twice: with
/// the velocities of the free step for what depends on velocity, and with those that came of it.
fn through_contacts<D: Copy + Default>(
    system: &dyn Unilateral<Discrete = D>,
    middle: &Middle<'_>,
    mut closed: Closed,
    free: &State,
) -> Result<Made, IntegrationError> {
    let count = closed.count();
    let lost = IntegrationError::Complementarity { time: middle.start.t, contacts: count };
    closed.set_bias(system, middle, free);
    let mut impulses = closed.solve(&closed.last(middle)).ok_or(lost)?;
    let mut y = closed.after(middle, free, &impulses);
    let better = middle.free(system, &middle.halfway(&y));
    closed.set_bias(system, middle, &better);
    if let Some(found) = closed.solve(&impulses) {
        impulses = found;
        y = closed.after(middle, &better, &impulses);
    }
    let mut made = Made {
        y: middle.end(&y),
        impulses: Impulses::none(middle.t, middle.state()),
        evaluations: 3 + closed.responses(),
    };
    for (impulse, &contact) in impulses.iter().zip(&closed.contacts).take(count) {
        made.impulses.forces[contact] = impulse.map(|impulse| impulse / middle.h);
        made.impulses.closed[contact] = impulse[NORMAL] > 0.0;
    }
    closed.press_back(system, middle, &impulses, &mut made.y);
    Ok(made)
}

impl<'a> Middle<'a> {
    fn new<D: Copy>(system: &dyn Unilateral<Discrete = D>, start: &'a StepPoint<Impulses>, h: f64) -> Self {
        let positions = system.extent().positions;
        let mut y = padded(&start.y);
        for (position, velocity) in y.iter_mut().zip(&start.y[positions..2 * positions]) {
            *position += 0.5 * h * velocity;
        }
        Self { start, h, t: start.t + 0.5 * h, y, positions }
    }

    /// The middle's positions with the velocities that the step ends with when no contact acts and forces are those at
    /// the velocities of `moving`.
    fn free<D: Copy + Default>(&self, system: &dyn Unilateral<Discrete = D>, moving: &State) -> State {
        let n = self.states();
        let mut rates = [0.0; MOST_STATES];
        system.rates(&D::default(), self.t, &moving[..n], &mut rates[..n]);
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
    fn halfway(&self, last: &State) -> State {
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
