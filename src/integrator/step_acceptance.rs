//! How long a step is: as its error and its derivative discontinuities allow.

use super::derivative_discontinuity as discontinuity;
use super::error::IntegrationError;
use super::state::{CREEPING, lost_state};
use super::step_control as control;
use super::stepper::Stepper;
use super::system::System;

/// The flight after an impact, and every impact after that, make its errors larger than those of a contact that stays:
/// only this share of what else is tolerable is for them.
const IMPACT_SHARE: f64 = 0.1;
/// A step that is predicted from the last is not made longer for an error above this: one that is as long is predicted with
/// less work, and can begin before the error is known.
const STEADY: f64 = 1e-2;
/// Most times that one step is cut short at a derivative discontinuity.
const CUTS: usize = 6;
/// After so many failed attempts at one step another of the method's kinds takes over, if there is one: long before a step
/// comes down to a rounding of time.
const TOO_MANY: usize = 8;
/// A failed attempt with a larger error than this predicts nothing. Its accelerations are those of states that no motion
/// comes to, and states predicted from them can be worse: velocities enter accelerations as squares, so that rounds of
/// correction that begin far off run away, however short the step is. Accelerations that stay as they are at the start
/// lead to an attempt that is as good as it is short.
const PREDICTABLE: f64 = 1e4;
/// [roundings of time] No derivative discontinuity makes a step shorter than this.
const SHORTEST_CUT: f64 = 1e3;

/// The share of the next step at which a derivative discontinuity lies, where one is to be looked for.
pub fn foreseen_discontinuity<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>) -> Option<f64> {
    let state = &mut stepper.state;
    let goes_on = (1..CREEPING).contains(&state.cuts) && state.crossings == 0 && state.front().t > state.start().t;
    if !goes_on {
        return None;
    }
    let h = state.step.min(system.longest_step());
    discontinuity::foreseen(system, state.start(), state.front(), h)
}

/// Attempts until the error is tolerable, and tells how long that step is. A step that fails time and again goes from one
/// of the method's kinds to the next; only where each of them has come down to a step that does not move time, there
/// is none. A derivative discontinuity `foreseen` at a share of the step is where the first attempt ends.
pub fn accepted<D: Copy>(
    stepper: &mut Stepper<D>,
    system: &dyn System<Discrete = D>,
    foreseen: Option<f64>,
) -> Result<f64, IntegrationError> {
    let time = stepper.state.start().t;
    // Forces that are gone may have left a step that no longer moves time.
    let least = time.next_up() - time;
    let adaptive = stepper.properties.adaptive;
    let first = if adaptive { stepper.state.step.max(least) } else { stepper.settings.fixed_step };
    let own = stepper.method.kind();
    let others = stepper.properties.others;
    let failures = if others.is_empty() { usize::MAX } else { TOO_MANY };
    let mut shortest = match fitted(stepper, system, first, foreseen, failures) {
        Ok(h) => return Ok(h),
        Err(shortest) => shortest,
    };
    let in_turn = others.iter().map(|other| (*other, first, TOO_MANY));
    let to_the_end = std::iter::once(&own).chain(others).map(|kind| (*kind, 0.0, usize::MAX));
    for (kind, wanted, failures) in in_turn.chain(to_the_end.filter(|_| !others.is_empty())) {
        stepper.set_kind(kind);
        match fitted(stepper, system, wanted.max(shortest), None, failures) {
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

/// Attempts a step that is as long as `wanted`, and shorter ones, until the error is tolerable: tells how long that step
/// is, or, after so many `failures` or where time does not move, how long the next attempt would be. The end of an
/// accepted step is looked at. One that fails because a derivative discontinuity lies in it ends there, and the next is as
/// long as this one should have been; so does one with a discontinuity `foreseen` at that share.
fn fitted<D: Copy>(
    stepper: &mut Stepper<D>,
    system: &dyn System<Discrete = D>,
    mut wanted: f64,
    foreseen: Option<f64>,
    failures: usize,
) -> Result<f64, f64> {
    let start = stepper.state.start();
    let time = start.t;
    let least = time.next_up() - time;
    let of_impact = if time < start.impact_end { IMPACT_SHARE } else { 1.0 };
    let tolerance = of_impact * stepper.properties.error_share * stepper.settings.tolerance;
    let (mut first, mut cuts, mut cut) = (None, 0, false);
    let creeping = stepper.state.cuts >= CREEPING;
    let mut failed = None;
    if let Some(share) = foreseen.filter(|share| share * wanted > SHORTEST_CUT * least) {
        (first, cuts, cut) = (Some(wanted), 1, true);
        wanted = share * wanted.min(system.longest_step());
    }
    for _ in 0..failures {
        // The step is what time really moves by: nothing drifts from its rounding.
        let h = time + wanted.min(system.longest_step()) - time;
        if h <= 0.0 {
            break;
        }
        stepper.attempt(system, h);
        let (full, predicts) = (stepper.properties.error_power, stepper.properties.predicts);
        let error = judged(stepper, system, h, tolerance);
        let state = &mut stepper.state;
        if error <= 1.0 {
            let growth = || control::growth(error, state.last_error, full);
            state.step = match first {
                Some(first) if cut => first,
                Some(_) => h * growth().min(1.0),
                None if predicts && error > STEADY => wanted,
                None => h * growth(),
            };
            state.last_error = error.max(1e-4);
            state.cuts = match (cut, failed) {
                (true, _) => state.cuts + 1,
                (false, Some(_)) if creeping => CREEPING,
                _ => 0,
            };
            return Ok(h);
        }
        first.get_or_insert(h);
        state.statistics.rejected += 1;
        if error < PREDICTABLE {
            // A shorter one goes over the same ground.
            stepper.predict_from_attempt(time + h);
        } else {
            stepper.method.forget();
        }
        let state = &stepper.state;
        let look = error.is_finite() && cuts < CUTS && !creeping;
        let share = if look {
            discontinuity::first(system, state.start(), &stepper.events, h, &state.attempt().y)
        } else {
            None
        };
        // A discontinuity that close is where the step starts.
        let share = share.filter(|share| share * h > SHORTEST_CUT * least);
        cut = share.is_some();
        cuts += usize::from(cut);
        let power = failed.map_or(full, |before| control::error_power([before, (h, error)], full));
        failed = Some((h, error));
        wanted = wanted.min(h) * share.unwrap_or_else(|| control::shrinkage(error, power));
    }
    Err(wanted)
}

/// The error of the attempted step of `h` over the tolerance; of one that is tolerable the end is looked at. One that is
/// lost there is infinitely wrong, unless no shorter one is to be attempted.
fn judged<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, h: f64, tolerance: f64) -> f64 {
    if lost_state(&stepper.state.attempt().y).is_some() {
        return f64::INFINITY;
    }
    let start = stepper.state.start();
    let t = start.t + h;
    let weighted = stepper.layout.weighted;
    let error =
        control::norm(&stepper.attempt, &start.y, &system.scales()[..weighted], stepper.properties.coarse, tolerance);
    if error <= 1.0 {
        stepper.look_at_end_if_due(system, t);
        if stepper.properties.adaptive && lost_state(&stepper.state.attempt().rates).is_some() {
            return f64::INFINITY;
        }
    }
    error
}
