//! Error norm and step size control.

use super::error::IntegrationError;
use super::method::Attempt;
use super::state::StepPoint;
use super::system::{StateLayout, System};
use crate::math::{self, LANES, larger};
use std::array;
use wide::f64x4;

/// Accuracy and cost of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Tolerance, relative to the scales of the states.
    pub tolerance: f64,
    /// [s] Step of a method without error estimate.
    pub fixed_step: f64,
    /// Limit of the work in one advance.
    pub effort: WorkLimit,
}

/// The maximum number of evaluations of the rates in one advance: a constant plus a rate times its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkLimit {
    /// Evaluations that any advance may take.
    pub base: u64,
    /// [1/s] Additional evaluations per second of the advance.
    pub per_second: u64,
}

impl WorkLimit {
    /// No limit.
    pub const ANY: Self = Self { base: u64::MAX, per_second: 0 };

    /// The limit for an advance over `interval` [s].
    pub fn over(self, interval: f64) -> u64 {
        self.base.saturating_add((interval * self.per_second as f64).min(MAX_EVALUATIONS_BY_LENGTH) as u64)
    }

    /// Refuses an advance from `start` to `target` [s] that exceeds the limit even with one evaluation per step of
    /// `longest` [s].
    ///
    /// # Errors
    /// `TooMuchWork` at `start`.
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

/// Upper bound of the evaluations that the length of an advance adds.
const MAX_EVALUATIONS_BY_LENGTH: f64 = 1e11;
/// Safety factor of the step size; see [`growth`].
pub const SAFETY: f64 = 0.95;
/// [s] Upper bound of the first step of a motion.
const FIRST_STEP: f64 = 1e-4;
/// Smallest factor between successive step sizes.
const MIN_FACTOR: f64 = 0.2;
/// Largest factor between successive step sizes.
const MAX_FACTOR: f64 = 5.0;
/// Exponent of the last step's error in [`growth`].
const LAST_ERROR_EXPONENT: f64 = 0.025;
/// Early stages have rates of low order: their deviation rejects a step only above this many times a tolerable error.
const UNSEEN_LIMIT: f64 = 1e3;
/// Accuracy of a state is limited to a few roundings of its value.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Root mean square of the error of a step from `y` over the tolerance, for the states that have a scale. A step is
/// accepted if the norm is at most 1. With `coarse` the second, lower-order estimate is included.
///
/// The rounding of a position disturbs accelerations, hence velocities, by that rounding times the fastest frequency,
/// which is the ratio of their scales. A tolerance below this is out of reach: the estimate of an error would be
/// rounding alone and fall with the first power of the step, and the roundings of ever more steps would add up. Velocities
/// of modal coordinates are disturbed by the roundings of places, which are far larger than their own positions'.
pub fn norm(attempt: &Attempt, y: &[f64], scales: &[f64], layout: StateLayout, coarse: bool, tolerance: f64) -> f64 {
    let StateLayout { positions: p, places, weighted, .. } = layout;
    let of_scale = |(y, scale): (&f64, &f64)| f64::EPSILON * y.abs() / scale;
    let of_places = if places < p { y[..places].iter().zip(scales).map(of_scale).fold(0.0, f64::max) } else { 0.0 };
    let (mut fine, mut of_coarse, mut largest_unseen) = (f64x4::ZERO, f64x4::ZERO, f64x4::ZERO);
    for range in [0..p, p..2 * p, 2 * p..weighted] {
        let is_velocity = range.start == p;
        for at in range.clone().step_by(LANES) {
            // Beyond the last state of a kind, errors of 0 over weights of 1.
            let four = |list: &[f64], behind: usize, beyond: f64| match list[at - behind..range.end - behind]
                .first_chunk()
            {
                Some(four) => f64x4::new(*four),
                None => f64x4::new(array::from_fn(|i| if at + i < range.end { list[at + i - behind] } else { beyond })),
            };
            let scale = four(scales, 0, 1.0 / tolerance);
            let rounding = |behind: usize| f64x4::splat(ROUNDINGS) * four(y, behind, 0.0).abs();
            let mut tolerable = f64x4::splat(tolerance) * scale;
            if is_velocity {
                let own = rounding(p) / four(scales, p, 1.0);
                tolerable = larger(tolerable, larger(own, f64x4::splat(of_places)) * scale);
            }
            let per_weight = f64x4::ONE / (tolerable + rounding(0));
            let square = |error: &[f64]| {
                let share = four(error, 0, 0.0) * per_weight;
                share * share
            };
            fine += square(&attempt.error);
            if coarse {
                of_coarse += square(&attempt.coarse_error);
            }
            largest_unseen = larger(four(&attempt.unseen, 0, 0.0) * per_weight, largest_unseen);
        }
    }
    if largest_unseen.to_array().iter().any(|unseen| *unseen > UNSEEN_LIMIT) {
        return f64::INFINITY;
    }
    let mean = |squares: f64x4| {
        let [a, b, c, d] = squares.to_array();
        ((a + b) + (c + d)) / weighted.max(1) as f64
    };
    let fine = mean(fine);
    if !coarse {
        return fine.sqrt();
    }
    // As in DOP853: the coarse estimate keeps the fine one from vanishing by chance.
    let sum = fine + 0.01 * mean(of_coarse);
    if sum == 0.0 { 0.0 } else { fine / sum.sqrt() }
}

/// Index of the state with the largest error over its scale.
pub fn worst_component<D: Copy>(attempt: &Attempt, system: &dyn System<Discrete = D>) -> usize {
    let scales = system.scales();
    let share = |i: &usize| {
        let e = (attempt.error[*i] / scales[*i]).abs();
        if e.is_nan() { f64::INFINITY } else { e }
    };
    (0..system.layout().weighted).max_by(|i, j| share(i).total_cmp(&share(j))).unwrap_or(0)
}

/// Factor of the next step size after an accepted step whose error is proportional to the step to the `power`: the
/// controller of K. Gustafsson as in Hairer, Wanner II, IV.2. Usual constants are 0.9 and 0.04. The present ones suit
/// contacts, which shorten steps often: a step size that recovers quickly, at the price of more rejections, needs up to
/// a tenth fewer evaluations for the same error with `verner7`.
pub fn growth(error: f64, last_error: f64, power: f64) -> f64 {
    let error = error.max(1e-10);
    let exponent = 1.0 / power - 0.75 * LAST_ERROR_EXPONENT;
    let factor = SAFETY * math::rough_power(error, -exponent) * math::rough_power(last_error, LAST_ERROR_EXPONENT);
    factor.clamp(MIN_FACTOR, MAX_FACTOR)
}

/// Factor of the step size after a rejected step whose `error` is proportional to the step to the `power`.
pub fn shrinkage(error: f64, power: f64) -> f64 {
    if error.is_finite() { (SAFETY * math::rough_power(error, -1.0 / power)).clamp(MIN_FACTOR, SAFETY) } else { 0.1 }
}

/// The power of the step to which the error is proportional, estimated from the steps [s] and errors of two attempts
/// from the same state, at most the method's own, `full`. It is low where a force sets in (K. Gustafsson, ACM Trans.
/// Math. Softw. 17 (1991) 533, on consecutive rejections).
pub fn error_power([longer, shorter]: [(f64, f64); 2], full: f64) -> f64 {
    let power = math::ln(longer.1 / shorter.1) / math::ln(longer.0 / shorter.0);
    if power.is_nan() { full } else { power.clamp(1.0, full) }
}

/// [s] A first step over which the rates change no state by more than a hundredth of its scale.
pub fn first_step<D: Copy>(system: &dyn System<Discrete = D>, front: &StepPoint<D>) -> f64 {
    let weighted = front.rates.iter().zip(system.scales()).take(system.layout().weighted);
    let fastest = weighted.map(|(rate, scale)| (rate / scale).abs()).fold(0.0, f64::max);
    (0.01 / fastest).min(FIRST_STEP).min(system.longest_step())
}
