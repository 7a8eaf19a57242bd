//! One step from end to end.

use super::closed::Closed;
use super::middle::{Middle, State};
use crate::integrator::complementarity::NORMAL;
use crate::integrator::error::IntegrationError;
use crate::integrator::state::{StepPoint, lost_state};
use crate::integrator::unilateral::{Impulses, Unilateral};

/// An attempted step.
pub struct Made {
    /// State at its end.
    pub y: State,
    /// What the contacts did.
    pub impulses: Impulses,
    /// Evaluations of accelerations.
    pub evaluations: u64,
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
