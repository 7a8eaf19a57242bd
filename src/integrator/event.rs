//! Which event comes first in an accepted step, and where.
//!
//! A guard that is positive before the step and negative after it has fallen through zero; one that
//! is positive at both ends may have dipped below in between, and one that starts from zero upward
//! may have come back. The guard's rate tells where to look.

use super::dense_output::Step;
use super::problem::{GUARDS, Guard, Problem};
use super::root;

/// [share of the step] How well a fall is located on the interpolant.
const RESOLUTION: f64 = 1e-13;

/// The first fall in the step: its share of the step and its guard.
pub fn first<const N: usize, P: Problem<N> + ?Sized>(
    problem: &P,
    modes: &P::Modes,
    step: &Step<'_, N>,
    before: &[Guard; GUARDS],
    after: &[Guard; GUARDS],
) -> Option<(f64, usize)> {
    (0..problem.guard_count())
        .filter_map(|i| {
            let inside = |s: f64| {
                let mut guards = [Guard::default(); GUARDS];
                problem.guards(modes, step.t + s * step.h, &step.state(s, &None), &mut guards);
                guards[i]
            };
            fall(before[i], after[i], step.h, inside).map(|share| (share, i))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The share at which one guard first falls below zero.
fn fall(before: Guard, after: Guard, h: f64, inside: impl Fn(f64) -> Guard) -> Option<f64> {
    let value = |s: f64| inside(s).value;
    if after.value < 0.0 {
        if before.value > 0.0 {
            return Some(root::falling(0.0, 1.0, before.value, after.value, RESOLUTION, value));
        }
        // It starts from zero: upward first, or down at once.
        if before.rate <= 0.0 {
            return Some(0.0);
        }
        let top = root::falling(0.0, 1.0, before.rate, after.rate, RESOLUTION, |s| inside(s).rate);
        let highest = value(top);
        return if highest > 0.0 {
            Some(root::falling(top, 1.0, highest, after.value, RESOLUTION, value))
        } else {
            Some(0.0)
        };
    }
    let dips = before.rate < 0.0 && after.rate > 0.0;
    // No cubic with these ends reaches lower than half of this below them.
    let depth = 0.5 * h * before.rate.abs().max(after.rate);
    if !dips || before.value.min(after.value) > depth || before.value <= 0.0 {
        return None;
    }
    let bottom = root::falling(0.0, 1.0, -before.rate, -after.rate, RESOLUTION, |s| -inside(s).rate);
    let lowest = value(bottom);
    (lowest < 0.0).then(|| root::falling(0.0, bottom, before.value, lowest, RESOLUTION, value))
}
