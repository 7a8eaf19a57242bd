//! `accuracy`: the effect of clearances on the slider's motion.

use super::{out_directory, say, shown, write};
use crate::accuracy::{Plan, comparisons};
use crate::frame::ended;
use crate::report::accuracy as report;
use crate::report::table::Table;
use crate::scenes::Scenario;
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::PathBuf;

/// Errors of the slider's position, velocity and acceleration against the ideal mechanism at the same crank angle.
///
/// The tables compare the sixteen choices of joints with clearance, clearances and speeds from a quarter to twice those
/// of the scene and, for a scene with a flexible rod, the same scene with a rigid rod. They also give the error at
/// bottom dead centre (crank and rod in line), its spread from stroke to stroke and the slider's tilt there. Runs in this
/// process, on all cores. Writes accuracy-SCENE.md, .csv and .parquet.
#[derive(Args)]
pub struct Accuracy {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "press", value_name = "NAME|FILE")]
    scene: String,
    /// Crank turns before the evaluation starts
    #[arg(long, default_value_t = 3, value_name = "TURNS")]
    transient: usize,
    /// Crank turns that are evaluated
    #[arg(long, default_value_t = 20, value_name = "TURNS", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    turns: u32,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Accuracy {
    /// Runs all cases and writes the tables.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let Scenario { name, file, .. } = Scenario::find(&self.scene)?;
        let parts = comparisons(&file);
        let plan = Plan { transient: self.transient, turns: self.turns as usize };
        let cases = parts.iter().map(|(_, cases)| cases.len() as u64).sum();
        let style = ProgressStyle::with_template("{wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4} (eta {eta})")?;
        let bar = ProgressBar::new(cases).with_style(style);
        let (mut page, mut all, mut found, mut tables) = (String::new(), Vec::new(), Vec::new(), Vec::new());
        for (heading, cases) in parts {
            let measured = plan.measure_all(&cases, || bar.inc(1));
            let table = report::table(heading, &cases, &measured);
            bar.suspend(|| say(table.print()));
            page += &(table.markdown() + "\n");
            tables.push(table);
            all.extend(cases);
            found.extend(measured);
        }
        bar.finish_and_clear();
        let base = out.join(format!("accuracy-{name}"));
        report::frame(&all, &found).save(&base)?;
        write(&base, "md", &page)?;
        ["md", "csv", "parquet"].iter().for_each(|ending| say(shown(&ended(&base, ending))));
        Table::complete(&tables)
    }
}
