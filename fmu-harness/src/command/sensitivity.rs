//! `sensitivity`: derivatives of quantities of a run by parameters.

use super::{out_directory, say, shown, write};
use crate::frame::ended;
use crate::host::Setting;
use crate::report::sensitivity as report;
use crate::report::table::Table;
use crate::scenes::Scenario;
use crate::sensitivity::{Experiment, Named, Wanted, differences};
use anyhow::{Context, Result, ensure};
use clap::Args;
use std::fs;
use std::path::PathBuf;

/// Derivatives of quantities of a run by parameters of its scene, exact through impacts.
///
/// A quantity is an output, or a vector such as `joint.C.force`, whose length is taken; with `@bdc`, `@tdc` (outer and
/// inner dead centre) or an angle such as `@30deg` it is taken there, and with `:peak`, `:max`, `:min`, `:range`,
/// `:mean`, `:rms`, `:deviation` or `:last` many values are reduced to one [default: last]. The derivatives come from the
/// tangent of the motion. They hold for changes of a parameter well below its reach: the change that moves the mechanism by
/// a noticeable difference until the end of the run. Where motions are chaotic it shrinks with every turn. Near grazing
/// there are no derivatives, and the table says where. Writes sensitivity-SCENE.md, .csv and .parquet.
#[derive(Args)]
pub struct Sensitivity {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "press", value_name = "NAME|FILE")]
    scene: String,
    /// Sets a parameter to a value in SI units or with a unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// Quantities, separated by commas
    #[arg(long, value_name = "QUANTITIES", value_delimiter = ',', required = true)]
    of: Vec<Wanted>,
    /// Real parameters, separated by commas; a * stands for any part of a name, and leaves out those
    /// without derivatives
    #[arg(long, value_name = "PARAMETERS", value_delimiter = ',', required = true)]
    to: Vec<String>,
    /// Crank turns of the run, timed with the start speed
    #[arg(long, default_value_t = 1.0, value_name = "NUMBER")]
    turns: f64,
    /// First turns that do not count
    #[arg(long, default_value_t = 0.0, value_name = "NUMBER")]
    transient: f64,
    /// Compare with differences of neighbouring runs
    #[arg(long)]
    check: bool,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Sensitivity {
    /// Runs the scene and writes the derivatives.
    pub fn execute(&self) -> Result<()> {
        ensure!(self.turns > 0.0 && self.turns <= 1e5, "turns must be above 0 and at most 1e5");
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let Named { parameters, left_out } = Named::of(&self.to, &scenario.file)?;
        let experiment =
            Experiment { file: &scenario.file, turns: self.turns, transient: self.transient, counted: false };
        let found = experiment.run(&self.of, &parameters)?;
        let checked = if self.check {
            let columns = parameters.iter().map(|parameter| differences(&experiment, &self.of, parameter));
            Some(columns.collect::<Vec<_>>())
        } else {
            None
        };
        let tables = [report::table(&found, checked.as_deref()), report::reach(&found)];
        tables.iter().for_each(|table| say(table.print()));
        let left_out: Vec<String> = left_out.iter().map(|why| format!("Left out: {why}.\n")).collect();
        left_out.iter().for_each(say);
        let base = out.join(format!("sensitivity-{}", scenario.name));
        report::frame(&found, checked.as_deref()).save(&base)?;
        let page = tables.iter().map(Table::markdown).chain(left_out).collect::<Vec<_>>().join("\n");
        write(&base, "md", &page)?;
        ["md", "csv", "parquet"].iter().for_each(|ending| say(shown(&ended(&base, ending))));
        Table::complete(&tables)
    }
}
