//! `laws`: peak forces and errors by elasticity and damping law.

use super::{out_directory, say, shown, write};
use crate::frame::ended;
use crate::host::Setting;
use crate::laws::Comparison;
use crate::package::Stock;
use crate::report::laws as report;
use crate::report::table::Table;
use crate::run::JOINTS;
use crate::scenes::Scenario;
use anyhow::{Context, Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

/// Compares the contact laws: peak forces and errors of one scene with every elasticity and every damping law in its
/// joints with clearance.
///
/// All joints with clearance get the same laws; the guide has damping laws but no elasticity. Everything else is the
/// scene's. The scene is packaged, and the package is run on all cores with each combination and, for comparison, with
/// ideal joints. The forces are the largest ones between communication points, too (`joint.J.peak.audit`); approach
/// speeds and touches are those of all contacts; penetrations, errors and torques are those at communication points.
/// Since a motion with clearance is often chaotic, the table also gives the mean, the minimum and the standard
/// deviation of the peaks of the single turns: laws whose peaks differ by less than that are not told apart by them.
/// A law that the scene does not allow is named below the table. With `--set energy.audit=true` the table has the
/// energy lost per turn. Writes laws.md, laws.csv, laws.parquet, laws.svg and the packaged scene.
#[derive(Args)]
pub struct Laws {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// Sets a parameter to a value in SI units or with a unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// Change the laws of this joint only [default: all joints with clearance]
    #[arg(long, value_name = "JOINT", value_parser = JOINTS)]
    joint: Option<String>,
    /// Crank turns of each run, at the crank's start speed [default: 5, or the scene's run if that is shorter]
    #[arg(long, value_name = "NUMBER")]
    turns: Option<f64>,
    /// Longest time for one run
    #[arg(long, default_value_t = 600, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    budget: u64,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Laws {
    /// Packages the scene, runs it with all laws and writes the results.
    pub fn execute(&self) -> Result<()> {
        ensure!(self.turns.is_none_or(|turns| turns > 0.0 && turns <= 1e6), "turns must be above 0 and at most 1e6");
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let budget = Duration::from_secs(self.budget);
        let comparison = Comparison::of(&scenario.file, self.joint.as_deref(), self.turns, budget)?;
        let package = Stock::build()?.package(&scenario)?;
        package.save(&out.join(format!("{}.fmu", scenario.name)))?;
        let fmu = package.copy()?;
        let style = ProgressStyle::with_template("{msg} {wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4} (eta {eta})")?;
        let bar = ProgressBar::new(comparison.cases().len() as u64).with_style(style);
        bar.set_message(scenario.name.clone());
        let rows = comparison.run(fmu.path(), || bar.inc(1));
        bar.finish_and_clear();
        let table = report::table(&comparison, &rows);
        say(table.print());
        let base = out.join("laws");
        let mut frame = report::frame(&comparison, &rows);
        frame.origin = scenario.texts();
        frame.origin.push(("version".into(), env!("CARGO_PKG_VERSION").into()));
        frame.save(&base)?;
        for (ending, text) in [("md", table.markdown()), ("svg", report::sheet(&comparison, &rows).svg()?)] {
            write(&base, ending, &text)?;
        }
        ["md", "csv", "parquet", "svg"].iter().for_each(|ending| say(shown(&ended(&base, ending))));
        Table::complete([&table])
    }
}
