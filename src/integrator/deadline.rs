//! Deadlines: a budget of evaluations for each interval of simulated time. Where it runs short, steps may have larger
//! errors.
//!
//! A loop that waits for every communication step asks for the longest one. Evaluations are counted instead of seconds,
//! and intervals begin at multiples of their length instead of at communication points. So a motion remains the same on
//! every machine and for any communication steps, and a loop whose steps are intervals has the whole budget in each.
//!
//! The evaluations that the rest of an interval needs at the nominal tolerance are predicted: the next [`HORIZON`] of an
//! interval takes as many as the last steps did, the rest [`REST`] of the mean, and [`RESERVE`] of the budget is held
//! back. If more are needed than are left, the tolerance grows by their ratio to the power p with which a step's error
//! depends on the step: p-th roots of tolerances are evaluations. So the tolerance remains nominal in short peaks, it is
//! even where a motion needs too much all the time, and where the prediction is wrong it follows what is left. Steps with
//! a tolerance beyond [`LOOSEST`] would lose the contact that they are in and cost more later. An interval that is too
//! short even for them exceeds its budget: a motion always goes on.

use crate::math;

/// Share of an interval for which the last steps predict the work.
const HORIZON: f64 = 0.3;
/// Share of the mean work that the rest of the interval is assumed to need.
const REST: f64 = 0.5;
/// Share of the budget that is held back for errors of the prediction at the end of an interval.
const RESERVE: f64 = 0.1;
/// Largest tolerance, in scales of the states.
const LOOSEST: f64 = 1.0;
/// Weight of the last step in the rate of work.
const WEIGHT: f64 = 0.125;
/// Evaluations at the mean pace that a motion is assumed to come from: its first steps are shorter than they need be.
const FIRST: f64 = 100.0;
/// Times this close before the end of an interval, as a share of it, belong to the next one: communication points are
/// rounded.
const ROUNDING: f64 = 1e-6;

/// The evaluations that a motion may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deadline {
    /// [1/s] Evaluations of the rates per second of simulated time.
    pub per_second: f64,
    /// [s] Length of the intervals, each of which has its share of them.
    pub interval: f64,
}

/// What has been spent of a budget, and what was given up for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Account {
    /// Number of the present interval.
    pub interval: u64,
    /// Number of evaluations before the present interval.
    pub before: u64,
    /// Number of evaluations up to the last accepted step.
    pub counted: u64,
    /// Evaluations of the last steps, with weights that decay.
    pub work: f64,
    /// [s] Time that the last steps would have covered at the nominal tolerance, with the same weights.
    pub covered: f64,
    /// Tolerance of the last step over the nominal tolerance.
    pub looseness: f64,
    /// Number of steps whose error is above the nominal tolerance.
    pub hits: u64,
    /// Sum of the estimated errors of the steps since the last communication point, in scales of the states.
    pub error: f64,
}

impl Account {
    /// The account of a motion that starts.
    pub const NEW: Self =
        Self { interval: 0, before: 0, counted: 0, work: 0.0, covered: 0.0, looseness: 1.0, hits: 0, error: 0.0 };
}

impl Deadline {
    /// Opens the interval of a step that starts at `time` [s], after so many `evaluations`.
    pub fn begin_step(&self, account: &mut Account, time: f64, evaluations: u64) {
        let interval = (time / self.interval + ROUNDING).floor() as u64;
        if interval != account.interval {
            (account.interval, account.before) = (interval, evaluations);
        }
    }

    /// Tolerance of a step that starts at `time` [s] over the nominal `tolerance`, after so many `evaluations`. The
    /// error is proportional to the step to the `power`.
    pub fn looseness(&self, account: &Account, time: f64, evaluations: u64, tolerance: f64, power: f64) -> f64 {
        let Self { per_second, interval } = *self;
        let budget = per_second * interval;
        let left = budget - (evaluations - account.before) as f64;
        let ahead = ((account.interval as f64 + 1.0) * interval - time).clamp(0.0, interval);
        let predicted = ahead.min(HORIZON * interval);
        let rate = if account.covered > 0.0 { account.work / account.covered } else { 0.0 };
        let needed = rate * predicted + REST * per_second * (ahead - predicted) + RESERVE * budget;
        let most = (LOOSEST / tolerance).max(1.0);
        if needed > left * stretch(most, power) {
            most
        } else if needed > left {
            stretch(needed / left, 1.0 / power).clamp(1.0, most)
        } else {
            1.0
        }
    }

    /// Records an accepted step of length `h` [s] after so many `evaluations`.
    pub fn end_step(&self, account: &mut Account, h: f64, evaluations: u64, power: f64) {
        let Account { counted, work, covered, looseness, .. } = account;
        if *covered == 0.0 {
            (*work, *covered) = (FIRST, FIRST / self.per_second);
        }
        *work += (evaluations - *counted) as f64 - WEIGHT * *work;
        *covered += h / stretch(*looseness, power) - WEIGHT * *covered;
        *counted = evaluations;
        if !(work.is_finite() && covered.is_finite()) {
            // A saved state may have any numbers.
            (*work, *covered) = (FIRST, FIRST / self.per_second);
        }
    }
}

/// Factor of the step size if the tolerance grows by `factor`, for an error proportional to the step to the `power`.
pub fn stretch(factor: f64, power: f64) -> f64 {
    if factor == 1.0 { 1.0 } else { math::rough_power(factor, 1.0 / power) }
}
