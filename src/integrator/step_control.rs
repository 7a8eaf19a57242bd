//! Error norm and step-size control.

use super::error::IntegrationError;
use super::method::Attempt;
use super::state::StepPoint;
use super::system::System;
use crate::math;

/// How accurate, or how long a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Tolerance, relative to the problem's scales.
    pub tolerance: f64,
    /// [s] Step of a method without an error estimate.
    pub fixed_step: f64,
    /// How much one advance may cost.
    pub effort: WorkLimit,
}

/// The most evaluations of the rates that one advance may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkLimit {
    /// However short it is.
    pub base: u64,
    /// And more for each second of it.
    pub per_second: u64,
}

impl WorkLimit {
    /// No bound.
    pub const ANY: Self = Self { base: u64::MAX, per_second: 0 };

    /// For an advance over `interval` [s].
    pub fn over(self, interval: f64) -> u64 {
        self.base.saturating_add((interval * self.per_second as f64).min(MOST) as u64)
    }

    /// Refuses an advance from `start` to `target` [s] that takes more even with one evaluation for each step of
    /// `longest` [s].
    pub fn check(self, start: f64, target: f64, longest: f64) -> Result<(), IntegrationError> {
        let evaluations = self.over(target - start);
        let steps = (target - start) / longest;
        if steps <= evaluations as f64 {
            Ok(())
        } else {
            Err(IntegrationError::TooMuchWork { time: start, evaluations })
        }
    }
}

/// However long an advance is, its length adds no more evaluations than this.
const MOST: f64 = 1e11;
const SAFETY: f64 = 0.95; // for this and MEMORY see `growth`
/// [s] A first step of a motion without rates.
const FIRST_STEP: f64 = 1e-4;
const LEAST_FACTOR: f64 = 0.2;
const GREATEST_FACTOR: f64 = 5.0;
const MEMORY: f64 = 0.025;
/// Rates of early stages are of low order: only this many times a tolerable error is suspicious.
const UNSEEN: f64 = 1e3;
/// A state cannot be asked to be more accurate than a few roundings.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Root mean square of the error of a step from `y` over the tolerance, of the states that have a scale; at most 1 for a
/// step to be accepted. There may be a coarse estimate, too.
pub fn norm(attempt: &Attempt, y: &[f64], scales: &[f64], coarse: bool, tolerance: f64) -> f64 {
    let n = scales.len().max(1) as f64;
    let weight = |scale: &f64, y: &f64| tolerance * scale + ROUNDINGS * y.abs();
    let (mut fine, mut missed) = (0.0, false);
    for (((scale, y), error), unseen) in scales.iter().zip(y).zip(&attempt.error).zip(&attempt.unseen) {
        let weight = weight(scale, y);
        missed |= *unseen > UNSEEN * weight;
        fine += (error / weight).powi(2);
    }
    if missed {
        return f64::INFINITY;
    }
    let fine = fine / n;
    if !coarse {
        return fine.sqrt();
    }
    // DOP853: the coarse estimate keeps the fine one from vanishing by chance.
    let mut of_coarse = 0.0;
    for ((scale, y), error) in scales.iter().zip(y).zip(&attempt.coarse_error) {
        of_coarse += (error / weight(scale, y)).powi(2);
    }
    let sum = fine + 0.01 * (of_coarse / n);
    if sum == 0.0 { 0.0 } else { fine / sum.sqrt() }
}

/// The state with the largest error over its weight.
pub fn worst_component<D: Copy>(attempt: &Attempt, system: &dyn System<Discrete = D>) -> usize {
    let scales = system.scales();
    let share = |i: &usize| {
        let e = (attempt.error[*i] / scales[*i]).abs();
        if e.is_nan() { f64::INFINITY } else { e }
    };
    (0..system.layout().weighted).max_by(|i, j| share(i).total_cmp(&share(j))).unwrap_or(0)
}

/// By how much the next step is longer after an accepted one, whose error falls with this `power` of the step: the
/// controller of K. Gustafsson as in Hairer, Wanner II, IV.2, where 0.9 and 0.04 are usual. Contacts shorten steps all the
/// time. One that comes back to its length soon, at the price of more failures, needs fewer evaluations for the same
/// error, up to a tenth of them with `verner7`.
pub fn growth(error: f64, last_error: f64, power: f64) -> f64 {
    let error = error.max(1e-10);
    let exponent = 1.0 / power - 0.75 * MEMORY;
    let factor = SAFETY * math::rough_power(error, -exponent) * math::rough_power(last_error, MEMORY);
    factor.clamp(LEAST_FACTOR, GREATEST_FACTOR)
}

/// By how much the step is shorter after a rejected one whose `error` falls with this `power` of the step.
pub fn shrinkage(error: f64, power: f64) -> f64 {
    if error.is_finite() { (SAFETY * math::rough_power(error, -1.0 / power)).clamp(LEAST_FACTOR, SAFETY) } else { 0.1 }
}

/// The power of the step with which the error falls, at most `full`, the method's, as two attempts from the same state tell by
/// their steps [s] and errors: low where a force sets in (K. Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533, on
/// consecutive rejections).
pub fn error_power([longer, shorter]: [(f64, f64); 2], full: f64) -> f64 {
    let power = math::ln(longer.1 / shorter.1) / math::ln(longer.0 / shorter.0);
    if power.is_nan() { full } else { power.clamp(1.0, full) }
}

/// A first step over which the rates move the state by a hundredth of its scales.
pub fn first_step<D: Copy>(system: &dyn System<Discrete = D>, front: &StepPoint<D>) -> f64 {
    let weighted = front.rates.iter().zip(system.scales()).take(system.layout().weighted);
    let fastest = weighted.map(|(rate, scale)| (rate / scale).abs()).fold(0.0, f64::max);
    (0.01 / fastest).min(FIRST_STEP).min(system.longest_step())
}
