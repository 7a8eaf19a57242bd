//! Where in a rejected step the rates have a derivative discontinuity (their slope jumps).
//!
//! Stages of a step beyond a discontinuity follow another branch of the rates than stages before it. The error estimate
//! notices this and the step is rejected, but the estimate does not locate the discontinuity, and halving the step
//! towards it takes about ten attempts. The system provides functions whose zeros are the discontinuities. With them,
//! one attempt ends at the discontinuity and the next step starts behind it. Discontinuities often follow each other: a
//! friction law has one at every corner, and a reversal of the sliding direction passes all of them. Hence after a step
//! that was cut at a discontinuity, the next discontinuity is searched for before an attempt fails.
//!
//! Only the length of steps depends on this search. The rates themselves choose their branches.

use super::state::StepPoint;
use super::system::{Discontinuities, EventFunctions, MAX_STATES, System};

/// [share of the step] Distance over which the functions are followed along the rates to find their slope at the start.
const SLOPE_SHARE: f64 = 1e-6;
/// [share of the step] Range in which a shorter step may end. A discontinuity before it belongs to the start of the
/// step; one after it hardly contributes to the error.
const CUT_RANGE: std::ops::Range<f64> = 1e-5..0.96;
/// A discontinuity beyond this share is located on a curve that the branch behind it has bent. The step ends before it,
/// and the next step locates it from nearby.
const DISTANT: f64 = 0.1;
/// A distant discontinuity is approached to this factor of its share.
const APPROACH: f64 = 0.95;
/// A near discontinuity is passed by this factor of its share, because a step that ends just before it gains nothing.
const PAST_DISCONTINUITY: f64 = 1.01;
/// An event is passed by this factor of its share, for the same reason.
const PAST_EVENT: f64 = 1.001;

/// The share of a rejected step at which a shorter step should end: the first derivative discontinuity or event in it.
/// The attempt went from `start`, where the event functions are `events`, over `h` to the state `end`.
pub fn first<D: Copy>(
    system: &dyn System<Discrete = D>,
    start: &StepPoint<D>,
    events: &EventFunctions,
    h: f64,
    end: &[f64],
) -> Option<f64> {
    let mut fallen = EventFunctions::default();
    system.event_functions(&start.discrete, start.t + h, end, &mut fallen);
    let above = events.iter().zip(&fallen).take(system.event_count()).filter(|(event, _)| event.value > 0.0);
    let events = above.filter_map(|(now, then)| crossing(now.value, now.rate * h, then.value));
    let event = earliest(events.map(|share| share * PAST_EVENT));
    let discontinuity = first_discontinuity(system, start, h, end);
    earliest([event, discontinuity].into_iter().flatten())
}

/// The share at which a step of `h` from `start` should end before it has been attempted: the first derivative
/// discontinuity, if the accelerations continue to change as they have since `earlier`.
pub fn predicted<D: Copy>(
    system: &dyn System<Discrete = D>,
    earlier: &StepPoint<D>,
    start: &StepPoint<D>,
    h: f64,
) -> Option<f64> {
    let bend = 0.5 * h * h / (start.t - earlier.t);
    let rates = start.rates.iter().zip(&earlier.rates);
    let mut end = [0.0; MAX_STATES];
    let end = &mut end[..start.y.len()];
    for ((end, y), (rate, before)) in end.iter_mut().zip(&start.y).zip(rates) {
        *end = *y + (h * rate + bend * (rate - before));
    }
    first_discontinuity(system, start, h, end)
}

fn first_discontinuity<D: Copy>(
    system: &dyn System<Discrete = D>,
    start: &StepPoint<D>,
    h: f64,
    end: &[f64],
) -> Option<f64> {
    let StepPoint { t, y, rates, discrete, .. } = start;
    let (mut before, mut after) = (Discontinuities::NONE, Discontinuities::NONE);
    system.discontinuities(discrete, *t, y, &mut before);
    system.discontinuities(discrete, t + h, end, &mut after);
    if before.values().iter().zip(after.values()).all(|(now, then)| now * then >= 0.0) {
        return None;
    }
    let mut ahead_state = [0.0; MAX_STATES];
    let ahead_state = &mut ahead_state[..y.len()];
    for ((ahead_state, y), rate) in ahead_state.iter_mut().zip(y).zip(rates) {
        *ahead_state = y + SLOPE_SHARE * h * rate;
    }
    let mut ahead = Discontinuities::NONE;
    system.discontinuities(discrete, t + SLOPE_SHARE * h, ahead_state, &mut ahead);
    let all = before.values().iter().zip(ahead.values()).zip(after.values());
    let shares = all.filter_map(|((now, soon), then)| crossing(*now, (soon - now) / SLOPE_SHARE, *then));
    earliest(shares.map(|share| share * if share > DISTANT { APPROACH } else { PAST_DISCONTINUITY }))
}

/// The smallest share at which a shorter step may end.
fn earliest(shares: impl Iterator<Item = f64>) -> Option<f64> {
    shares.filter(|share| CUT_RANGE.contains(share)).min_by(f64::total_cmp)
}

/// The zero of the parabola from `value` with `slope` at 0 to `end` at 1; `None` unless its ends differ in sign.
fn crossing(value: f64, slope: f64, end: f64) -> Option<f64> {
    if value * end >= 0.0 {
        return None;
    }
    let bend = end - value - slope;
    // The root of larger magnitude, and the other root from their product.
    let root = (slope * slope - 4.0 * bend * value).sqrt();
    let q = -0.5 * (slope + root.copysign(slope));
    [q / bend, value / q].into_iter().find(|share| (0.0..=1.0).contains(share))
}

#[cfg(test)]
mod tests {
    use super::crossing;

    #[test]
    fn a_parabola_that_changes_sign_is_zero_once_between() {
        for (root, other, scale) in [(0.3, 2.0, 1.0), (0.3, -5.0, 4.0), (1e-6, 1e9, -2.0), (0.999, -0.001, 7.0)] {
            let f = |s: f64| scale * (s - root) * (s - other);
            let slope = -scale * (root + other);
            let found = crossing(f(0.0), slope, f(1.0)).expect("a change of sign");
            assert!((found - root).abs() <= 1e-6 * root, "{root} and {other}: {found}");
        }
        assert_eq!(crossing(1.0, -1.5, -0.5), Some(2.0 / 3.0), "a straight line");
        assert_eq!(crossing(1.0, -8.0, 1.0), None, "twice zero in between is not looked for");
        assert_eq!(crossing(0.0, 1.0, 1.0), None);
    }
}
