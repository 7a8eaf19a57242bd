//! Where a quantity of a run is largest or smallest, and its derivatives there.
//!
//! Where the quantity turns smoothly its slope over time is zero, which tells the instant far more exactly than values do:
//! beside an impact the derivative by a parameter changes by its own size within microseconds. Forces have corners, too:
//! where a contact closes elsewhere, or friction reaches its full value. The largest value f(t) at a corner t(p) that moves
//! with the parameter p is that of both sides, so that
//!
//! df/dp = ∂f₋/∂p + ḟ₋·dt/dp = ∂f₊/∂p + ḟ₊·dt/dp  ⇒  df/dp = (ḟ₊·∂f₋/∂p − ḟ₋·∂f₊/∂p)/(ḟ₊ − ḟ₋).

use super::Reading;
use crate::dynamics::{Flow, Machine};
use crate::output::Output;
use anyhow::Result;
use slidercrank::scene::read::SceneFile;

/// Rounds of the search by values, each among this many times in the neighbourhood of the best value before.
const ROUNDS: usize = 3;
const TIMES: usize = 12;
/// The least slope that is left where a quantity turns in a corner, as a share of the change of slope; half of it is left
/// if both sides are equally steep.
const CORNER: f64 = 0.05;
/// Distance of the readings beside a corner, in that of the last round's times: differences of outputs over time reach some
/// nanoseconds.
const BESIDE: f64 = 2.0;
/// The least step of a jump, as a multiple of what slopes explain.
const JUMP: f64 = 2.0;

/// When a quantity is taken.
#[derive(Clone, Copy, Debug)]
pub enum Instant {
    /// At a time [s].
    At(f64),
    /// On both sides of a corner in which it turns, at multiples of `apart`: differences of outputs must not reach across.
    Corner {
        /// [s]
        time: f64,
        /// [s]
        apart: f64,
    },
}

/// Weights with which three values at equal distances tell the next one: those of a parabola.
const NEXT: [f64; 3] = [1.0, -3.0, 3.0];

impl Instant {
    /// The times [s] at which the quantity is read.
    pub fn times(self) -> Vec<f64> {
        match self {
            Self::At(time) => vec![time],
            Self::Corner { time, apart } => [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0].map(|k| time + k * apart).into(),
        }
    }

    /// What the next of some readings, those at its times, say about the quantity.
    ///
    /// # Panics
    /// If there are too few.
    pub fn reading(self, mut readings: impl Iterator<Item = Reading>) -> Reading {
        let mut next = || readings.next().expect("a reading at each time");
        let Self::Corner { time, .. } = self else { return next() };
        let before = extrapolated([next(), next(), next()]);
        let mut after = [next(), next(), next()];
        after.reverse();
        let after = extrapolated(after);
        let slope = |(left, right): (f64, f64)| (after.rate * left - before.rate * right) / (after.rate - before.rate);
        let slopes = before.slopes.and_then(|left| Ok(left.into_iter().zip(after.slopes?).map(slope).collect()));
        // Where both sides meet.
        let late = (before.value - after.value) / (after.rate - before.rate);
        Reading { time: time + late, value: before.value + before.rate * late, rate: 0.0, slopes }
    }
}

/// What three readings at equal distances say about the next one.
fn extrapolated(readings: [Reading; 3]) -> Reading {
    let next =
        |of: &dyn Fn(&Reading) -> f64| readings.iter().zip(NEXT).map(|(reading, weight)| weight * of(reading)).sum();
    let (value, rate) = (next(&|reading| reading.value), next(&|reading| reading.rate));
    let time = readings[2].time;
    let slopes = readings.into_iter().map(|reading| reading.slopes).collect::<Result<Vec<_>>>().map(|slopes| {
        let slope = |k: usize| slopes.iter().zip(NEXT).map(|(slopes, weight)| weight * slopes[k]).sum();
        (0..slopes[0].len()).map(slope).collect()
    });
    Reading { time, value, rate, slopes }
}

/// The search for the largest value of an output of a run. `sign` gives the sign with which a value counts.
pub struct Search<'a, S> {
    /// The scene of the run.
    pub file: &'a SceneFile,
    /// The output.
    pub of: &'a Output,
    /// 1 for the largest value, -1 for the smallest, that of the value for the largest magnitude.
    pub sign: S,
}

/// The best of some times, and their distance [s].
struct Best {
    time: f64,
    apart: f64,
}

/// A value that counts, and its slope over time.
#[derive(Clone, Copy)]
struct Height {
    value: f64,
    slope: f64,
}

impl<S: Fn(f64) -> f64> Search<'_, S> {
    /// The instant at which the output is largest, at or near one of these equidistant times [s].
    ///
    /// # Errors
    /// If the run cannot go on.
    pub fn among(&self, times: &[f64]) -> Result<Instant> {
        let window = [times[0], times[times.len() - 1]];
        let best = self.narrowed(self.best(times)?, window)?;
        let around = self.around(&best, window);
        let heights = self.heights(&around)?;
        let [first, middle, last] = [0, 1, 2].map(|place| heights[place].slope);
        // On a short piece of a smooth curve, slopes lie on a straight line.
        let share = (around[1] - around[0]) / (around[2] - around[0]);
        let bend = (middle - (first + share * (last - first))).abs();
        let place = usize::from(middle > 0.0);
        let ([from, to], [before, after]) = ([around[place], around[place + 1]], [heights[place], heights[place + 1]]);
        let (apart, fall) = (to - from, before.slope - after.slope);
        if first > 0.0 && last < 0.0 {
            let zero = from + apart * before.slope / fall;
            if bend <= CORNER * (first - last) && self.heights(&[zero])?[0].slope.abs() <= CORNER * (first - last) {
                return Ok(Instant::At(zero));
            }
        }
        let turns = before.slope > 0.0 && after.slope < 0.0;
        let jumps = (after.value - before.value).abs() > JUMP * apart * before.slope.abs().max(after.slope.abs());
        if !turns || jumps {
            // At an end, or beside the jump of an input.
            return Ok(Instant::At(self.narrowed(best, window)?.time));
        }
        // Where the tangents of both sides meet.
        let time = from + (after.value - before.value - after.slope * apart) / fall;
        Ok(Instant::Corner { time, apart: BESIDE * apart })
    }

    /// The best time in ever smaller neighbourhoods.
    fn narrowed(&self, mut best: Best, window: [f64; 2]) -> Result<Best> {
        for _ in 0..ROUNDS {
            let [start, _, end] = self.around(&best, window);
            let times: Vec<f64> = (0..=TIMES).map(|k| start + (end - start) * k as f64 / TIMES as f64).collect();
            best = self.best(&times)?;
        }
        Ok(best)
    }

    fn around(&self, best: &Best, [begin, end]: [f64; 2]) -> [f64; 3] {
        [(best.time - best.apart).max(begin), best.time, (best.time + best.apart).min(end)]
    }

    fn best(&self, times: &[f64]) -> Result<Best> {
        let mut machine = Machine::start(self.file)?;
        let mut best = (f64::NEG_INFINITY, times[0]);
        for &time in times {
            machine.advance(time)?;
            let value = self.of.value(&machine.outputs());
            let value = (self.sign)(value) * value;
            if value > best.0 {
                best = (value, time);
            }
        }
        Ok(Best { time: best.1, apart: times.get(1).map_or(0.0, |next| next - times[0]) })
    }

    fn heights(&self, times: &[f64]) -> Result<Vec<Height>> {
        let mut machine = Machine::start(self.file)?;
        let height = |&time: &f64| {
            machine.advance(time)?;
            let outputs = machine.outputs();
            let (value, slope) = (self.of.value(&outputs), self.of.slope(&outputs, &machine.output_rates()));
            let sign = (self.sign)(value);
            Ok(Height { value: sign * value, slope: sign * slope })
        };
        times.iter().map(height).collect()
    }
}
