//! Event location in an accepted step: which event comes first, and when; the step that ends at it, and its crossing.
//!
//! An event function that is positive before the step and negative after it has fallen through zero. One that is
//! positive at both ends may have dipped below zero in between, and one that rises from zero at the start may have
//! fallen again. The rate of the event function at both ends tells these cases apart.

use super::deadline::stretch;
use super::dense_output::Step;
use super::error::IntegrationError;
use super::root;
use super::state::StepPoint;
use super::stepper::Stepper;
use super::system::{EventFunction, EventFunctions, MAX_EVENTS, MAX_STATES, System, Triggered};

/// [share of the step] Resolution of the time of a fall on the interpolant.
const RESOLUTION: f64 = 1e-13;
/// Maximum number of events without time passing.
pub const MAX_EVENTS_AT_ONE_TIME: usize = 64;
/// Maximum number of attempts at a step that ends at an event; each brings the event function closer to zero.
const MAX_LANDINGS: usize = 3;
/// Share of an impact's duration for the first step into it.
const FIRST_IMPACT_STEP: f64 = 0.03;
/// A step ends at an event if the event function is within this share of a tolerable error of zero.
const LANDING_TOLERANCE: f64 = 0.1;

/// Crosses the events whose functions are at or below zero and falling where the next step starts.
///
/// # Errors
/// `DeadEnd` if one of them is a dead end, `EventsAccumulate` if [`MAX_EVENTS_AT_ONE_TIME`] events do not settle it.
pub fn settle<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>) -> Result<(), IntegrationError> {
    let count = system.event_count();
    if count == 0 {
        return Ok(());
    }
    let near = LANDING_TOLERANCE * system.event_scale();
    let events = &stepper.events;
    let ended = |i: &usize| events[*i].value <= near && events[*i].rate < 0.0 && system.is_dead_end(*i);
    if let Some(event) = (0..count).find(ended) {
        return Err(IntegrationError::DeadEnd { time: stepper.state.front().t, event });
    }
    for _ in 0..MAX_EVENTS_AT_ONE_TIME {
        let Some(event) = (0..count).find(|&i| has_fallen(&stepper.events[i])) else {
            return Ok(());
        };
        cross_with(stepper, system, event, 0.0);
    }
    Err(IntegrationError::events_accumulate(stepper.state.front().t, &stepper.events[..count]))
}

/// Crosses the events whose functions are below zero at the front, for a method that does not locate events.
pub fn notice<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>) {
    let events = &stepper.events;
    let triggered: Triggered = std::array::from_fn(|i| i < system.event_count() && events[i].value < 0.0);
    if triggered.contains(&true) {
        cross(stepper, system, &triggered);
    }
}

/// The first event in the last step: its share of the step and its event function. `before` are the event functions
/// where the step started.
pub fn first<D: Copy>(
    stepper: &Stepper<D>,
    system: &dyn System<Discrete = D>,
    before: &EventFunctions,
) -> Option<(f64, usize)> {
    let step = stepper.state.last_step(stepper.layout);
    let discrete = &stepper.state.start().discrete;
    (0..system.event_count())
        .filter_map(|i| {
            let inside = |s: f64| inside(system, discrete, &step, s)[i];
            fall(before[i], stepper.events[i], step.h, inside).map(|share| (share, i))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The event functions at the share `s` of a step, on its interpolant.
fn inside<D: Copy>(system: &dyn System<Discrete = D>, discrete: &D, step: &Step<'_>, s: f64) -> EventFunctions {
    let mut y = [0.0; MAX_STATES];
    let y = &mut y[..step.layout.states];
    let mut functions = [EventFunction::default(); MAX_EVENTS];
    step.state(s, None, y);
    system.event_functions(discrete, step.t + s * step.h, y, &mut functions);
    functions
}

/// Repeats the last step, of length `h`, so that it ends at the `event` found at `share` of it, and crosses the event.
/// An event that is a dead end is not crossed.
pub fn land<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, h: f64, share: f64, event: usize) {
    let start = stepper.state.start().t;
    // The longer step no longer counts.
    stepper.state.statistics.steps -= 1;
    let tolerance = stepper.allowed_looseness() * stepper.settings.tolerance;
    let close = LANDING_TOLERANCE * tolerance * system.event_scale();
    let mut t = start + share * h;
    for landing in 1..=MAX_LANDINGS {
        if t <= start {
            stepper.state.take_back();
            stepper.refresh(system);
            break;
        }
        stepper.attempt_to(system, t);
        if !stepper.gives_end() {
            let (start, end) = stepper.state.ends();
            system.event_functions(&start.discrete, t, &end.y, &mut stepper.attempt.events);
        }
        let EventFunction { value, rate } = stepper.attempt.events[event];
        let better = t - value / rate;
        let useful = rate < 0.0 && better < start + h && better != t;
        if landing == MAX_LANDINGS || value.abs() <= close || !useful {
            stepper.evaluate_end_if_missing(system, t);
            stepper.commit(t);
            break;
        }
        t = better;
    }
    if !system.is_dead_end(event) {
        cross_with(stepper, system, event, close);
    }
}

/// Crosses `event` at the front together with all events whose functions are falling and at most `close` above zero.
fn cross_with<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, event: usize, close: f64) {
    let events = &stepper.events;
    let with = |i: usize| i == event || (events[i].value <= close && events[i].rate < 0.0);
    let triggered: Triggered = std::array::from_fn(|i| i < system.event_count() && with(i));
    cross(stepper, system, &triggered);
}

fn cross<D: Copy>(stepper: &mut Stepper<D>, system: &dyn System<Discrete = D>, triggered: &Triggered) {
    let (power, looseness) = (stepper.properties.error_power, stepper.allowed_looseness());
    let state = &mut stepper.state;
    let count = triggered.iter().map(|&triggered| u64::from(triggered)).sum::<u64>();
    state.crossings += count;
    state.statistics.events += count;
    let StepPoint { t, y, discrete, impact_end, .. } = state.front_mut();
    let reset = system.reset(discrete, *t, y, triggered);
    *discrete = reset.discrete;
    if let Some(duration) = reset.impact {
        *impact_end = impact_end.max(*t + duration.min(system.longest_step()));
        let share = FIRST_IMPACT_STEP * stretch(looseness, power);
        state.step = state.step.min(share.min(1.0) * duration);
    }
    stepper.refresh(system);
}

fn has_fallen(function: &EventFunction) -> bool {
    function.value <= 0.0 && function.rate < 0.0
}

/// The share at which one event function first falls below zero.
fn fall(before: EventFunction, after: EventFunction, h: f64, inside: impl Fn(f64) -> EventFunction) -> Option<f64> {
    let value = |s: f64| inside(s).value;
    if after.value < 0.0 {
        if before.value > 0.0 {
            return Some(root::falling(0.0, 1.0, before.value, after.value, RESOLUTION, value));
        }
        // The function starts at zero, or slightly below because it was crossed together with another event.
        if before.rate <= 0.0 {
            return Some(0.0);
        }
        if after.rate >= 0.0 {
            return None; // it rises from a value below zero
        }
        let top = root::falling(0.0, 1.0, before.rate, after.rate, RESOLUTION, |s| inside(s).rate);
        let highest = value(top);
        return if highest > 0.0 {
            Some(root::falling(top, 1.0, highest, after.value, RESOLUTION, value))
        } else {
            Some(top)
        };
    }
    let dips = before.rate < 0.0 && after.rate > 0.0;
    // No cubic with these end values and rates falls further than `depth` below its ends.
    let depth = 0.5 * h * before.rate.abs().max(after.rate);
    if !dips || before.value.min(after.value) > depth || before.value <= 0.0 {
        return None;
    }
    let bottom = root::falling(0.0, 1.0, -before.rate, -after.rate, RESOLUTION, |s| -inside(s).rate);
    let lowest = value(bottom);
    (lowest < 0.0).then(|| root::falling(0.0, bottom, before.value, lowest, RESOLUTION, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a function of the share of a step, and its rate, falls.
    fn falls(of: impl Fn(f64) -> [f64; 2]) -> Option<f64> {
        let function = |s: f64| {
            let [value, rate] = of(s);
            EventFunction { value, rate }
        };
        fall(function(0.0), function(1.0), 1.0, function)
    }

    #[test]
    fn what_was_crossed_a_little_early_is_not_crossed_again_on_its_way_up() {
        // Two contacts that opened and closed together at a tolerable distance from zero changed places for ever.
        assert_eq!(falls(|s| [-1e-3 + 1e-4 * s, 1e-4]), None);
    }

    #[test]
    fn what_turns_back_below_zero_falls_where_it_turns() {
        let share = falls(|s| [-1e-3 + 1e-4 * (s - s * s), 1e-4 * (1.0 - 2.0 * s)]);
        assert!(share.is_some_and(|share| (share - 0.5).abs() < 1e-9), "{share:?}");
    }

    #[test]
    fn what_starts_from_zero_falls_at_once_or_where_it_comes_back() {
        assert_eq!(falls(|s| [-s, -1.0]), Some(0.0));
        let share = falls(|s| [s * (0.5 - s), 0.5 - 2.0 * s]);
        assert!(share.is_some_and(|share| (share - 0.5).abs() < 1e-9), "{share:?}");
    }
}
