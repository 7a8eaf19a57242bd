//! `wear`: joints that wear over many strokes.

use super::{out_directory, say, shown, write};
use crate::frame::ended;
use crate::host::{Fmu, Setting};
use crate::package::Stock;
use crate::report::table::Table;
use crate::report::wear as report;
use crate::scenes::Scenario;
use crate::sweep::Journal;
use crate::wear::joint::{Coefficients, PLAUSIBLE};
use crate::wear::{Plan, Study};
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

/// Parts of the progress bar.
const PARTS: f64 = 1000.0;

/// Wear of the bearings and journals of a scene over many strokes, by Archard's law.
///
/// Each run of the packaged FMU gives the sliding work by sectors of bearing and journal. The clearance and the bearing's
/// radius grow by the mean depth; an extrapolation in strokes with error control decides at which clearances the FMU is
/// run. The table gives the error of the extrapolation and the scatter of the strokes. Finished runs are recorded in
/// wear-SCENE-DIGEST.jsonl and are not run again. Writes wear-SCENE.md, .csv, .parquet and .svg, and the depths by sector,
/// wear-SCENE-depth.csv and .parquet.
#[derive(Args)]
pub struct Wear {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "press", value_name = "NAME|FILE")]
    scene: String,
    /// Joint A, B or C with the wear coefficient of bearing and journal in m²/N, or one of each: `B=1e-16`,
    /// `B=1e-16,3e-16`; may be repeated for several joints
    #[arg(long, value_name = "JOINT=NUMBERS", required = true)]
    coefficient: Vec<Coefficients>,
    /// Strokes, one for each turn of the crank
    #[arg(long, value_name = "NUMBER")]
    strokes: f64,
    /// Relative error of the growth in one step of the extrapolation
    #[arg(long, default_value_t = 1e-2, value_name = "NUMBER")]
    tolerance: f64,
    /// Sets a parameter to a value in SI units or with a unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// Strokes of each run before the evaluation starts
    #[arg(long, default_value_t = 5, value_name = "STROKES", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    transient: u32,
    /// Strokes of each run that are evaluated
    #[arg(long, default_value_t = 20, value_name = "STROKES", value_parser = clap::value_parser!(u32).range(3..=1_000_000))]
    turns: u32,
    /// Sectors of equal angle on each bearing and journal
    #[arg(long, default_value_t = 72, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(4..=3600))]
    sectors: u32,
    /// Longest time for one run
    #[arg(long, default_value_t = 600, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    budget: u64,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Wear {
    /// Runs the extrapolation and writes the results.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        self.warn();
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let file = out.join(format!("{}.fmu", scenario.name));
        Stock::build()?.package(&scenario)?.save(&file)?;
        let fmu = Fmu::open(&file)?;
        let plan = Plan {
            transient: self.transient as usize,
            turns: self.turns as usize,
            sectors: self.sectors as usize,
            budget: Duration::from_secs(self.budget),
        };
        let study = Study::new(&scenario, &fmu, &self.coefficient, plan)?;
        let base = out.join(format!("wear-{}", scenario.name));
        let digest = study.digest();
        let journal = Journal::open(&out.join(format!("wear-{}-{}.jsonl", scenario.name, &digest[..8])), &digest)?;
        let style = ProgressStyle::with_template("{msg} {wide_bar:.cyan/blue} {percent:>3} % {elapsed:>4}")?;
        let bar = ProgressBar::new(PARTS as u64).with_style(style).with_message(scenario.name.clone());
        let worn = study.follow(self.strokes, self.tolerance, &journal, |strokes| {
            bar.set_position((PARTS * strokes / self.strokes) as u64);
        })?;
        bar.finish_and_clear();

        let joints = &study.joints;
        let tables = [report::history(&worn, joints), report::depths(&worn, joints)];
        let told = format!("{}. {}", report::effort(&worn), report::SENTENCE);
        say(format!("{}\n{told}\n", tables.each_ref().map(Table::print).join("\n")));
        let page = tables.map(|table| table.markdown()).join("\n") + &format!("\n{told}\n");
        let drawing = report::sheet(&scenario.name, &worn, joints).svg()?;
        for (ending, text) in [("md", page), ("svg", drawing)] {
            write(&base, ending, &text)?;
        }
        report::history_frame(&worn, joints).save(&base)?;
        let depth = out.join(format!("wear-{}-depth", scenario.name));
        report::depth_frame(&worn, joints).save(&depth)?;
        ["md", "csv", "parquet", "svg"].iter().for_each(|ending| say(shown(&ended(&base, ending))));
        ["csv", "parquet"].iter().for_each(|ending| say(shown(&ended(&depth, ending))));
        worn.extrapolation.stopped.map_or(Ok(()), Err)
    }

    /// Warns about coefficients in other units.
    fn warn(&self) {
        for Coefficients { joint, values } in &self.coefficient {
            if let Some(odd) = values.iter().find(|value| !PLAUSIBLE.contains(*value)) {
                let [low, high] = [PLAUSIBLE.start(), PLAUSIBLE.end()];
                eprintln!(
                    "warning: {joint}={odd:e} m²/N is outside {low:e} to {high:e}; {odd:e} mm³/(N·m) would be {:.3e}",
                    odd * 1e-9
                );
            }
        }
    }
}
