//! `ssp`: the press with its controller as an SSP package, and the error of its coupling.

use super::{out_directory, say, shown};
use crate::package::Stock;
use crate::python::{Missing, environment};
use crate::report::ssp as report;
use crate::ssp::study::{Plan, Study};
use crate::ssp::{PRESS, package};
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Writes the press with a servo drive and the sheet that it cuts as an SSP 1.0 package.
///
/// The press is the scene `press` without its flywheel. The drive is a sampled PI controller with a speed profile over
/// the stroke and a torque limit. The sheet is the scene's load. PythonFMU makes drive and sheet, in the Python
/// environment under target/hosts; they run in hosts that have Python. With --study, three masters run the package with
/// inputs held, extrapolated, and iterated with rollback, at communication steps from 10 µs to 2 ms, and at several
/// clearances; this takes some minutes and writes ssp.csv, ssp.md, ssp-strokes.csv, ssp-strokes.svg, ssp-clearance.svg
/// and ssp-step.svg.
#[derive(Args)]
pub struct Ssp {
    /// Measure the error of the coupling
    #[arg(long)]
    study: bool,
    /// Directory of the results [default: target/out]
    #[arg(short, long, visible_alias = "out", value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Ssp {
    /// Writes the package, and with `--study` runs the masters and writes their results.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let python = environment("hosts", Missing::Make)
            .context("the Python environment of drive and sheet cannot be set up")?;
        let file = out.join(format!("{PRESS}.ssp"));
        let bytes = package(&Stock::build()?, &python)?;
        fs::write(&file, &bytes).with_context(|| format!("cannot write {}", file.display()))?;
        say(format!("{} ({} kB)", shown(&file), bytes.len().div_ceil(1000)));
        if self.study { study(&python, &file, &out) } else { Ok(()) }
    }
}

fn study(python: &Path, package: &Path, out: &Path) -> Result<()> {
    let bar = ProgressBar::new_spinner().with_style(ProgressStyle::with_template("{spinner} study {elapsed}")?);
    bar.enable_steady_tick(Duration::from_millis(200));
    let [strokes, csv, page] = ["-strokes.csv", ".csv", ".md"].map(|ending| out.join(format!("ssp{ending}")));
    let study = Study::run(python, package, &strokes, &Plan::default())?;
    bar.finish_and_clear();
    let tables = [report::strokes(&study)?, report::clearances(&study.clearances), report::steps(&study)];
    tables.iter().for_each(|table| say(table.print()));
    let sentence = report::sentence(&study);
    say(format!("{sentence}\n"));
    report::write_csv(&study, &csv)?;
    let text = tables.map(|table| table.markdown()).join("\n") + "\n" + &sentence + "\n";
    fs::write(&page, text).with_context(|| format!("cannot write {}", page.display()))?;
    let mut written = vec![strokes, csv, page];
    let drawings = [
        ("strokes", report::strokes_sheet(&study)?.svg()?),
        ("clearance", report::clearance_sheet(&study.clearances).svg()?),
        ("step", report::step_sheet(&study).svg()?),
    ];
    for (name, drawing) in drawings {
        let file = out.join(format!("ssp-{name}.svg"));
        fs::write(&file, drawing).with_context(|| format!("cannot write {}", file.display()))?;
        written.push(file);
    }
    written.iter().for_each(|file| say(shown(file)));
    Ok(())
}
