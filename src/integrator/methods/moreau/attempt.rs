//! One step of Moreau's midpoint rule.

use super::closed_contacts::ClosedContacts;
use super::midpoint::{Midpoint, State};
use crate::integrator::complementarity::NORMAL;
use crate::integrator::error::IntegrationError;
use crate::integrator::state::{StepPoint, first_invalid};
use crate::integrator::unilateral::{Impulses, Unilateral};

/// An attempted step.
pub struct AttemptedStep {
    /// State at the end of the step.
    pub y: State,
    /// Impulses of the contacts.
    pub impulses: Impulses,
    /// Number of evaluations of the accelerations.
    pub evaluations: u64,
}

/// Attempts a step of `h` [s] from `start`. `open` is the discrete state with every contact open.
pub fn attempt<D: Copy>(
    system: &dyn Unilateral<Discrete = D>,
    open: D,
    start: &StepPoint<Impulses>,
    h: f64,
) -> Result<AttemptedStep, IntegrationError> {
    let midpoint = Midpoint::new(system, open, start, h);
    let free = midpoint.free(system, &midpoint.halfway(&midpoint.free(system, &midpoint.y)));
    let closed = ClosedContacts::new(system, &midpoint, &free);
    let made = if closed.count() == 0 {
        AttemptedStep { y: midpoint.end(&free), impulses: Impulses::none(midpoint.t, midpoint.state()), evaluations: 2 }
    } else {
        through_contacts(system, &midpoint, closed, &free)?
    };
    match first_invalid(&made.y) {
        None => Ok(made),
        Some(component) => Err(IntegrationError::NotFinite { time: start.t, component }),
    }
}

/// A step with closed contacts; `free` holds the velocities at its end without contact impulses. The impulses are
/// solved twice: first with velocity-dependent forces from the free step, then with those from the first solution.
fn through_contacts<D: Copy>(
    system: &dyn Unilateral<Discrete = D>,
    midpoint: &Midpoint<'_, D>,
    mut closed: ClosedContacts,
    free: &State,
) -> Result<AttemptedStep, IntegrationError> {
    let count = closed.count();
    let lost = IntegrationError::Complementarity { time: midpoint.start.t, contacts: count };
    closed.set_bias(system, midpoint, free);
    let mut impulses = closed.solve(&closed.last(midpoint)).ok_or(lost)?;
    let mut y = closed.after(midpoint, free, &impulses);
    let better = midpoint.free(system, &midpoint.halfway(&y));
    closed.set_bias(system, midpoint, &better);
    if let Some(found) = closed.solve(&impulses) {
        impulses = found;
        y = closed.after(midpoint, &better, &impulses);
    }
    let end = midpoint.end(&y);
    let gaps = system.contacts(midpoint.start.t + midpoint.h, midpoint.of(&end)).gap;
    if let Some(contact) = closed.lost(&gaps) {
        return Err(IntegrationError::TooDeep { time: midpoint.start.t, contact });
    }
    let mut made = AttemptedStep {
        y: end,
        impulses: Impulses::none(midpoint.t, midpoint.state()),
        evaluations: 3 + closed.responses(),
    };
    for (impulse, &contact) in impulses.iter().zip(&closed.contacts).take(count) {
        made.impulses.forces[contact] = impulse.map(|impulse| impulse / midpoint.h);
        made.impulses.closed[contact] = impulse[NORMAL] > 0.0;
    }
    closed.correct_penetration(system, midpoint, &impulses, &gaps, &mut made.y);
    Ok(made)
}
