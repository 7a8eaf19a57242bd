//! Event location in an accepted step: which event comes first, and when; the step that ends at it, and its crossing.
//!
//! An event function that is positive before the step and negative after it has fallen through zero. One that is
//! positive at both ends may have dipped below zero in between, and one that rises from zero at the start may have
//! fallen again. The rate of the event function at both ends tells these cases apart, where the function turns once at most.
//! In a long step it may turn several times: a loose journal crosses its bearing and comes back while nothing else moves. A
//! long step is therefore halved until the cubic of its ends foretells what lies in between, wherever zero is within reach. A
//! short one follows its cubic.

use super::deadline::stretch;
use super::dense_output::Step;
use super::error::IntegrationError;
use super::root;
use super::state::StepPoint;
use super::stepper::Stepper;
use super::system::{EventFunction, EventFunctions, MAX_EVENTS, MAX_STATES, System, Triggered};
use std::cell::OnceCell;

/// [share of the step] Resolution of the time of a fall on the interpolant.
const RESOLUTION: f64 = 1e-13;
/// Share of the longest step above which a step is looked into, whatever its ends say.
const LONG: f64 = 0.05;
/// Maximum number of halvings of a step in the search for a fall.
const MAX_HALVINGS: u32 = 5;
/// The cubic of two ends foretells a value between them if it errs by at most this share of what the function changes by, …
const SHARE_OF_CHANGE: f64 = 0.05;
/// … or by this share of the least of the three values.
const SHARE_OF_VALUE: f64 = 0.1;
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
    let middle = OnceCell::new();
    let is_long = step.h > LONG * system.longest_step();
    (0..system.event_count())
        .filter_map(|i| {
            let at = |share: f64| {
                if share == 0.5 {
                    middle.get_or_init(|| inside(system, discrete, &step, share))[i]
                } else {
                    inside(system, discrete, &step, share)[i]
                }
            };
            let search = Search { h: step.h, inside: &at };
            // The change point's function is as slow as the crank.
            let looks = is_long && !system.is_dead_end(i);
            search.fall([before[i], stepper.events[i]], looks).map(|share| (share, i))
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

/// The search for the first fall of one event function in a step.
pub struct Search<'a> {
    /// [s] Length of the step.
    pub h: f64,
    /// The event function at a share of the step.
    pub inside: &'a dyn Fn(f64) -> EventFunction,
}

/// One event function at a share of a step.
#[derive(Clone, Copy)]
struct Point {
    share: f64,
    value: f64,
    /// Per share of the step.
    rate: f64,
}

impl Search<'_> {
    fn point(&self, share: f64, EventFunction { value, rate }: EventFunction) -> Point {
        Point { share, value, rate: self.h * rate }
    }

    fn value(&self, share: f64) -> f64 {
        (self.inside)(share).value
    }

    /// The share at which the function first falls below zero, from its values at both ends. With `looks` it is evaluated between
    /// them whatever they say.
    pub fn fall(&self, [before, after]: [EventFunction; 2], looks: bool) -> Option<f64> {
        let (start, end) = (self.point(0.0, before), self.point(1.0, after));
        if looks { self.in_halves(start, end, MAX_HALVINGS) } else { self.between(start, end, true, MAX_HALVINGS) }
    }

    /// The first fall in one half or the other.
    fn in_halves(&self, from: Point, to: Point, halvings: u32) -> Option<f64> {
        let share = 0.5 * (from.share + to.share);
        let middle = self.point(share, (self.inside)(share));
        let foretold = foretells(from, middle, to);
        let within = |from, to| self.between(from, to, foretold, halvings - 1);
        within(from, middle).or_else(|| within(middle, to))
    }

    /// The first fall between two points, between which a cubic has been found to follow the function or not.
    fn between(&self, from: Point, to: Point, is_cubic: bool, halvings: u32) -> Option<f64> {
        if halvings > 0 && is_within_reach(from, to) && !(is_cubic && turns_once(from, to)) {
            return self.in_halves(from, to, halvings);
        }
        if to.value < 0.0 {
            if from.value > 0.0 {
                return Some(self.zero([from.share, to.share], [from.value, to.value]));
            }
            // The function starts at zero, or slightly below because it was crossed together with another event.
            if from.rate <= 0.0 {
                return Some(from.share);
            }
            if to.rate >= 0.0 {
                return None; // it rises from a value below zero
            }
            let top = self.turn(from, to, 1.0);
            let highest = self.value(top);
            return if highest > 0.0 { Some(self.zero([top, to.share], [highest, to.value])) } else { Some(top) };
        }
        let dips = from.rate < 0.0 && to.rate > 0.0;
        // No cubic with these end values and rates falls further than `depth` below its ends.
        let depth = 0.5 * (to.share - from.share) * from.rate.abs().max(to.rate);
        if !dips || from.value.min(to.value) > depth || from.value <= 0.0 {
            return None;
        }
        let bottom = self.turn(from, to, -1.0);
        let lowest = self.value(bottom);
        (lowest < 0.0).then(|| self.zero([from.share, bottom], [from.value, lowest]))
    }

    /// Where the function falls through zero between two shares with these values.
    fn zero(&self, [from, to]: [f64; 2], [above, below]: [f64; 2]) -> f64 {
        root::falling(from, to, above, below, RESOLUTION, |share| self.value(share))
    }

    /// Where the rate times `sign` falls through zero.
    fn turn(&self, from: Point, to: Point, sign: f64) -> f64 {
        let rate = |share: f64| sign * self.h * (self.inside)(share).rate;
        root::falling(from.share, to.share, sign * from.rate, sign * to.rate, RESOLUTION, rate)
    }
}

/// What the function changes by between two points if it goes on at their rates.
fn change(from: Point, to: Point) -> f64 {
    (to.share - from.share) * (from.rate.abs() + to.rate.abs()) + (to.value - from.value).abs()
}

/// Whether the function may be zero between two points.
fn is_within_reach(from: Point, to: Point) -> bool {
    from.value.min(to.value) <= change(from, to)
}

/// Whether the cubic of two ends foretells the function in their middle.
fn foretells(from: Point, middle: Point, to: Point) -> bool {
    let cubic = 0.5 * (from.value + to.value) + 0.125 * (to.share - from.share) * (from.rate - to.rate);
    let error = (middle.value - cubic).abs();
    let least = from.value.min(middle.value).min(to.value);
    error <= (SHARE_OF_CHANGE * change(from, to)).max(SHARE_OF_VALUE * least)
}

/// Whether the cubic of two ends turns at most once between them: not if its rate has the same sign at both and another at its
/// own extremum.
fn turns_once(from: Point, to: Point) -> bool {
    let length = to.share - from.share;
    let (start, end, rise) = (length * from.rate, length * to.rate, to.value - from.value);
    // The rate is start + linear·s + square·s².
    let (linear, square) = (6.0 * rise - 4.0 * start - 2.0 * end, 3.0 * (start + end) - 6.0 * rise);
    let extremum = -0.5 * linear / square;
    let lies_between = extremum > 0.0 && extremum < 1.0;
    start * end <= 0.0 || !lies_between || (start + 0.5 * linear * extremum) * start >= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a function of the share of a step, and its rate, falls.
    fn falls(of: impl Fn(f64) -> [f64; 2], looks: bool) -> Option<f64> {
        let function = |s: f64| {
            let [value, rate] = of(s);
            EventFunction { value, rate }
        };
        Search { h: 1.0, inside: &function }.fall([function(0.0), function(1.0)], looks)
    }

    #[test]
    fn what_was_crossed_a_little_early_is_not_crossed_again_on_its_way_up() {
        // Two contacts that opened and closed together at a tolerable distance from zero changed places for ever.
        assert_eq!(falls(|s| [-1e-3 + 1e-4 * s, 1e-4], false), None);
    }

    #[test]
    fn what_turns_back_below_zero_falls_where_it_turns() {
        let share = falls(|s| [-1e-3 + 1e-4 * (s - s * s), 1e-4 * (1.0 - 2.0 * s)], false);
        assert!(share.is_some_and(|share| (share - 0.5).abs() < 1e-9), "{share:?}");
    }

    #[test]
    fn what_starts_from_zero_falls_at_once_or_where_it_comes_back() {
        assert_eq!(falls(|s| [-s, -1.0], false), Some(0.0));
        let share = falls(|s| [s * (0.5 - s), 0.5 - 2.0 * s], false);
        assert!(share.is_some_and(|share| (share - 0.5).abs() < 1e-9), "{share:?}");
    }

    #[test]
    fn a_fall_is_found_however_often_the_function_turns() {
        let wave = |turns: f64, phase: f64, mean: f64| {
            move |s: f64| {
                let (sin, cos) = (turns * std::f64::consts::TAU * s + phase).sin_cos();
                [mean - cos, turns * std::f64::consts::TAU * sin]
            }
        };
        for turns in [0.6, 0.9, 1.0, 1.3, 1.9] {
            for phase in [0.3, 1.0, 1.7, 2.5, 3.1, 3.9, 4.6, 5.5, 6.2] {
                for mean in [0.95, 0.5, -0.2, 1.05] {
                    let of = wave(turns, phase, mean);
                    let fine: Vec<f64> = (0..=100_000).map(|i| f64::from(i) / 1e5).collect();
                    let expected = fine.windows(2).find(|ends| of(ends[0])[0] > 0.0 && of(ends[1])[0] <= 0.0);
                    if of(0.0)[0] <= 0.0 {
                        continue;
                    }
                    let found = falls(of, true);
                    let agrees = match (found, expected) {
                        (Some(found), Some(ends)) => found > ends[0] - 1e-9 && found < ends[1] + 1e-9,
                        (found, expected) => found.is_none() && expected.is_none(),
                    };
                    assert!(agrees, "{turns} turns from {phase}, mean {mean}: {found:?}, not {expected:?}");
                }
            }
        }
    }
}
