//! Shortens the last step.

use super::state::first_invalid;
use super::stepper::Stepper;
use super::system::System;

/// Shortens the last step so that it ends at `t`, by a new step.
pub fn truncate<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, t: f64) {
    let state = &mut stepper.state;
    if t >= state.front().t {
        return;
    }
    state.statistics = state.statistics_at(t);
    state.statistics.steps -= 1;
    state.cuts = 0;
    if t <= state.start().t {
        state.crossings = 0;
        state.take_back();
    } else {
        stepper.attempt_to(system, t);
        keep(stepper, system, t);
        stepper.evaluate_end_if_missing(system, t);
        stepper.commit(t);
    }
}

/// Replaces the end of the shorter step to `t` if it is invalid, because its error was not judged: by the state at `t`
/// in the longer step, or, if that is invalid, too, by linear interpolation between the longer step's ends, which are
/// valid.
fn keep<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, t: f64) {
    if first_invalid(&stepper.state.attempt().y).is_none() {
        return;
    }
    stepper.attempt_interpolated(system, t);
    if first_invalid(&stepper.state.attempt().y).is_some() {
        let state = &mut stepper.state;
        let share = (t - state.start().t) / (state.end().t - state.start().t);
        let (start, end, attempt) = state.all_ends();
        for ((y, start), end) in attempt.y.iter_mut().zip(&start.y).zip(&end.y) {
            *y = (1.0 - share) * start + share * end;
        }
    }
    if stepper.gives_end() {
        stepper.evaluate_end(system, t);
    }
}
