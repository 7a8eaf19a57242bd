//! One number of a run: an output, reduced over time, or over its values at a crank angle.

use super::values::radians;
use crate::run::ANGLE;
use crate::trajectory::Trajectory;
use anyhow::{Result, anyhow, ensure};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::str::FromStr;

/// A quantity that is kept.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// Name of an output, or of a vector with the components x and y, whose length is taken: `joint.C.force`.
    pub of: String,
    /// The reduction of many values to one.
    pub reduce: Reduction,
    /// [rad] If set, only the values at this crank angle count, interpolated between communication points.
    #[serde(default, deserialize_with = "radians")]
    pub at: Option<f64>,
}

/// [turns] By how much rounding may shift a communication point that is at an angle, or at the end of whole turns.
const ROUNDING: f64 = 1e-9;

/// The reduction of many values to one. Sums run from the first to the last value. Over time, mean, root mean square and
/// standard deviation are those of the function between the communication points, by the trapezoidal rule.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reduction {
    /// Minimum.
    Min,
    /// Maximum.
    Max,
    /// Largest absolute value.
    Peak,
    /// Maximum minus minimum.
    Range,
    /// Mean.
    Mean,
    /// Root mean square.
    Rms,
    /// Standard deviation: over time, or of a sample.
    Deviation,
    /// Last value.
    Last,
}

impl FromStr for Reduction {
    type Err = anyhow::Error;

    fn from_str(word: &str) -> Result<Self> {
        serde_json::from_value(word.into())
            .map_err(|_| anyhow!("`{word}` is no reduction: min, max, peak, range, mean, rms, deviation, last"))
    }
}

impl Quantity {
    /// Its value in a run, without the first `transient` turns.
    ///
    /// # Errors
    /// If there is no such output, if there are no values to reduce, or if the result is not finite.
    pub fn of(&self, trajectory: &Trajectory, transient: f64) -> Result<f64> {
        let values = match trajectory.column(&self.of) {
            Ok(column) => column.to_vec(),
            Err(error) => match ["x", "y"].map(|axis| trajectory.column(&format!("{}.{axis}", self.of))) {
                [Ok(x), Ok(y)] => x.iter().zip(y).map(|(x, y)| (x * x + y * y).sqrt()).collect(),
                _ => return Err(error),
            },
        };
        let angles = trajectory.column(ANGLE)?;
        let start = angles.first().copied().unwrap_or_default();
        let kept = TAU * (transient - ROUNDING);
        let first = angles.iter().position(|angle| (angle - start).abs() >= kept).unwrap_or(angles.len());
        let (angles, values) = (&angles[first..], &values[first..]);
        let (value, from) = match self.at {
            None => {
                let value = self.reduce.over(values, &shares(&trajectory.times()[first..]));
                (value, format!("{} values", values.len()))
            }
            Some(at) => {
                let passed = passages(angles, values, at);
                (self.reduce.of(&passed), format!("{} passages of {at} rad", passed.len()))
            }
        };
        ensure!(value.is_finite(), "{} of {from} is {value}", self.of);
        Ok(value)
    }
}

/// [s] The time that each of these instants stands for: half of the intervals on both sides, so that sums are those of the
/// trapezoidal rule.
pub fn shares(times: &[f64]) -> Vec<f64> {
    let last = times.len().saturating_sub(1);
    (0..times.len()).map(|i| (times[last.min(i + 1)] - times[i.saturating_sub(1)]) / 2.0).collect()
}

/// Values at the angle `at`, in either direction of rotation. A run that starts there has not passed it, one that ends there
/// has; a communication point that is off the angle by rounding is there.
fn passages(angles: &[f64], values: &[f64], at: f64) -> Vec<f64> {
    let turns = |angle: f64| {
        let turns = (angle - at) / TAU;
        if (turns - turns.round()).abs() < ROUNDING { turns.round() } else { turns }
    };
    let mut found = Vec::new();
    for i in 1..angles.len() {
        let (before, after) = (turns(angles[i - 1]), turns(angles[i]));
        let last = if after >= before { f64::floor } else { f64::ceil };
        let passed = last(after);
        if last(before) != passed {
            let share = (passed - before) / (after - before);
            found.push(values[i - 1] + share * (values[i] - values[i - 1]));
        }
    }
    found
}

impl Reduction {
    /// Reduces values that stand for these shares of time, in any unit. The result of no time is NaN for means.
    pub fn over(self, values: &[f64], shares: &[f64]) -> f64 {
        let whole: f64 = shares.iter().sum();
        let mean = |of: &dyn Fn(f64) -> f64| {
            values.iter().zip(shares).map(|(value, share)| share * of(*value)).sum::<f64>() / whole
        };
        match self {
            Self::Mean => mean(&|value| value),
            Self::Rms => mean(&|value| value * value).sqrt(),
            Self::Deviation => {
                let middle = mean(&|value| value);
                mean(&|value| (value - middle) * (value - middle)).sqrt()
            }
            Self::Min | Self::Max | Self::Peak | Self::Range | Self::Last => self.of(values),
        }
    }

    /// Reduces a list. The result of an empty list is NaN.
    pub fn of(self, values: &[f64]) -> f64 {
        let count = values.len() as f64;
        let mean = || values.iter().sum::<f64>() / count;
        let least = || values.iter().copied().reduce(f64::min).unwrap_or(f64::NAN);
        let greatest = || values.iter().copied().reduce(f64::max).unwrap_or(f64::NAN);
        match self {
            Self::Min => least(),
            Self::Max => greatest(),
            Self::Peak => least().abs().max(greatest().abs()),
            Self::Range => greatest() - least(),
            Self::Mean => mean(),
            Self::Rms => (values.iter().map(|value| value * value).sum::<f64>() / count).sqrt(),
            Self::Deviation => {
                let mean = mean();
                (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0).max(0.0))
                    .sqrt()
            }
            Self::Last => values.last().copied().unwrap_or(f64::NAN),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trajectory() -> Trajectory {
        let mut trajectory = Trajectory::new([ANGLE, "v", "f.x", "f.y"].map(String::from));
        for i in 0..=40_i32 {
            let turns = f64::from(i) / 10.0;
            trajectory.push(turns, &[TAU * turns, turns * turns, 3.0 * turns, -4.0 * turns]);
        }
        trajectory
    }

    fn value(of: &str, reduce: Reduction, at: Option<f64>, transient: f64) -> Result<f64> {
        Quantity { of: of.into(), reduce, at }.of(&trajectory(), transient)
    }

    #[test]
    fn values_are_reduced_after_the_transient() {
        for (reduce, wanted) in [
            (Reduction::Min, 9.0),
            (Reduction::Max, 16.0),
            (Reduction::Range, 7.0),
            (Reduction::Last, 16.0),
            (Reduction::Peak, 16.0),
        ] {
            assert_eq!(value("v", reduce, None, 3.0).ok(), Some(wanted), "{reduce:?}");
        }
        assert_eq!(Reduction::Mean.of(&[1.0, 2.0, 6.0]), 3.0);
        assert_eq!(Reduction::Deviation.of(&[1.0, 2.0, 6.0]), 7f64.sqrt());
        assert_eq!(Reduction::Rms.of(&[1.0, -7.0]), 5.0);
        assert!([&[][..], &[1.0]].into_iter().all(|few| Reduction::Deviation.of(few).is_nan()));
    }

    #[test]
    fn over_whole_turns_a_sine_has_the_moments_of_its_integrals() {
        let mut trajectory = Trajectory::new([ANGLE, "sine"].map(String::from));
        // Eight points of a turn, both ends of three turns among them; then one more, nearer to its neighbour.
        for i in 0..=24_i32 {
            let turns = f64::from(i) / 8.0;
            trajectory.push(turns, &[TAU * turns, 2.0 + (TAU * turns).cos()]);
        }
        let of = |trajectory: &Trajectory, reduce| {
            Quantity { of: "sine".into(), reduce, at: None }.of(trajectory, 1.0).expect("a value")
        };
        let known = [(Reduction::Mean, 2.0), (Reduction::Rms, 4.5f64.sqrt()), (Reduction::Deviation, 0.5f64.sqrt())];
        for (reduce, known) in known {
            assert!((of(&trajectory, reduce) - known).abs() < 1e-14, "{reduce:?}");
        }
        trajectory.push(3.01, &[TAU * 3.01, 3.0]);
        assert!((of(&trajectory, Reduction::Mean) - (2.0 * 2.0 + 0.01 * 3.0) / 2.01).abs() < 1e-14);
    }

    #[test]
    fn a_vector_counts_by_its_length() {
        assert!((value("f", Reduction::Last, None, 0.0).expect("a value") - 20.0).abs() < 1e-12);
    }

    #[test]
    fn passages_are_interpolated_forwards_and_backwards() {
        let angles = [0.0, 2.0, 4.0, 6.0, 4.0, 2.0];
        let values = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(passages(&angles, &values, 3.0), [1.5, 4.5]);
        assert_eq!(passages(&angles, &values, 3.0 - TAU).len(), 2);
        // Two turns backwards from the angle on.
        let (angles, values) = ([0.0, -0.6, -1.0, -1.5, -2.0].map(|turns| TAU * turns), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(passages(&angles, &values, 0.0), [2.0, 4.0]);
    }

    #[test]
    fn rounding_takes_neither_a_passage_nor_a_sample_away() {
        let (angles, values) = ([0.0, 0.5, 1.0, 1.5, 2.0].map(|turns: f64| TAU * turns), [0.0, 1.0, 2.0, 3.0, 4.0]);
        for off in [-1e-10, 0.0, 1e-10] {
            for place in 0..5 {
                let mut near = angles;
                near[place] += off;
                let (passed, back) = (passages(&near, &values, 0.0), passages(&near.map(|angle| -angle), &values, 0.0));
                assert!(
                    passed.len() == 2 && (passed[0] - 2.0).abs() < 1e-9 && (passed[1] - 4.0).abs() < 1e-9,
                    "{passed:?}"
                );
                assert_eq!(passed, back);
                let mut trajectory = Trajectory::new([ANGLE, "v"].map(String::from));
                for (time, (angle, value)) in near.into_iter().zip(values).enumerate() {
                    trajectory.push(time as f64, &[angle, value]);
                }
                let mean = Quantity { of: "v".into(), reduce: Reduction::Mean, at: None };
                assert_eq!(mean.of(&trajectory, 1.0).ok(), Some(3.0));
            }
        }
    }

    #[test]
    fn what_is_not_there_is_named() {
        for (of, at, transient, word) in [
            ("w", None, 0.0, "`w`"),
            ("v", Some(1.0), 3.9, "of 0 passages of 1 rad is NaN"),
            ("v", None, 9.0, "0 values"),
        ] {
            let error = value(of, Reduction::Mean, at, transient).expect_err(of);
            assert!(error.to_string().contains(word), "{error}");
        }
    }
}
