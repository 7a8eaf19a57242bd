//! Linear tolerance analysis: the standard deviations of a study's quantities to first order, and the share of each
//! parameter, σ² = Σ (∂y/∂p·σ_p)².
//!
//! The derivatives are those of [`sensitivity`](crate::sensitivity) where all parameters have the means of their
//! distributions. Beside a Monte Carlo of the same study they tell where the quantities are not linear.

use super::distribution::Law;
use super::quantity::Reduction;
use super::study::{Study, parameter};
use crate::frame::Frame;
use crate::scenes::Scenario;
use crate::sensitivity::{Experiment, Sensitivities, Wanted};
use anyhow::{Context, Result, anyhow, ensure};
use slidercrank::scene::DriveMode;

/// Quantile of the standard normal distribution at 97.5 %.
pub const NORMAL: f64 = 1.959_963_984_540_054;
/// Growth of the distance of neighbouring motions from which on it is a reason why a quantity is not linear.
const PARTED: f64 = 10.0;
/// Share of its size by which a quantity that does not vary may seem to.
const ROUNDING: f64 = 1e-13;
/// The least share of the variance that a linear quantity's derivatives explain.
const EXPLAINED: f64 = 0.8;
/// Parameter that changes how long a turn takes.
const SPEED: &str = "crank.speed_start";

/// The linear analysis of a study.
pub struct Linear {
    /// Derivatives of those quantities that have them.
    pub found: Sensitivities,
    /// The standard deviation of each parameter.
    pub deviations: Vec<f64>,
    /// The quantities of the study in their order: the row of `found`, or why there is none.
    pub rows: Vec<(String, Result<usize>)>,
    turns: f64,
}

/// The standard deviation of a quantity by a Monte Carlo and to first order.
pub struct Comparison {
    /// Standard deviation of the Monte Carlo.
    pub deviation: f64,
    /// Its standard error.
    pub error: f64,
    /// Standard deviation to first order.
    pub linear: f64,
    /// Share of the Monte Carlo's variance that the straight line through the mean of all draws explains.
    pub explained: f64,
    /// The largest absolute value of the Monte Carlo.
    pub size: f64,
}

impl Linear {
    /// The linear analysis of a study.
    ///
    /// # Errors
    /// If parameters have values rather than distributions, or the scene cannot run or has no tangent.
    pub fn of(study: &Study, scenario: &Scenario) -> Result<Self> {
        ensure!(!study.random.is_empty(), "a linear analysis needs parameters in [random]");
        ensure!(study.grid.is_empty(), "a linear analysis needs all parameters in [random], but some are in [grid]");
        ensure!(study.table.is_none(), "a linear analysis needs all parameters in [random], but some are in `table`");
        let mut file = scenario.file.clone();
        let mut parameters = vec![];
        let mut deviations = vec![];
        for (name, distribution) in &study.random {
            let parameter = parameter(name)?;
            let (mean, deviation) = Law::of(parameter, distribution)?.moments();
            parameter.write(&mut file.scene, mean)?;
            parameters.push(parameter);
            deviations.push(deviation);
        }
        file.scene.check().context("the scene at the means of the distributions")?;
        let mut wanted = vec![];
        let mut rows = vec![];
        for name in study.keep.keys() {
            let row = differentiable(study, file.scene.drive.mode, name).map(|quantity| {
                wanted.push(quantity);
                wanted.len() - 1
            });
            rows.push((name.clone(), row));
        }
        let (turns, transient) = (study.run.turns, study.run.transient);
        let found = Experiment { file: &file, turns, transient, counted: true }.run(&wanted, &parameters)?;
        Ok(Self { found, deviations, rows, turns })
    }

    /// Derivatives of a quantity, times the standard deviations of the parameters.
    ///
    /// # Errors
    /// If it has no derivatives, with the reason.
    pub fn parts(&self, row: &Result<usize>) -> Result<Vec<f64>> {
        let again = |error: &anyhow::Error| anyhow!("{error:#}");
        let row = *row.as_ref().map_err(again)?;
        let slopes = self.found.rows[row].slopes.as_ref().map_err(again)?;
        Ok(slopes.iter().zip(&self.deviations).map(|(slope, deviation)| slope * deviation).collect())
    }

    /// A quantity of the study beside its values in all runs.
    ///
    /// # Errors
    /// As [`parts`](Self::parts), and if fewer than two runs came to their ends.
    pub fn compare(&self, name: &str, row: &Result<usize>, runs: &Frame) -> Result<Comparison> {
        let parts = self.parts(row)?;
        let missing = || format!("the runs have no column `{name}`");
        let values = runs.column(name).with_context(missing)?;
        let line: Vec<f64> = (0..values.len()).map(|run| self.along(&parts, runs, run)).collect();
        let kept = || values.iter().zip(&line).filter(|(value, _)| value.is_finite());
        let (values, rest): (Vec<f64>, Vec<f64>) = kept().map(|(value, line)| (*value, value - line)).unzip();
        ensure!(values.len() > 1, "a standard deviation needs two runs that come to their ends, not {}", values.len());
        let spread = Reduction::Deviation.of(&values);
        Ok(Comparison {
            deviation: spread,
            error: standard_error(&values),
            linear: deviation(&parts),
            explained: 1.0 - (Reduction::Deviation.of(&rest) / spread).powi(2),
            size: Reduction::Peak.of(&values),
        })
    }

    /// The change of a quantity in a run to first order.
    fn along(&self, parts: &[f64], runs: &Frame, run: usize) -> f64 {
        let change = |place: usize| {
            let drawn = runs.column(self.found.parameters[place].name).map_or(f64::NAN, |values| values[run]);
            (drawn - self.found.values[place]) / self.deviations[place]
        };
        // A parameter that does not vary has no part.
        parts.iter().enumerate().filter(|(_, part)| **part != 0.0).map(|(place, part)| part * change(place)).sum()
    }

    /// Why a quantity with these [`parts`](Self::parts) may be no linear function of the parameters within their
    /// distributions.
    pub fn reason(&self, parts: &[f64]) -> String {
        let Sensitivities { parameters, reach, growth, time, .. } = &self.found;
        let beyond = (0..parts.len()).filter(|&place| self.deviations[place] > reach[place]);
        if let Some(place) = beyond.max_by(|&a, &b| parts[a].abs().total_cmp(&parts[b].abs())) {
            let (name, deviation, reach) = (parameters[place].name, self.deviations[place], reach[place]);
            let times = deviation / reach;
            return format!(
                "`{name}` has a standard deviation of {deviation:.2e}, {times:.1e} times its reach of {reach:.2e}"
            );
        }
        let parted = (growth * time).exp();
        if parted > PARTED {
            return format!("neighbouring motions part by {parted:.1e} in {} turns", self.turns);
        }
        "it bends or jumps within the distributions, which are narrower than the reach of every parameter".into()
    }
}

/// The standard deviation to first order of a quantity with these [`parts`](Linear::parts).
pub fn deviation(parts: &[f64]) -> f64 {
    parts.iter().map(|part| part * part).sum::<f64>().sqrt()
}

impl Comparison {
    /// Half the width of the 95 % confidence interval of the Monte Carlo's standard deviation.
    pub fn half_width(&self) -> f64 {
        NORMAL * self.error
    }

    /// Whether the parameters do not change the quantity: it varies by rounding alone.
    pub fn is_constant(&self) -> bool {
        self.deviation.max(self.linear) <= ROUNDING * self.size
    }

    /// Whether both standard deviations are the same but for the Monte Carlo's statistical error, and not by chance.
    pub fn agrees(&self) -> bool {
        (self.linear - self.deviation).abs() <= self.half_width() && self.explained >= EXPLAINED
    }
}

/// A kept quantity, if a study's parameters leave its window of time where it is.
fn differentiable(study: &Study, drive: DriveMode, name: &str) -> Result<Wanted> {
    let quantity = &study.keep[name];
    let in_time = quantity.at.is_none();
    let of_all = matches!(quantity.reduce, Reduction::Mean | Reduction::Rms | Reduction::Deviation);
    ensure!(
        !in_time || !(of_all || quantity.reduce == Reduction::Last) || !study.random.contains_key(SPEED),
        "{SPEED} changes how long its turns take: it has a derivative at a crank angle (`at`) only"
    );
    ensure!(
        !in_time || !of_all || drive == DriveMode::Speed,
        "parameters change how long the turns of a free crank take: it has a derivative at a crank angle (`at`) only"
    );
    Wanted::kept(name, quantity)
}

/// The standard error of the standard deviation of a sample with any kurtosis.
///
/// The variance s² of n values has the variance (μ₄ − σ⁴·(n − 3)/(n − 1))/n, and s = √(s²).
fn standard_error(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = Reduction::Mean.of(values);
    let moment = |power: i32| values.iter().map(|value| (value - mean).powi(power)).sum::<f64>() / count;
    let deviation = Reduction::Deviation.of(values);
    if deviation == 0.0 {
        return 0.0;
    }
    let of_variance = (moment(4) - deviation.powi(4) * (count - 3.0) / (count - 1.0)) / count;
    of_variance.max(0.0).sqrt() / (2.0 * deviation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standard_deviation_errs_by_what_its_kurtosis_tells() {
        // A normal sample errs by σ/√(2·n), a uniform one by σ·√((9/5 − 1)/(4·n)).
        let count = 4000;
        let quantile = |k: i32| (f64::from(k) + 0.5) / f64::from(count);
        let uniform: Vec<f64> = (0..count).map(quantile).collect();
        let known = (1.0 / 12f64).sqrt() * (0.8 / (4.0 * f64::from(count))).sqrt();
        assert!((standard_error(&uniform) / known - 1.0).abs() < 1e-3);
        // Two values, each in half of the runs: their deviation is known but for the numbers of each.
        let coin: Vec<f64> = (0..count).map(|k| f64::from(k % 2)).collect();
        assert!(standard_error(&coin) < 1e-3 / f64::from(count).sqrt());
        assert_eq!(standard_error(&[3.0; 7]), 0.0);
    }

    #[test]
    fn what_varies_by_rounding_alone_is_constant() {
        let of = |deviation, linear| Comparison { deviation, error: 0.0, linear, explained: 0.0, size: 0.16 };
        assert!(of(2.8e-17, 0.0).is_constant() && of(0.0, 0.0).is_constant());
        assert!(!of(1e-9, 0.0).is_constant() && !of(0.0, 1e-9).is_constant());
        assert!(Comparison { size: 0.0, ..of(0.0, 0.0) }.is_constant());
    }
}
