//! The memory of an integrator between steps.

use super::deadline::Account;
use super::dense_output::Step;
use super::statistics::Statistics;
use super::system::StateLayout;

/// No run counts further than this.
const MAX_COUNT: u64 = 1 << 62;
/// Error over the tolerance that counts as the least.
pub const LEAST_ERROR: f64 = 1e-4;
/// No budget makes a tolerance larger by more than this.
const MAX_LOOSENESS: f64 = 1e15;
/// States and rates from this magnitude on are invalid.
const INVALID_FROM: f64 = 1e25;
/// After this many successive steps that were cut at a derivative discontinuity, the motion creeps along it.
/// Discontinuities are then treated as any other error, until a step does not fail.
pub const CREEPING_CUTS: u32 = 8;
/// Start, end and front of the last step, and the end of an attempt at the next step.
const POINTS: usize = 4;

/// A point in time at the end of a step: the state and its rates under the discrete state on this side of the events.
#[derive(Clone, Debug, PartialEq)]
pub struct StepPoint<D> {
    /// [s] Time.
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
    /// Rates of the state.
    pub rates: Vec<f64>,
    /// Discrete state.
    pub discrete: D,
    /// [s] Time at which the last impact ends.
    pub impact_end: f64,
}

impl<D: Copy> StepPoint<D> {
    /// The state `y` at `t`, with rates not computed yet.
    pub fn new(t: f64, y: &[f64], discrete: D) -> Self {
        Self { t, y: y.to_vec(), rates: vec![0.0; y.len()], discrete, impact_end: t }
    }

    /// Copies `other` into this point.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { t, y, rates, discrete, impact_end } = self;
        (*t, *discrete, *impact_end) = (other.t, other.discrete, other.impact_end);
        y.copy_from_slice(&other.y);
        rates.copy_from_slice(&other.rates);
    }
}

/// The memory of an integrator, apart from that of its method. As numbers it is part of a saved state.
#[derive(Clone, Debug)]
pub struct SolverState<D> {
    /// The ends of the last step, and a free place for the end of an attempt.
    points: [StepPoint<D>; POINTS],
    start: usize,
    end: usize,
    front: usize,
    /// Start of the previous step while a step is attempted; otherwise equal to `start`.
    earlier: usize,
    /// [s] Length of the next step.
    pub step: f64,
    /// Error of the last accepted step over the tolerance.
    pub last_error: f64,
    /// Number of successive accepted steps that were cut short at a derivative discontinuity.
    pub cuts: u32,
    /// Number of events at the front; the end is the point before them.
    pub crossings: u64,
    /// Work done since the start.
    pub statistics: Statistics,
    /// The budget of evaluations, and the errors of the steps.
    pub account: Account,
}

impl<D: Copy + PartialEq> PartialEq for SolverState<D> {
    fn eq(&self, other: &Self) -> bool {
        let numbers =
            |state: &Self| (state.step, state.last_error, state.cuts, state.crossings, state.statistics, state.account);
        let points = |state: &Self| [state.start, state.end, state.front].map(|point| state.points[point].clone());
        numbers(self) == numbers(other) && points(self) == points(other)
    }
}

impl<D: Copy> SolverState<D> {
    /// The state of a motion that starts at `point`, with the first step `step` [s].
    pub fn new(point: &StepPoint<D>, step: f64) -> Self {
        Self::of([point.clone(), point.clone(), point.clone()], step)
    }

    /// The state with the given start, end and front of the last step.
    pub fn of([start, end, front]: [StepPoint<D>; 3], step: f64) -> Self {
        let attempt = front.clone();
        Self {
            points: [start, end, front, attempt],
            start: 0,
            end: 1,
            front: 2,
            earlier: 0,
            step,
            last_error: LEAST_ERROR,
            cuts: 0,
            crossings: 0,
            statistics: Statistics::default(),
            account: Account::NEW,
        }
    }

    /// Start of the last step.
    #[inline]
    pub fn start(&self) -> &StepPoint<D> {
        &self.points[self.start]
    }

    /// End of the last step, before the events at that time.
    #[inline]
    pub fn end(&self) -> &StepPoint<D> {
        &self.points[self.end]
    }

    /// The end of the last step after the events at that time: the start of the next step.
    #[inline]
    pub fn front(&self) -> &StepPoint<D> {
        &self.points[self.front]
    }

    /// The end of an attempted step.
    #[inline]
    pub fn attempt(&self) -> &StepPoint<D> {
        &self.points[self.free()]
    }

    /// Index of a point that the last step does not use.
    #[inline]
    fn free(&self) -> usize {
        let taken = 1_u32 << self.start | 1 << self.end | 1 << self.front | 1 << self.earlier;
        (!taken).trailing_zeros() as usize % POINTS
    }

    /// Start of the step, and the point to which an attempt writes its end.
    #[inline]
    pub fn ends(&mut self) -> (&StepPoint<D>, &mut StepPoint<D>) {
        let free = self.free();
        let [start, end] =
            self.points.get_disjoint_mut([self.start, free]).expect("the attempt is not the start of the step");
        (start, end)
    }

    /// Start and end of the last step, and the point to which an attempt writes its end. The step must have a length.
    pub fn all_ends(&mut self) -> (&StepPoint<D>, &StepPoint<D>, &mut StepPoint<D>) {
        let free = self.free();
        let [start, end, attempt] = self
            .points
            .get_disjoint_mut([self.start, self.end, free])
            .expect("start and end of a step with a length differ");
        (start, end, attempt)
    }

    /// The front, for changes; the end of the last step is unaffected.
    pub fn front_mut(&mut self) -> &mut StepPoint<D> {
        if self.front == self.end || self.front == self.start {
            let free = self.free();
            let [front, own] = self.points.get_disjoint_mut([self.front, free]).expect("a free point is not the front");
            own.copy_from(front);
            self.front = free;
        }
        &mut self.points[self.front]
    }

    /// Changes the discrete state of start, end and front of the last step.
    pub fn for_each_discrete(&mut self, mut change: impl FnMut(&mut D)) {
        self.points.iter_mut().for_each(|point| change(&mut point.discrete));
    }

    /// Makes the front the start of the next step.
    #[inline]
    pub fn begin_step(&mut self) {
        self.start = self.front;
    }

    /// Returns to the last step after the attempts at the next one have failed.
    pub fn give_up_step(&mut self) {
        self.start = self.earlier;
    }

    /// Makes the attempt the last step, which ends at `t`.
    #[inline]
    pub fn commit(&mut self, t: f64) {
        let StepPoint { discrete, impact_end, .. } = *self.start();
        self.commit_with(t, discrete, impact_end);
    }

    /// As [`commit`](Self::commit), with another discrete state.
    #[inline]
    pub fn commit_with(&mut self, t: f64, discrete: D, impact_end: f64) {
        let (_, end) = self.ends();
        (end.t, end.discrete, end.impact_end) = (t, discrete, impact_end);
        self.end = self.free();
        (self.front, self.earlier) = (self.end, self.start);
        self.crossings = 0;
        self.statistics.steps += 1;
    }

    /// Discards the last step.
    pub fn take_back(&mut self) {
        (self.end, self.front, self.earlier) = (self.start, self.start, self.start);
    }

    /// The last step, up to the events at its end.
    pub fn last_step(&self, layout: StateLayout) -> Step<'_> {
        let (start, end) = (self.start(), self.end());
        Step { t: start.t, h: end.t - start.t, y0: &start.y, f0: &start.rates, y1: &end.y, f1: &end.rates, layout }
    }

    /// Work since the start: evaluations, and what Jacobians take.
    pub fn work(&self) -> u64 {
        self.statistics.evaluations.saturating_add(self.account.jacobians)
    }

    /// Whether a run at `time` can have produced this state: the last step contains `time`, is at most `longest_step`
    /// [s] long and has valid states.
    pub fn is_sound(&self, time: f64, longest_step: f64) -> bool {
        let Self { step, last_error, cuts, crossings, statistics, account, .. } = self;
        let (start, end, front) = (self.start(), self.end(), self.front());
        let valid = |y: &[f64]| y.iter().all(|y| is_valid(*y));
        let rounding = 2.0 * f64::EPSILON * start.t.abs().max(end.t.abs());
        let impacts_end = |front: &StepPoint<D>| front.impact_end - front.t <= longest_step + rounding;
        let length = end.t - start.t;
        let Statistics { steps, rejected, evaluations, events } = *statistics;
        let counted = [*crossings, steps, rejected, evaluations, events].iter().all(|count| *count <= MAX_COUNT);
        let Account { interval, jacobians, before, counted: accounted, recent, mean, looseness, hits, error } =
            *account;
        let accounted = [interval, jacobians, hits].iter().all(|count| *count <= MAX_COUNT)
            && before.max(accounted) <= evaluations.saturating_add(jacobians)
            && [recent.work, recent.covered, mean.work, mean.covered].iter().all(|x| (0.0..INVALID_FROM).contains(x))
            && (1.0..=MAX_LOOSENESS).contains(&looseness)
            && error >= 0.0;
        [start, end, front].iter().all(|front| valid(&front.y) && impacts_end(front))
            && end.t == front.t
            && (start.t..=front.t).contains(&time)
            && (0.0..=longest_step + rounding).contains(&length)
            && (length == 0.0 || steps > 0)
            && *step >= 0.0
            // Time stepping has no errors.
            && (*last_error == 0.0 || (LEAST_ERROR..=1.0).contains(last_error))
            && *cuts <= CREEPING_CUTS
            && *crossings <= events
            && counted
            && accounted
    }

    /// Statistics of the work done to reach `t` in the last step.
    pub fn statistics_at(&self, t: f64) -> Statistics {
        let mut statistics = self.statistics;
        if t < self.front().t {
            statistics.events -= self.crossings;
        }
        statistics
    }
}

/// Index of the first state or rate that is not valid, see [`is_valid`].
#[inline]
pub fn first_invalid(states: &[f64]) -> Option<usize> {
    // Without an early exit the compiler tests several numbers at once.
    let all_valid = states.iter().fold(true, |valid, y| valid & is_valid(*y));
    if all_valid { None } else { states.iter().position(|y| !is_valid(*y)) }
}

/// Whether a state or rate is a number, and not so large that its powers overflow.
#[inline]
pub fn is_valid(y: f64) -> bool {
    y.abs() < INVALID_FROM
}
