//! A study file: which scene, which parameters take which values, what is kept of each run.

use super::quantity::Quantity;
use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::units;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A study as its file tells it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Short name.
    pub name: String,
    /// What it asks.
    #[serde(default)]
    pub description: String,
    /// Name of a shipped scene, or a file beside the study.
    pub scene: String,
    /// Of the random draws.
    #[serde(default)]
    pub seed: u64,
    /// Number of random draws, each with every point of the grid.
    #[serde(default)]
    pub draws: usize,
    /// How long and how finely.
    pub run: Run,
    /// Values of parameters of which every combination is run.
    #[serde(default)]
    pub grid: BTreeMap<String, Values>,
    /// Distributions that parameters are drawn from.
    #[serde(default)]
    pub random: BTreeMap<String, Distribution>,
    /// A CSV file beside the study with a parameter a column and a point a row, such as a design for a sensitivity
    /// analysis.
    pub table: Option<PathBuf>,
    /// What is kept of every run.
    pub keep: BTreeMap<String, Quantity>,
    /// The file's text.
    #[serde(skip)]
    pub text: String,
    /// Where it is.
    #[serde(skip)]
    pub directory: PathBuf,
}

/// How long and how finely.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Turns of the crank.
    pub turns: f64,
    /// Turns that are forgotten, of these.
    #[serde(default)]
    pub transient: f64,
    /// [s] Between communication points.
    pub step: f64,
}

/// A number in SI units, or a text with its unit.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Number {
    /// In SI units.
    Plain(f64),
    /// Such as `"20 um"`.
    Text(String),
}

/// Values of one parameter.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Values {
    /// These.
    List(Vec<Number>),
    /// Evenly spaced ones.
    Range(Range),
}

/// Evenly spaced values, the ends among them.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Range {
    from: Number,
    to: Number,
    count: usize,
    #[serde(default)]
    logarithmic: bool,
}

/// What a parameter is drawn from.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Distribution {
    /// Evenly between two values.
    Uniform {
        /// The least.
        min: Number,
        /// The greatest.
        max: Number,
    },
    /// Evenly in the logarithm.
    LogUniform {
        /// The least.
        min: Number,
        /// The greatest.
        max: Number,
    },
    /// Normal; drawn again where it falls outside `min` and `max`.
    Normal {
        /// Mean before truncation.
        mean: Number,
        /// Standard deviation before truncation.
        deviation: Number,
        /// The least, if it is truncated there.
        min: Option<Number>,
        /// The greatest.
        max: Option<Number>,
    },
}

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// What is wrong in it, with file and line.
    pub fn read(file: &Path) -> Result<Self> {
        let text = fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
        let mut study: Self = toml::from_str(&text).with_context(|| format!("{}", file.display()))?;
        study.text = text;
        study.directory = file.parent().map(Path::to_path_buf).unwrap_or_default();
        study.check().with_context(|| format!("{}", file.display()))?;
        Ok(study)
    }

    fn check(&self) -> Result<()> {
        let Run { turns, transient, step } = self.run;
        ensure!(turns > 0.0 && turns <= 1e6, "run.turns = {turns}: wanted more than 0, at most 1e6");
        ensure!(
            transient >= 0.0 && transient < turns,
            "run.transient = {transient}: wanted at least 0, below run.turns"
        );
        ensure!(step > 0.0 && step <= 1.0, "run.step = {step} s: wanted more than 0, at most 1 s");
        ensure!(!self.keep.is_empty(), "[keep] names nothing: a study keeps at least one quantity");
        ensure!(self.random.is_empty() || self.draws > 0, "[random] without draws: wanted draws = 1 or more");
        ensure!(self.draws == 0 || !self.random.is_empty(), "draws = {} without [random]", self.draws);
        for name in self.grid.keys() {
            ensure!(!self.random.contains_key(name), "`{name}` is both in [grid] and in [random]");
        }
        Ok(())
    }

    /// The scene: a shipped one's name, or the path of the file.
    pub fn scene(&self) -> String {
        if self.scene.ends_with(".toml") {
            self.directory.join(&self.scene).display().to_string()
        } else {
            self.scene.clone()
        }
    }
}

/// The parameter of this name.
///
/// # Errors
/// If there is none.
pub fn parameter(name: &str) -> Result<&'static Parameter> {
    Parameter::named(name).with_context(|| format!("there is no parameter `{name}`"))
}

impl Number {
    /// In SI units, for a parameter.
    ///
    /// # Errors
    /// If it has another unit, or the parameter cannot take it.
    pub fn value(&self, parameter: &Parameter) -> Result<f64> {
        let value = match self {
            Self::Plain(value) => *value,
            Self::Text(text) => match parameter.kind {
                Kind::Real { unit, .. } => units::quantity(text, unit).with_context(|| parameter.name.to_owned())?,
                Kind::Enumeration { items, .. } => match items.iter().find(|(name, _)| name == text) {
                    Some((_, value)) => f64::from(*value),
                    None => bail!("{} = \"{text}\" is not allowed: {}", parameter.name, parameter.allowed()),
                },
                _ => bail!("{} = \"{text}\" is not allowed: {}", parameter.name, parameter.allowed()),
            },
        };
        parameter.admit(value)?;
        Ok(value)
    }
}

impl Values {
    /// All of them, in SI units.
    ///
    /// # Errors
    /// As [`Number::value`].
    pub fn list(&self, parameter: &Parameter) -> Result<Vec<f64>> {
        match self {
            Self::List(numbers) => {
                ensure!(!numbers.is_empty(), "`{}` has no values", parameter.name);
                numbers.iter().map(|number| number.value(parameter)).collect()
            }
            Self::Range(Range { from, to, count, logarithmic }) => {
                let (from, to) = (from.value(parameter)?, to.value(parameter)?);
                Ok(crate::dynamics::bifurcation::Range::new(parameter.name, from, to, *count, *logarithmic)?.values)
            }
        }
    }
}
