//! What an integrator remembers between steps.

use super::block::Past;
use super::controller::is_kept;
use super::dense_output::Step;
use super::length::CREEPING;
use super::problem::Extent;
use super::regime::{Manner, Regime};
use super::statistics::Statistics;

/// No run counts as far as this.
const MOST: u64 = 1 << 62;

/// One end of a step: a time, a state, its rates under the modes that hold on this side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Front<const N: usize, D> {
    /// [s]
    pub t: f64,
    /// State.
    pub y: [f64; N],
    /// Its rates.
    pub rates: [f64; N],
    /// Discrete state.
    pub modes: D,
    /// [s] When the last impact is over.
    pub impact_end: f64,
}

/// All that an integrator remembers: as plain numbers, a saved state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory<const N: usize, D> {
    /// Start of the last step.
    pub start: Front<N, D>,
    /// Its end, before the events there.
    pub end: Front<N, D>,
    /// The same instant after its events: where the next step starts.
    pub front: Front<N, D>,
    /// How the last step was made.
    pub manner: Manner,
    /// How the next one is to be.
    pub regime: Regime,
    /// [s] The next step.
    pub step: f64,
    /// Error of the last accepted step over the tolerance.
    pub last_error: f64,
    /// So many of the last accepted steps were cut short at a kink.
    pub cuts: u32,
    /// Events at the front, which the end does not know yet.
    pub crossings: u64,
    /// What the last step leaves for the next.
    pub past: Past<N>,
    /// Work done.
    pub statistics: Statistics,
}

impl<const N: usize, D> Memory<N, D> {
    /// The last step, up to the events at its end.
    pub fn last_step(&self, extent: Extent) -> Step<'_, N> {
        let (start, end) = (&self.start, &self.end);
        Step { t: start.t, h: end.t - start.t, y0: &start.y, f0: &start.rates, y1: &end.y, f1: &end.rates, extent }
    }

    /// Whether a run at `time` can have come to this: a last step around it, no longer than any, between states that
    /// are kept.
    pub fn is_sound(&self, time: f64, extent: Extent, longest_step: f64) -> bool {
        let Self { start, end, front, regime, step, cuts, crossings, past, statistics, .. } = self;
        let kept = |y: &[f64; N]| y.iter().take(extent.states).all(|y| is_kept(*y));
        let rounding = 2.0 * f64::EPSILON * start.t.abs().max(end.t.abs());
        let impacts_end = |front: &Front<N, D>| front.impact_end - front.t <= longest_step + rounding;
        let length = end.t - start.t;
        let Statistics { steps, rejected, evaluations, events } = *statistics;
        let counted = [*crossings, steps, rejected, evaluations, events].iter().all(|count| *count <= MOST);
        [start, end, front].iter().all(|front| kept(&front.y) && impacts_end(front))
            && end.t == front.t
            && (start.t..=front.t).contains(&time)
            && (0.0..=longest_step + rounding).contains(&length)
            && (length == 0.0 || steps > 0)
            && *step >= 0.0
            && regime.is_sound()
            && past.is_sound(extent)
            && *cuts <= CREEPING
            && *crossings <= events
            && counted
    }

    /// Work done since the start to reach `t` in the last step.
    pub fn statistics_at(&self, t: f64) -> Statistics {
        let mut statistics = self.statistics;
        if t < self.front.t {
            statistics.events -= self.crossings;
        }
        statistics
    }
}
