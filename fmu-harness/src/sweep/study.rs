//! Study files: a scene, values of parameters, and the quantities to keep of each run.

use super::quantity::Quantity;
use super::values::{Number, Values, seconds};
use crate::output::check_column;
use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use slidercrank::scene::parameter::Parameter;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Columns that the results have beside parameters and quantities: the number of a run, and whether it came to its end.
const OWN_COLUMNS: [&str; 2] = ["run", "status"];

/// Contents of a study file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Short name.
    pub name: String,
    /// Purpose of the study.
    #[serde(default)]
    pub description: String,
    /// Name of a shipped scene, or a file beside the study.
    pub scene: String,
    /// Seed of the random draws.
    #[serde(default)]
    pub seed: u64,
    /// Number of random draws. Each is combined with every point of the grid.
    #[serde(default)]
    pub draws: usize,
    /// Length and communication step of the runs.
    pub run: Run,
    /// Values of parameters. Every combination is run.
    #[serde(default)]
    pub grid: BTreeMap<String, Values>,
    /// Distributions of randomly drawn parameters.
    #[serde(default)]
    pub random: BTreeMap<String, Distribution>,
    /// A CSV file beside the study with one column for each parameter and one row for each point, such as a design for
    /// a sensitivity analysis.
    pub table: Option<PathBuf>,
    /// Quantities to keep of every run.
    pub keep: BTreeMap<String, Quantity>,
    /// Text of the file.
    #[serde(skip)]
    pub text: String,
    /// Path of the file.
    #[serde(skip)]
    pub directory: PathBuf,
}

/// Length and communication step of a run.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Crank turns.
    pub turns: f64,
    /// Number of these turns before the evaluation starts.
    #[serde(default)]
    pub transient: f64,
    /// [s] Communication step.
    #[serde(deserialize_with = "seconds")]
    pub step: f64,
}

/// The distribution of a parameter.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Distribution {
    /// Uniform between two values.
    Uniform {
        /// Minimum.
        min: Number,
        /// Maximum.
        max: Number,
    },
    /// Logarithmically uniform between two values.
    LogUniform {
        /// Minimum.
        min: Number,
        /// Maximum.
        max: Number,
    },
    /// Normal; values outside `min` and `max` are drawn again.
    Normal {
        /// Mean before truncation.
        mean: Number,
        /// Standard deviation before truncation.
        deviation: Number,
        /// Minimum, if it is truncated there.
        min: Option<Number>,
        /// Maximum, if it is truncated there.
        max: Option<Number>,
    },
}

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// If the file has a fault; the text names file and line.
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
        ensure!(turns > 0.0 && turns <= 1e6, "run.turns = {turns}: it must be above 0 and at most 1e6");
        ensure!(
            transient >= 0.0 && transient < turns,
            "run.transient = {transient}: it must be at least 0 and below run.turns"
        );
        ensure!(step > 0.0 && step <= 1.0, "run.step = {step} s: it must be above 0 and at most 1 s");
        ensure!(
            !self.name.is_empty() && !self.name.contains(['/', '\\']),
            "name = \"{}\" is not allowed: it is part of the names of files, and not empty, without / and \\",
            self.name
        );
        ensure!(!self.keep.is_empty(), "[keep] is empty: a study must keep at least one quantity");
        ensure!(
            self.random.is_empty() || self.draws > 0,
            "[random] needs `draws`, the number of draws, which must be at least 1"
        );
        ensure!(self.draws == 0 || !self.random.is_empty(), "draws = {} needs distributions in [random]", self.draws);
        for (name, quantity) in &self.keep {
            check_column(&quantity.of).with_context(|| format!("`{name}` in [keep]"))?;
            ensure!(
                !OWN_COLUMNS.contains(&name.as_str()) && Parameter::named(name).is_none(),
                "`{name}` in [keep] needs another name, since `{name}` is a column of the results already"
            );
        }
        for name in self.grid.keys() {
            ensure!(!self.random.contains_key(name), "`{name}` is both in [grid] and in [random]");
        }
        Ok(())
    }

    /// Whether its runs are a random sample: all parameters are drawn.
    pub fn is_sample(&self) -> bool {
        !self.random.is_empty() && self.grid.is_empty() && self.table.is_none()
    }

    /// Name of a shipped scene, or the path of a scene file.
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
/// If there is no such parameter.
pub fn parameter(name: &str) -> Result<&'static Parameter> {
    Parameter::named(name).with_context(|| format!("there is no parameter `{name}`"))
}
