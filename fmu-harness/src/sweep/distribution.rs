//! Distributions in SI units: random values, mean and standard deviation.

use super::study::Distribution;
use super::values::Number;
use anyhow::{Context, Result, bail, ensure};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Normal, Uniform};
use slidercrank::scene::parameter::{Kind, Parameter};

/// Number of draws outside a truncated range after which the range counts as empty.
const TRIES: usize = 10_000;
/// Intervals of Simpson's rule for the moments.
const INTERVALS: usize = 2000;
/// Standard deviations beyond which a normal distribution counts as 0.
const FARTHEST: f64 = 12.0;

/// The distribution of one parameter between bounds.
pub struct Law {
    parameter: &'static Parameter,
    shape: Shape,
    min: f64,
    max: f64,
}

/// The distribution of the number that is drawn.
enum Shape {
    Uniform(Uniform<f64>),
    /// The logarithm of the parameter is drawn.
    LogUniform(Uniform<f64>),
    Normal(Normal<f64>),
}

impl Law {
    /// The distribution of a parameter, as a study has it.
    ///
    /// # Errors
    /// If the parameter is not real, cannot have a value, or the numbers are no distribution.
    pub fn of(parameter: &'static Parameter, distribution: &Distribution) -> Result<Self> {
        let name = parameter.name;
        let Kind::Real { min: least, max: greatest, .. } = parameter.kind else {
            bail!("`{name}` is not a real number and cannot be drawn")
        };
        let value = |number: &Number| number.value(parameter);
        let ordered = |min: f64, max: f64| {
            ensure!(min <= max, "`{name}`: min = {min} is above max = {max}");
            Ok((min, max))
        };
        let between = |min: f64, max: f64| Uniform::new_inclusive(min, max).with_context(|| format!("`{name}`"));
        match distribution {
            Distribution::Uniform { min, max } => {
                let (min, max) = ordered(value(min)?, value(max)?)?;
                Ok(Self { parameter, shape: Shape::Uniform(between(min, max)?), min, max })
            }
            Distribution::LogUniform { min, max } => {
                let (min, max) = ordered(value(min)?, value(max)?)?;
                ensure!(min > 0.0, "`{name}`: a logarithm needs values above 0, not {min}");
                Ok(Self { parameter, shape: Shape::LogUniform(between(min.ln(), max.ln())?), min, max })
            }
            Distribution::Normal { mean, deviation, min, max } => {
                // A deviation has the parameter's unit, but not its bounds.
                let deviation = deviation.in_unit(parameter.unit()).with_context(|| format!("`{name}`: deviation"))?;
                ensure!(
                    deviation >= 0.0 && deviation.is_finite(),
                    "`{name}`: deviation = {deviation} is not allowed: 0 or more, and finite"
                );
                let normal = Normal::new(value(mean)?, deviation);
                let shape = Shape::Normal(normal.with_context(|| format!("`{name}`: deviation = {deviation}"))?);
                let [min, max] = [min, max].map(|bound| bound.as_ref().map(value).transpose());
                let (min, max) = ordered(min?.unwrap_or(least), max?.unwrap_or(greatest))?;
                Ok(Self { parameter, shape, min, max })
            }
        }
    }

    /// A random value.
    ///
    /// # Errors
    /// If the values fall outside the bounds too often.
    pub fn sample(&self, generator: &mut ChaCha8Rng) -> Result<f64> {
        for _ in 0..TRIES {
            let value = self.value(match &self.shape {
                Shape::Uniform(uniform) | Shape::LogUniform(uniform) => uniform.sample(generator),
                Shape::Normal(normal) => normal.sample(generator),
            });
            if (self.min..=self.max).contains(&value) {
                return Ok(value);
            }
        }
        bail!("`{}`: {TRIES} draws all fell outside its bounds", self.parameter.name)
    }

    /// Mean and standard deviation, with the bounds.
    pub fn moments(&self) -> (f64, f64) {
        let (low, high) = match &self.shape {
            Shape::Uniform(_) => (self.min, self.max),
            Shape::LogUniform(_) => (self.min.ln(), self.max.ln()),
            Shape::Normal(normal) => {
                let far = FARTHEST * normal.std_dev();
                (self.min.max(normal.mean() - far), self.max.min(normal.mean() + far))
            }
        };
        if low >= high {
            return (self.value(low), 0.0);
        }
        let place = |k: usize| low + (high - low) * k as f64 / INTERVALS as f64;
        // Simpson's weights are 1, 4, 2, 4, …, 2, 4, 1.
        let simpson = |k: usize| if k == 0 || k == INTERVALS { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
        let points: Vec<(f64, f64)> =
            (0..=INTERVALS).map(|k| (self.value(place(k)), simpson(k) * self.density(place(k)))).collect();
        let total: f64 = points.iter().map(|(_, weight)| weight).sum();
        let average = |of: &dyn Fn(f64) -> f64| points.iter().map(|(x, weight)| weight * of(*x)).sum::<f64>() / total;
        let mean = average(&|x| x);
        (mean, average(&|x| (x - mean).powi(2)).sqrt())
    }

    /// The density of the drawn number, but for a factor.
    fn density(&self, drawn: f64) -> f64 {
        match &self.shape {
            Shape::Uniform(_) | Shape::LogUniform(_) => 1.0,
            Shape::Normal(normal) => (-0.5 * ((drawn - normal.mean()) / normal.std_dev()).powi(2)).exp(),
        }
    }

    /// The parameter's value.
    fn value(&self, drawn: f64) -> f64 {
        match self.shape {
            Shape::LogUniform(_) => drawn.exp().clamp(self.min, self.max),
            Shape::Uniform(_) | Shape::Normal(_) => drawn,
        }
    }
}
