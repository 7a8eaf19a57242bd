//! One step from end to end.

use super::closed::Closed;
use crate::integrator::complementarity::NORMAL;
use crate::integrator::controller::lost_state;
use crate::integrator::error::IntegrationError;
use crate::integrator::memory::Front;
use crate::integrator::problem::Extent;
use crate::integrator::unilateral::{Impulses, Unilateral};

/// An attempted step.
pub struct Made<const N: usize> {
    /// State at its end.
    pub y: [f64; N],
    /// What the contacts did.
    pub impulses: Impulses<N>,
    /// Evaluations of accelerations.
    pub evaluations: u64,
}

/// The middle of a step: where velocities change.
pub struct Middle<'a, const N: usize> {
    /// Where the step starts.
    pub start: &'a Front<N, Impulses<N>>,
    /// [s] How long it is.
    pub h: f64,
    /// [s] Time in its middle.
    pub t: f64,
    /// Positions there, with the velocities of the start.
    pub y: [f64; N],
    /// Number of positions.
    pub positions: usize,
}

/// A step of `h` from `start`.
pub fn attempt<const N: usize, P>(
    problem: &P,
    start: &Front<N, Impulses<N>>,
    h: f64,
) -> Result<Made<N>, IntegrationError>
where
    P: Unilateral<N, Modes: Default> + ?Sized,
{
    let middle = Middle::new(problem, start, h);
    let free = middle.free(problem, &middle.halfway(&middle.free(problem, &middle.y)));
    let closed = Closed::new(problem, &middle, &free);
    let made = if closed.count() == 0 {
        Made { y: middle.end(&free), impulses: Impulses::none(middle.t, middle.y), evaluations: 2 }
    } else {
        through_contacts(problem, &middle, closed, &free)?
    };
    match lost_state(problem, &made.y) {
        None => Ok(made),
        Some(component) => Err(IntegrationError::NotFinite { time: start.t, component }),
    }
}

/// A step with closed contacts, which would have the velocities `free` without them. Its impulses are found twice: with
/// the velocities of the free step for what depends on velocity, and with those that came of it.
fn through_contacts<const N: usize, P>(
    problem: &P,
    middle: &Middle<'_, N>,
    mut closed: Closed<N>,
    free: &[f64; N],
) -> Result<Made<N>, IntegrationError>
where
    P: Unilateral<N, Modes: Default> + ?Sized,
{
    let count = closed.count();
    let lost = IntegrationError::Complementarity { time: middle.start.t, contacts: count };
    closed.set_bias(problem, middle, free);
    let mut impulses = closed.solve(&closed.last(middle)).ok_or(lost)?;
    let mut y = closed.after(middle, free, &impulses);
    let better = middle.free(problem, &middle.halfway(&y));
    closed.set_bias(problem, middle, &better);
    if let Some(found) = closed.solve(&impulses) {
        impulses = found;
        y = closed.after(middle, &better, &impulses);
    }
    let mut made =
        Made { y: middle.end(&y), impulses: Impulses::none(middle.t, middle.y), evaluations: 3 + closed.responses() };
    for (impulse, &contact) in impulses.iter().zip(&closed.contacts).take(count) {
        made.impulses.forces[contact] = impulse.map(|impulse| impulse / middle.h);
        made.impulses.closed[contact] = impulse[NORMAL] > 0.0;
    }
    closed.press_back(problem, middle, &impulses, &mut made.y);
    Ok(made)
}

impl<'a, const N: usize> Middle<'a, N> {
    fn new<P>(problem: &P, start: &'a Front<N, Impulses<N>>, h: f64) -> Self
    where
        P: Unilateral<N> + ?Sized,
    {
        let positions = Extent::of(problem).positions;
        let mut y = start.y;
        for (position, velocity) in y.iter_mut().zip(&start.y[positions..2 * positions]) {
            *position += 0.5 * h * velocity;
        }
        Self { start, h, t: start.t + 0.5 * h, y, positions }
    }

    /// The middle's positions with the velocities that the step ends with when no contact acts and forces are those at
    /// the velocities of `moving`.
    fn free<P>(&self, problem: &P, moving: &[f64; N]) -> [f64; N]
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let mut rates = [0.0; N];
        problem.rates(&P::Modes::default(), self.t, moving, &mut rates);
        let mut y = self.y;
        for i in self.positions..2 * self.positions {
            y[i] += self.h * rates[i];
        }
        y
    }

    /// The middle's positions with velocities half-way between the start's and those of `last`.
    fn halfway(&self, last: &[f64; N]) -> [f64; N] {
        let mut y = self.y;
        for i in self.positions..2 * self.positions {
            y[i] = 0.5 * (y[i] + last[i]);
        }
        y
    }

    /// Where the step ends with the velocities of `y`.
    pub fn end(&self, y: &[f64; N]) -> [f64; N] {
        let mut end = *y;
        for i in 0..self.positions {
            end[i] += 0.5 * self.h * y[self.positions + i];
        }
        end
    }
}
