//! Deadlines: a budget of evaluations for each interval of simulated time. Where it runs short, steps may have larger
//! errors.
//!
//! A loop that waits for every communication step asks for the longest one. Evaluations are counted instead of seconds,
//! and intervals begin at multiples of their length instead of at communication points. So a motion remains the same on
//! every machine and for any communication steps, and a loop whose steps are intervals has the whole budget in each.
//!
//! What the rest of an interval needs at the nominal tolerance is predicted. The last steps predict [`PERSISTENCE`] times
//! the time that they covered, so that a short peak is not taken for the whole interval. The rest goes on at the mean pace of
//! the last intervals, or at [`REST`] of the budget's if that is more, and [`RESERVE`] of the budget is held back. If more is
//! needed than is left, the tolerance grows by their ratio to the power p with which a step's error depends on the step: p-th
//! roots of tolerances are evaluations. So the tolerance remains nominal in short peaks, it is even where a motion needs too
//! much all the time, and where the prediction is wrong it follows what is left. Steps with a tolerance beyond [`LOOSEST`]
//! would lose the contact that they are in and cost more later. An interval that is too short even for them exceeds its
//! budget: a motion always goes on.
//!
//! A budget stands for time, and a Jacobian with its factorisation takes the time of many evaluations. So what is counted is
//! work: evaluations, and [`JACOBIAN`] for each state of a Jacobian.

use crate::math;

/// Time for which the last steps predict the pace, in times that they covered.
const PERSISTENCE: f64 = 16.0;
/// Least share of the budget's pace that is assumed beyond that time.
const REST: f64 = 0.5;
/// Number of intervals over which the mean pace is taken.
const MEAN_INTERVALS: f64 = 4.0;
/// Share of the budget that is held back for errors of the prediction at the end of an interval.
const RESERVE: f64 = 0.15;
/// Largest tolerance, in scales of the states.
const LOOSEST: f64 = 1e-3;
/// Work of a Jacobian and its factorisation for each state, in evaluations: they take the time of 2.4 to 4.2, as measured with
/// three to twelve positions.
const JACOBIAN: u64 = 3;
/// Weight of the last step in the pace of the last steps.
const WEIGHT: f64 = 0.125;
/// Work at the mean pace that a motion is assumed to come from: its first steps are shorter than they need be.
const FIRST: f64 = 100.0;
/// Times this close before the end of an interval, as a share of it, belong to the next one: communication points are
/// rounded.
const ROUNDING: f64 = 1e-6;

/// The work that a motion may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deadline {
    /// [1/s] Work per second of simulated time: evaluations of the rates, and what Jacobians take.
    pub per_second: f64,
    /// [s] Length of the intervals, each of which has its share of them.
    pub interval: f64,
}

/// What has been spent of a budget, and what was given up for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Account {
    /// Number of the present interval.
    pub interval: u64,
    /// Work of Jacobians since the start.
    pub jacobians: u64,
    /// Work before the present interval.
    pub before: u64,
    /// Work up to the last accepted step.
    pub counted: u64,
    /// Pace of the last steps.
    pub recent: Pace,
    /// Pace of the last intervals.
    pub mean: Pace,
    /// Tolerance of the last step over the nominal tolerance.
    pub looseness: f64,
    /// Number of steps whose error is above the nominal tolerance.
    pub hits: u64,
    /// Sum of the estimated errors of the steps since the last communication point, in scales of the states.
    pub error: f64,
}

/// The work of steps, and the time that they would have covered at the nominal tolerance, with weights that decay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Work.
    pub work: f64,
    /// [s] Time.
    pub covered: f64,
}

impl Pace {
    /// No step yet.
    pub const NONE: Self = Self { work: 0.0, covered: 0.0 };

    /// [1/s] Work over time; 0 before the first step.
    fn rate(self) -> f64 {
        if self.covered > 0.0 { self.work / self.covered } else { 0.0 }
    }

    /// Adds a step and keeps a share `kept` of what was before.
    fn add(&mut self, kept: f64, work: f64, covered: f64) {
        *self = Self { work: kept * self.work + work, covered: kept * self.covered + covered };
        if !(self.work.is_finite() && self.covered.is_finite()) {
            // A saved state may have any numbers.
            *self = Self::NONE;
        }
    }
}

impl Account {
    /// The account of a motion that starts.
    pub const NEW: Self = Self {
        interval: 0,
        jacobians: 0,
        before: 0,
        counted: 0,
        recent: Pace::NONE,
        mean: Pace::NONE,
        looseness: 1.0,
        hits: 0,
        error: 0.0,
    };
}

impl Deadline {
    /// Opens the interval of a step that starts at `time` [s], after so much `work`.
    pub fn begin_step(&self, account: &mut Account, time: f64, work: u64) {
        let interval = (time / self.interval + ROUNDING).floor() as u64;
        if interval != account.interval {
            (account.interval, account.before) = (interval, work);
        }
    }

    /// Tolerance of a step that starts at `time` [s] over the nominal `tolerance`, after so much `work`. The error is
    /// proportional to the step to the `power`.
    pub fn looseness(&self, account: &Account, time: f64, work: u64, tolerance: f64, power: f64) -> f64 {
        let Self { per_second, interval } = *self;
        let budget = per_second * interval;
        let left = budget - (work - account.before) as f64;
        let ahead = ((account.interval as f64 + 1.0) * interval - time).clamp(0.0, interval);
        let Account { recent, mean, .. } = account;
        let predicted = ahead.min(PERSISTENCE * recent.covered);
        let rest = mean.rate().max(REST * per_second);
        let needed = recent.rate() * predicted + rest * (ahead - predicted) + RESERVE * budget;
        let most = (LOOSEST / tolerance).max(1.0);
        if needed > left * stretch(most, power) {
            most
        } else if needed > left {
            stretch(needed / left, 1.0 / power).clamp(1.0, most)
        } else {
            1.0
        }
    }

    /// Records an accepted step of length `h` [s] after so much `work`.
    pub fn end_step(&self, account: &mut Account, h: f64, work: u64, power: f64) {
        let Account { counted, recent, mean, looseness, .. } = account;
        let of_mean = MEAN_INTERVALS * self.interval;
        if *recent == Pace::NONE {
            *recent = Pace { work: FIRST, covered: FIRST / self.per_second };
            *mean = Pace { work: REST * self.per_second * of_mean, covered: of_mean };
        }
        let (spent, covered) = ((work - *counted) as f64, h / stretch(*looseness, power));
        recent.add(1.0 - WEIGHT, spent, covered);
        mean.add(1.0 / (1.0 + h / of_mean), spent, covered);
        *counted = work;
    }
}

/// Work of so many Jacobians of so many `states`, in evaluations.
pub fn work_of(jacobians: u64, states: usize) -> u64 {
    JACOBIAN * jacobians * states as u64
}

/// Factor of the step size if the tolerance grows by `factor`, for an error proportional to the step to the `power`.
pub fn stretch(factor: f64, power: f64) -> f64 {
    if factor == 1.0 { 1.0 } else { math::rough_power(factor, 1.0 / power) }
}
