//! Step acceptance: shortens a step until its error is tolerable, and ends it at derivative discontinuities.

use super::derivative_discontinuity as discontinuity;
use super::error::IntegrationError;
use super::method::NOT_CONVERGED;
use super::state::{CREEPING_CUTS, LEAST_ERROR, first_invalid};
use super::step_control as control;
use super::stepper::Stepper;
use super::system::System;

/// Share of the tolerance for steps during an impact: the flight after it and every later impact amplify its errors.
const IMPACT_SHARE: f64 = 0.1;
/// A method that [keeps the length](super::method::Properties::keeps_length) of steps does not lengthen the next step if the
/// error is above this.
const STEADY_ERROR: f64 = 1e-2;
/// Maximum number of times that one step is cut short at a derivative discontinuity.
const MAX_CUTS: usize = 6;
/// After this many failed attempts at one step another kind of the method takes over, if it has one. This happens long
/// before the step reaches the rounding of time.
const MAX_FAILURES: usize = 8;
/// A failed attempt with a larger error is not used to predict the next attempt. Its accelerations belong to states
/// that no motion reaches, and states predicted from them can be worse: velocities enter accelerations as squares, so
/// that corrector rounds that start far from the solution diverge, however short the step is. An attempt with constant
/// accelerations improves as it becomes shorter.
const MAX_PREDICTING_ERROR: f64 = 1e4;
/// [roundings of time] A step is not cut at a derivative discontinuity if it would be shorter than this.
const MIN_CUT: f64 = 1e3;

/// The share of the next step at which a derivative discontinuity is predicted; `None` if none is predicted or the last
/// step was not cut at one.
pub fn predicted_discontinuity<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>) -> Option<f64> {
    let state = &mut stepper.state;
    let is_cut = (1..CREEPING_CUTS).contains(&state.cuts) && state.crossings == 0 && state.front().t > state.start().t;
    if !is_cut {
        return None;
    }
    let h = state.step.min(system.longest_step());
    discontinuity::predicted(system, state.start(), state.front(), h)
}

/// Attempts a step until its error is tolerable and returns the length [s] of that step. The first attempt ends at the
/// derivative discontinuity predicted at the share `predicted`. If attempts keep failing, the method's other kinds take
/// turns.
///
/// # Errors
/// `StepUnderflow` if every kind has come down to a step that does not move time.
pub fn accepted<D: Copy>(
    stepper: &mut Stepper<D>,
    system: &dyn System<Discrete = D>,
    predicted: Option<f64>,
) -> Result<f64, IntegrationError> {
    let time = stepper.state.start().t;
    // The step size may have become too short to move time under forces that no longer act.
    let resolution = time.next_up() - time;
    let adaptive = stepper.properties.adaptive;
    let first = if adaptive { stepper.state.step.max(resolution) } else { stepper.settings.fixed_step };
    let own = stepper.method.kind();
    let others = stepper.properties.others;
    let failures = if others.is_empty() { usize::MAX } else { MAX_FAILURES };
    let mut shortest = match fitted(stepper, system, first, predicted, failures) {
        Ok(h) => return Ok(h),
        Err(shortest) => shortest,
    };
    let in_turn = others.iter().map(|other| (*other, Some(first), MAX_FAILURES));
    // At last every kind continues from the shortest length reached, until a step does not move time.
    let to_the_end = std::iter::once(&own).chain(others).map(|kind| (*kind, None, usize::MAX));
    for (kind, wanted, failures) in in_turn.chain(to_the_end.filter(|_| !others.is_empty())) {
        stepper.set_kind(kind);
        let wanted = wanted.map_or(shortest, |wanted: f64| wanted.max(shortest));
        match fitted(stepper, system, wanted, None, failures) {
            Ok(h) => {
                stepper.with_method(|method| method.hand_over());
                return Ok(h);
            }
            Err(reached) => shortest = shortest.min(reached),
        }
    }
    stepper.attempt(system, shortest);
    let component = control::worst_component(&stepper.attempt, system);
    Err(IntegrationError::StepUnderflow { time, step: shortest, component })
}

/// Attempts a step of the length `wanted` [s] and shorter ones until the error is tolerable; rates and event functions
/// at the end of the accepted step are then known. Returns the length [s] of that step. A step that fails because of a
/// derivative discontinuity is cut there, and the next step is as long as this one should have been; so is a step with
/// a discontinuity predicted at the share `predicted`.
///
/// # Errors
/// The length [s] that the next attempt would have, after `failures` failed attempts or if the step does not
/// move time.
fn fitted<D: Copy>(
    stepper: &mut Stepper<D>,
    system: &dyn System<Discrete = D>,
    mut wanted: f64,
    predicted: Option<f64>,
    failures: usize,
) -> Result<f64, f64> {
    let start = stepper.state.start();
    let time = start.t;
    let resolution = time.next_up() - time;
    let impact_share = if time < start.impact_end { IMPACT_SHARE } else { 1.0 };
    let nominal = impact_share * stepper.properties.error_share * stepper.settings.tolerance;
    let (mut first, mut cuts, mut cut) = (None, 0, false);
    let creeping = stepper.state.cuts >= CREEPING_CUTS;
    let mut failed = None;
    if let Some(share) = predicted.filter(|share| share * wanted > MIN_CUT * resolution) {
        (first, cuts, cut) = (Some(wanted), 1, true);
        wanted = share * wanted.min(system.longest_step());
    }
    for _ in 0..failures {
        // The step is the difference of two representable times, so that rounding does not accumulate.
        let h = time + wanted.min(system.longest_step()) - time;
        if h <= 0.0 {
            break;
        }
        stepper.attempt(system, h);
        let looseness = stepper.looseness();
        let tolerance = nominal * looseness;
        let (full, keeps_length) = (stepper.properties.error_power, stepper.properties.keeps_length);
        let error = judged(stepper, system, h, tolerance);
        let state = &mut stepper.state;
        if error <= 1.0 {
            let growth = || control::growth(error, state.last_error, full);
            state.step = match first {
                Some(first) if cut => first,
                Some(_) => h * growth().min(1.0),
                None if keeps_length && error > STEADY_ERROR => wanted,
                None => h * growth(),
            };
            state.last_error = error.max(LEAST_ERROR);
            state.account.error += error * tolerance;
            state.account.hits += u64::from(error * looseness > 1.0);
            if let Some(deadline) = &stepper.deadline {
                let work = state.work();
                deadline.end_step(&mut state.account, h, work, full);
            }
            state.cuts = match (cut, failed) {
                (true, _) => state.cuts + 1,
                (false, Some(_)) if creeping => CREEPING_CUTS,
                _ => 0,
            };
            return Ok(h);
        }
        first.get_or_insert(h);
        state.statistics.rejected += 1;
        if error < MAX_PREDICTING_ERROR {
            // The next attempt is shorter and covers the same interval.
            stepper.predict_from_attempt(time + h);
        } else {
            stepper.method.forget();
        }
        let state = &stepper.state;
        // A discontinuity on the way to where Newton's method has stopped is none of the motion's: the next step would
        // fail as this one did.
        let searches = error < NOT_CONVERGED && cuts < MAX_CUTS && !creeping;
        let share = if searches {
            discontinuity::first(system, state.start(), &stepper.events, h, &state.attempt().y)
        } else {
            None
        };
        // A discontinuity this close to the start belongs to the start.
        let share = share.filter(|share| share * h > MIN_CUT * resolution);
        cut = share.is_some();
        cuts += usize::from(cut);
        let power = failed.map_or(full, |before| control::error_power([before, (h, error)], full));
        failed = Some((h, error));
        wanted = wanted.min(h) * share.unwrap_or_else(|| control::shrinkage(error, power));
    }
    Err(wanted)
}

/// The error of the attempted step of length `h` [s] over the tolerance. If it is tolerable, rates and event functions
/// at the end are computed; if these are invalid in an adaptive method, the error is infinite.
fn judged<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, h: f64, tolerance: f64) -> f64 {
    if first_invalid(&stepper.state.attempt().y).is_some() {
        return f64::INFINITY;
    }
    let start = stepper.state.start();
    let t = start.t + h;
    let Stepper { attempt, layout, properties, .. } = &*stepper;
    let error = control::norm(attempt, &start.y, system.scales(), *layout, properties.coarse, tolerance);
    if error <= 1.0 {
        stepper.evaluate_end_if_missing(system, t);
        if stepper.properties.adaptive && first_invalid(&stepper.state.attempt().rates).is_some() {
            return f64::INFINITY;
        }
    }
    error
}
