//! How strongly a motion responds: an output over whole turns, reduced to one number.

use super::{Flow, Machine};
use crate::output::Output;
use crate::sweep::quantity::{Reduction, shares};
use anyhow::{Result, ensure};
use std::f64::consts::TAU;
use std::str::FromStr;

/// Samples per turn, evenly spaced over the crank's angle.
const SAMPLES: usize = 500;
/// Samples from one of these to the next, in search of the largest value: a blow lasts microseconds.
const BETWEEN: usize = 40;
/// A crank this many times slower than at the start is not sampled more densely.
const SLOWEST: f64 = 10.0;

/// A reduced output, such as `rod.deflection:peak`.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// As it was written.
    pub text: String,
    output: Output,
    reduce: Reduction,
}

/// Values of an output, and when they were taken.
#[derive(Default)]
struct Samples {
    /// [s]
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Samples {
    /// Adds the value of `output` in the current state of a machine.
    fn add(&mut self, machine: &mut Machine, output: &Output) {
        self.times.push(machine.time());
        self.values.push(output.value(&machine.outputs()));
    }
}

impl FromStr for Response {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let (name, word) = text.split_once(':').unwrap_or((text, "peak"));
        let reduce = word.parse()?;
        let output = Output::named(name)?;
        ensure!(
            !output.is_of_an_interval() && !output.is_a_sum(),
            "`{name}` tells what happened since the start or since an earlier communication point; a response needs an \
             output that the state determines"
        );
        Ok(Self { text: text.into(), output, reduce })
    }
}

impl Response {
    /// The name of the output.
    pub fn name(&self) -> &str {
        self.text.split_once(':').map_or(self.text.as_str(), |(name, _)| name)
    }

    /// Its value over the next turns of a machine.
    ///
    /// # Errors
    /// If the machine cannot go on.
    pub fn of(&self, machine: &mut Machine, turns: usize) -> Result<f64> {
        let start = machine.turned();
        let mut samples = Samples::default();
        samples.add(machine, &self.output);
        let of_extremes = matches!(self.reduce, Reduction::Max | Reduction::Min | Reduction::Peak | Reduction::Range);
        for sample in 1..=turns * SAMPLES {
            if of_extremes {
                self.sample_on(machine, &mut samples)?;
            }
            machine.advance_turned(start + TAU * sample as f64 / SAMPLES as f64)?;
            samples.add(machine, &self.output);
        }
        Ok(self.reduce.over(&samples.values, &shares(&samples.times)))
    }

    /// Adds the values at the instants between a sample and the next one, unless the crank nearly stands still.
    fn sample_on(&self, machine: &mut Machine, samples: &mut Samples) -> Result<()> {
        let (from, apart) = (machine.time(), TAU / SAMPLES as f64 / machine.outputs().crank.speed.abs());
        if apart < SLOWEST * machine.turn() / SAMPLES as f64 {
            for part in 1..BETWEEN {
                machine.advance(from + apart * part as f64 / BETWEEN as f64)?;
                samples.add(machine, &self.output);
            }
        }
        Ok(())
    }
}
