//! What an integrator remembers between steps.

use super::dense_output::Step;
use super::statistics::Statistics;
use super::system::StateLayout;

/// No run counts as far as this.
const MOST: u64 = 1 << 62;
/// States and rates from here on count as lost.
const GREATEST: f64 = 1e25;
/// After so many steps in a row that were cut, the motion creeps along a derivative discontinuity: it is passed over as
/// any error is, until a step does not fail.
pub const CREEPING: u32 = 8;
/// Start, end and front of a step, and an attempt at the next.
const POINTS: usize = 4;

/// One end of a step: a time, a state, its rates under the discrete state that holds on this side.
#[derive(Clone, Debug, PartialEq)]
pub struct StepPoint<D> {
    /// [s]
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
    /// Its rates.
    pub rates: Vec<f64>,
    /// Discrete state.
    pub discrete: D,
    /// [s] When the last impact is over.
    pub impact_end: f64,
}

impl<D: Copy> StepPoint<D> {
    /// The state `y` at `t`, its rates not known.
    pub fn new(t: f64, y: &[f64], discrete: D) -> Self {
        Self { t, y: y.to_vec(), rates: vec![0.0; y.len()], discrete, impact_end: t }
    }

    /// Becomes the same as another.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { t, y, rates, discrete, impact_end } = self;
        (*t, *discrete, *impact_end) = (other.t, other.discrete, other.impact_end);
        y.copy_from_slice(&other.y);
        rates.copy_from_slice(&other.rates);
    }
}

/// All that an integrator remembers beside what its method does: as plain numbers, a part of a saved state.
#[derive(Clone, Debug)]
pub struct SolverState<D> {
    /// The ends of the last step, and a place for the end of an attempt.
    points: [StepPoint<D>; POINTS],
    start: usize,
    end: usize,
    front: usize,
    /// Start of the step before, while one is attempted; otherwise `start`.
    earlier: usize,
    /// [s] The next step.
    pub step: f64,
    /// Error of the last accepted step over the tolerance.
    pub last_error: f64,
    /// So many of the last accepted steps were cut short at a derivative discontinuity.
    pub cuts: u32,
    /// Events at the front, which the end does not know yet.
    pub crossings: u64,
    /// Work done.
    pub statistics: Statistics,
}

impl<D: Copy + PartialEq> PartialEq for SolverState<D> {
    fn eq(&self, other: &Self) -> bool {
        let numbers = |state: &Self| (state.step, state.last_error, state.cuts, state.crossings, state.statistics);
        let points = |state: &Self| [state.start, state.end, state.front].map(|point| state.points[point].clone());
        numbers(self) == numbers(other) && points(self) == points(other)
    }
}

impl<D: Copy> SolverState<D> {
    /// Of a motion that starts at `point`, with this first step [s].
    pub fn new(point: &StepPoint<D>, step: f64) -> Self {
        Self::of([point.clone(), point.clone(), point.clone()], step)
    }

    /// With this start, end and front of the last step.
    pub fn of([start, end, front]: [StepPoint<D>; 3], step: f64) -> Self {
        let attempt = front.clone();
        Self {
            points: [start, end, front, attempt],
            start: 0,
            end: 1,
            front: 2,
            earlier: 0,
            step,
            last_error: 1e-4,
            cuts: 0,
            crossings: 0,
            statistics: Statistics::default(),
        }
    }

    /// Start of the last step.
    #[inline]
    pub fn start(&self) -> &StepPoint<D> {
        &self.points[self.start]
    }

    /// Its end, before the events there.
    #[inline]
    pub fn end(&self) -> &StepPoint<D> {
        &self.points[self.end]
    }

    /// The same instant after its events: where the next step starts.
    #[inline]
    pub fn front(&self) -> &StepPoint<D> {
        &self.points[self.front]
    }

    /// The end of an attempted step.
    #[inline]
    pub fn attempt(&self) -> &StepPoint<D> {
        &self.points[self.free()]
    }

    /// A place that is none of the last step's.
    #[inline]
    fn free(&self) -> usize {
        let taken = 1_u32 << self.start | 1 << self.end | 1 << self.front | 1 << self.earlier;
        (!taken).trailing_zeros() as usize % POINTS
    }

    /// Start of the step, and the place for the end of an attempt at it.
    #[inline]
    pub fn ends(&mut self) -> (&StepPoint<D>, &mut StepPoint<D>) {
        let free = self.free();
        let [start, end] =
            self.points.get_disjoint_mut([self.start, free]).expect("the attempt has a place of its own");
        (start, end)
    }

    /// Start and end of the last step, and the place for the end of an attempt; where the step has a length.
    pub fn all_ends(&mut self) -> (&StepPoint<D>, &StepPoint<D>, &mut StepPoint<D>) {
        let free = self.free();
        let [start, end, attempt] =
            self.points.get_disjoint_mut([self.start, self.end, free]).expect("a step that has a length has two ends");
        (start, end, attempt)
    }

    /// The front, to be changed. What is told of the end stays as it is.
    pub fn front_mut(&mut self) -> &mut StepPoint<D> {
        if self.front == self.end || self.front == self.start {
            let free = self.free();
            let [front, own] =
                self.points.get_disjoint_mut([self.front, free]).expect("the front gets a place of its own");
            own.copy_from(front);
            self.front = free;
        }
        &mut self.points[self.front]
    }

    /// Makes the front the start of the next step.
    #[inline]
    pub fn begin_step(&mut self) {
        self.start = self.front;
    }

    /// Goes back to the last step.
    pub fn give_up_step(&mut self) {
        self.start = self.earlier;
    }

    /// Makes the attempt the step that ends at `t`.
    #[inline]
    pub fn commit(&mut self, t: f64) {
        let StepPoint { discrete, impact_end, .. } = *self.start();
        self.commit_with(t, discrete, impact_end);
    }

    /// The same, with another discrete state.
    #[inline]
    pub fn commit_with(&mut self, t: f64, discrete: D, impact_end: f64) {
        let (_, end) = self.ends();
        (end.t, end.discrete, end.impact_end) = (t, discrete, impact_end);
        self.end = self.free();
        (self.front, self.earlier) = (self.end, self.start);
        self.crossings = 0;
        self.statistics.steps += 1;
    }

    /// Takes the whole last step back.
    pub fn take_back(&mut self) {
        (self.end, self.front, self.earlier) = (self.start, self.start, self.start);
    }

    /// The last step, up to the events at its end.
    pub fn last_step(&self, layout: StateLayout) -> Step<'_> {
        let (start, end) = (self.start(), self.end());
        Step { t: start.t, h: end.t - start.t, y0: &start.y, f0: &start.rates, y1: &end.y, f1: &end.rates, layout }
    }

    /// Whether a run at `time` can have come to this: a last step around it, no longer than any, between states that
    /// are kept.
    pub fn is_sound(&self, time: f64, longest_step: f64) -> bool {
        let Self { step, cuts, crossings, statistics, .. } = self;
        let (start, end, front) = (self.start(), self.end(), self.front());
        let kept = |y: &[f64]| y.iter().all(|y| is_kept(*y));
        let rounding = 2.0 * f64::EPSILON * start.t.abs().max(end.t.abs());
        let impacts_end = |front: &StepPoint<D>| front.impact_end - front.t <= longest_step + rounding;
        let length = end.t - start.t;
        let Statistics { steps, rejected, evaluations, events } = *statistics;
        let counted = [*crossings, steps, rejected, evaluations, events].iter().all(|count| *count <= MOST);
        [start, end, front].iter().all(|front| kept(&front.y) && impacts_end(front))
            && end.t == front.t
            && (start.t..=front.t).contains(&time)
            && (0.0..=longest_step + rounding).contains(&length)
            && (length == 0.0 || steps > 0)
            && *step >= 0.0
            && *cuts <= CREEPING
            && *crossings <= events
            && counted
    }

    /// Work done since the start to reach `t` in the last step.
    pub fn statistics_at(&self, t: f64) -> Statistics {
        let mut statistics = self.statistics;
        if t < self.front().t {
            statistics.events -= self.crossings;
        }
        statistics
    }
}

/// The first state (or rate) that is not a number, or so large that its powers are not.
#[inline]
pub fn lost_state(states: &[f64]) -> Option<usize> {
    // Without leaving at the first one, several are looked at in one go.
    let all_kept = states.iter().fold(true, |kept, y| kept & is_kept(*y));
    if all_kept { None } else { states.iter().position(|y| !is_kept(*y)) }
}

/// A number, and not so large that its powers are not.
#[inline]
pub fn is_kept(y: f64) -> bool {
    y.abs() < GREATEST
}
