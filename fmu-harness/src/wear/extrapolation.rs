//! dc/dn = g(c) by the method of Bogacki and Shampine (Appl. Math. Lett. 2 (1989) 321), of order 3 with an embedded
//! estimate of order 2, for a growth g that scatters.
//!
//! The error estimate decides on the steps, down to where it is lost in the scatter: scatter is no reason for a shorter
//! step. Both are reported beside the result.

use anyhow::{Context, Error, Result, anyhow, ensure};

/// Weights of k1, k2, k3 in a step; all rows as printed.
const WEIGHTS: [f64; 3] = [2.0 / 9.0, 3.0 / 9.0, 4.0 / 9.0];
/// Weights of k1…k4 in the error estimate: the weights of order 3 minus those of order 2.
const ERROR: [f64; 4] = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];
/// First step, relative to the whole.
const FIRST: f64 = 0.125;
/// Safety factor of the step's length, and the factors by which it changes at most.
const SAFETY: f64 = 0.9;
const SHORTER: f64 = 0.2;
const LONGER: f64 = 4.0;
/// Standard deviations of its scatter below which an error estimate says nothing.
const DEVIATIONS: f64 = 3.0;
/// [strokes] Shortest step: nothing wears within a stroke.
const SHORTEST: f64 = 1.0;
/// A remainder of this share of the whole is the rounding error of a sum.
const SLIVER: f64 = 1e-12;
/// More attempts than this count as a mistake.
const MOST_ATTEMPTS: usize = 2000;

/// Growth in one stroke, of each component of the state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Growth {
    /// Mean over strokes.
    pub mean: Vec<f64>,
    /// Standard error of the mean.
    pub error: Vec<f64>,
}

/// An accepted step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// [strokes] Length.
    pub length: f64,
    /// Numbers of the evaluations of g, in the order of their calls, that are its k1, k2, k3 and k4.
    pub stages: [usize; 4],
    /// State at its end.
    pub state: Vec<f64>,
    /// Error estimate.
    pub error: Vec<f64>,
    /// Standard deviation of the step due to the scatter of g.
    pub scatter: Vec<f64>,
}

/// The way from the first stroke to the last.
#[derive(Debug, Default)]
pub struct Extrapolation {
    /// Accepted steps.
    pub steps: Vec<Step>,
    /// Number of steps that were tried again, shorter.
    pub rejected: usize,
    /// Why it ended before the last stroke, if it did.
    pub stopped: Option<Error>,
}

impl Extrapolation {
    /// [strokes] Where it ended.
    pub fn strokes(&self) -> f64 {
        self.steps.iter().map(|step| step.length).sum()
    }
}

impl Step {
    /// Increment of a quantity whose growth at the first three stages is `rates`.
    pub fn increment(&self, rates: [f64; 3]) -> f64 {
        self.length * weighted(rates)
    }

    /// Error estimate relative to its bound, of the component for which this is largest.
    fn error_ratio(&self, before: &[f64], tolerance: f64) -> f64 {
        let ratio = |place: usize| {
            let bound = (tolerance * (self.state[place] - before[place]).abs()).max(DEVIATIONS * self.scatter[place]);
            if self.error[place] > 0.0 { self.error[place] / bound } else { 0.0 }
        };
        (0..self.state.len()).map(ratio).fold(0.0, f64::max)
    }
}

/// Mean growth of a step, from the growth at its first three stages.
fn weighted(rates: [f64; 3]) -> f64 {
    rates.iter().zip(WEIGHTS).map(|(rate, weight)| weight * rate).sum()
}

/// Follows the growth from `start` over `total` strokes, with the relative error `tolerance` in each step.
///
/// A step whose growth cannot be evaluated is tried again, shorter. If a step must become shorter than a stroke, the
/// extrapolation stops there and says why.
///
/// # Errors
/// If the growth cannot be evaluated at `start`.
pub fn extrapolate(
    start: &[f64],
    total: f64,
    tolerance: f64,
    growth: impl FnMut(f64, &[f64]) -> Result<Growth>,
) -> Result<Extrapolation> {
    ensure!(total > 0.0 && total.is_finite(), "the number of strokes is {total}; it must be finite and above 0");
    ensure!(tolerance > 0.0, "the relative tolerance is {tolerance}; it must be above 0");
    let mut evaluations = Evaluations { growth, known: vec![] };
    let mut first = evaluations.at(0.0, start)?;
    let (mut state, mut strokes, mut length) = (start.to_vec(), 0.0, FIRST * total);
    let mut done = Extrapolation::default();
    for _ in 0..MOST_ATTEMPTS {
        let left = total - strokes;
        if left <= SLIVER * total {
            return Ok(done);
        }
        length = length.min(left);
        let (factor, why) = match evaluations.step(strokes, &state, first, length) {
            Ok(step) => {
                let ratio = step.error_ratio(&state, tolerance);
                let factor = (SAFETY * ratio.cbrt().recip()).clamp(SHORTER, LONGER);
                if ratio <= 1.0 {
                    (first, strokes) = (step.stages[3], strokes + length);
                    state.clone_from(&step.state);
                    length *= factor;
                    done.steps.push(step);
                    continue;
                }
                (factor, anyhow!("the error of a step of {length} strokes is {ratio:.3} times its bound"))
            }
            Err(error) => (SHORTER, error),
        };
        done.rejected += 1;
        length *= factor;
        if length < SHORTEST {
            done.stopped = Some(why.context(format!("stopped after {strokes:.4e} of {total:e} strokes")));
            return Ok(done);
        }
    }
    done.stopped =
        Some(anyhow!("stopped after {strokes:.4e} of {total:e} strokes: {MOST_ATTEMPTS} steps were not enough"));
    Ok(done)
}

/// All evaluations so far, and the function.
struct Evaluations<F> {
    growth: F,
    known: Vec<Growth>,
}

impl<F: FnMut(f64, &[f64]) -> Result<Growth>> Evaluations<F> {
    /// Number of a new evaluation.
    fn at(&mut self, strokes: f64, state: &[f64]) -> Result<usize> {
        let found = (self.growth)(strokes, state).with_context(|| format!("at {strokes:.4e} strokes"))?;
        self.known.push(found);
        Ok(self.known.len() - 1)
    }

    /// One step whose k1 is evaluation number `first`.
    fn step(&mut self, strokes: f64, state: &[f64], first: usize, length: f64) -> Result<Step> {
        let along = |growth: &Growth, share: f64| -> Vec<f64> {
            state.iter().zip(&growth.mean).map(|(value, rate)| value + share * length * rate).collect()
        };
        let second = self.at(strokes + 0.5 * length, &along(&self.known[first], 0.5))?;
        let third = self.at(strokes + 0.75 * length, &along(&self.known[second], 0.75))?;
        let stages = [first, second, third].map(|stage| self.known[stage].clone());
        let all = 0..state.len();
        let sum = |place: usize| weighted(stages.each_ref().map(|k| k.mean[place]));
        let end: Vec<f64> = all.clone().map(|place| state[place] + length * sum(place)).collect();
        let fourth = self.at(strokes + length, &end)?;
        let last = &self.known[fourth];
        let error = |place: usize| {
            let rates = stages.iter().chain([last]).map(|k| k.mean[place]);
            length * rates.zip(ERROR).map(|(rate, weight)| weight * rate).sum::<f64>().abs()
        };
        let scatter = |place: usize| {
            let squares = stages.iter().zip(WEIGHTS).map(|(k, weight)| (weight * k.error[place]).powi(2));
            length * squares.sum::<f64>().sqrt()
        };
        let (error, scatter) = (all.clone().map(error).collect(), all.map(scatter).collect());
        Ok(Step { length, stages: [first, second, third, fourth], state: end, error, scatter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: f64 = 50e-6;
    const RATE: f64 = 2e-12;
    const STROKES: f64 = 1.5e7;

    fn power(exponent: i32, state: &[f64], error: f64) -> Growth {
        Growth { mean: vec![RATE * (state[0] / START).powi(exponent)], error: vec![error] }
    }

    #[test]
    fn powers_of_the_clearance_grow_as_their_closed_forms() {
        let exact =
            [START + RATE * STROKES, START * (RATE * STROKES / START).exp(), START / (1.0 - RATE * STROKES / START)];
        for ((exponent, exact), steps) in (0..).zip(exact).zip([3, 11, 37]) {
            let found =
                extrapolate(&[START], STROKES, 1e-4, |_, state| Ok(power(exponent, state, 0.0))).expect("an end");
            let end = found.steps.last().expect("a step").state[0];
            let off = (end - exact).abs() / (exact - START);
            assert!(off <= 2e-5, "exponent {exponent}: off by {off:e} of the growth");
            assert_eq!(found.steps.len(), steps, "exponent {exponent}");
            assert!((found.strokes() - STROKES).abs() <= 1e-9 * STROKES);
        }
    }

    #[test]
    fn a_component_of_its_own_does_not_shorten_another() {
        let both = |_: f64, state: &[f64]| {
            let [first, second] = [state[0], state[1]].map(|clearance| power(2, &[clearance], 0.0).mean[0]);
            Ok(Growth { mean: vec![first, 0.0 * second], error: vec![0.0; 2] })
        };
        let found = extrapolate(&[START, START], STROKES, 1e-4, both).expect("an end");
        assert_eq!(found.steps.len(), 37);
        assert_eq!(found.steps.last().expect("a step").state[1], START);
    }

    #[test]
    fn scatter_is_no_reason_for_a_shorter_step() {
        let mut call = 0;
        let noisy = |_: f64, state: &[f64]| {
            call += 1;
            let mut growth = power(0, state, 0.1 * RATE);
            growth.mean[0] *= if call % 2 == 0 { 1.1 } else { 0.9 };
            Ok(growth)
        };
        let found = extrapolate(&[START], STROKES, 1e-4, noisy).expect("an end");
        assert!(found.steps.len() <= 4 && found.rejected == 0, "{found:?}");
        let variance: f64 = found.steps.iter().map(|step| step.scatter[0].powi(2)).sum();
        let off = found.steps.last().expect("a step").state[0] - START - RATE * STROKES;
        assert!(off.abs() <= 3.0 * variance.sqrt(), "{off:e}, {:e}", variance.sqrt());
    }

    #[test]
    fn it_stops_where_growth_ends_and_says_why() {
        let limited = |_: f64, state: &[f64]| {
            ensure!(state[0] < 70e-6, "too far");
            Ok(power(0, state, 0.0))
        };
        let found = extrapolate(&[START], STROKES, 1e-4, limited).expect("an end");
        let end = found.steps.last().expect("a step").state[0];
        assert!((70e-6 - end) / 70e-6 < 1e-6, "{end:e}");
        let why = format!("{:#}", found.stopped.expect("a reason"));
        assert!(why.starts_with("stopped after 1.0000e7 of 1.5e7 strokes: ") && why.contains("too far"), "{why}");
        assert!(extrapolate(&[80e-6], STROKES, 1e-4, limited).is_err());
    }
}
