//! `precision`: what accuracy costs.

use super::{out_directory, shown};
use crate::host::Fmu;
use crate::package::Stock;
use crate::precision::diagram::{Budget, Diagram};
use crate::precision::exchange::{self, ExchangePoint};
use crate::precision::hosts::{self, HostPoint};
use crate::precision::ladder::{methods, rungs};
use crate::precision::reference::Reference;
use crate::precision::ruler::Ruler;
use crate::precision::{Lengths, SCENES, Subject};
use crate::python::{Missing, environment};
use crate::report::docs::{Docs, Section};
use crate::report::precision as report;
use crate::report::table::Table;
use crate::scenes::Scenario;
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::scene::units::quantity;
use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// [s] What may be asked for.
const DURATIONS: RangeInclusive<f64> = 1e-4..=1e4;

/// Draws work-precision diagrams: the error that every method reaches at a ladder of tolerances, and what it costs.
///
/// Every scene is packaged and the packaged file is run in this process, on one thread; the fastest of several runs
/// counts. An error is the largest position error over the clearance, against a reference solution that two methods of
/// different orders agree on. Runs that fail or are too dear are drawn too. Where there is a Python environment, FMPy
/// runs the same files at three communication steps, and its CVode in model exchange. Writes precision.csv, precision.md and precision-SCENE.svg.
#[derive(Args)]
pub struct Precision {
    /// One scene in place of six: the name of a shipped one, or a .toml file
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Errors within the first "20 ms", say, in place of two turns of the crank, as far as the motion is known
    #[arg(long, value_name = "DURATION", value_parser = duration)]
    window: Option<f64>,
    /// Costs over the first "1 s", say, in place of one turn; as much of it as there is time for
    #[arg(long, value_name = "DURATION", value_parser = duration)]
    span: Option<f64>,
    /// A coarse ladder
    #[arg(long)]
    quick: bool,
    /// Make the Python environment for FMPy if it is not there, from the package index
    #[arg(long)]
    host: bool,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
    #[command(flatten)]
    docs: Docs,
}

/// A duration with its unit, in seconds.
fn duration(text: &str) -> Result<f64, String> {
    let seconds = quantity(text, "s").map_err(|error| format!("{error}; wanted a duration such as `20 ms`"))?;
    if DURATIONS.contains(&seconds) {
        Ok(seconds)
    } else {
        Err(format!("wanted {:e} to {:e} s", DURATIONS.start(), DURATIONS.end()))
    }
}

impl Precision {
    /// Packages, measures, reports.
    pub fn execute(&self) -> Result<()> {
        let section = self.docs.section("precision", self.scene.as_deref())?;
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenes = self.scene.clone().map_or(SCENES.map(String::from).into(), |scene| vec![scene]);
        let python = environment("hosts", if self.host { Missing::Make } else { Missing::Refuse });
        if let (Err(error), false) = (&python, self.host) {
            eprintln!("FMPy is left out: {error:#}; `precision --host` makes what it needs");
        }
        let stock = Stock::build()?;
        let runs: usize = methods().0.into_iter().map(|method| rungs(method, self.quick).len()).sum();
        let style = ProgressStyle::with_template("{msg:34} {wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4}")?;
        let bar = ProgressBar::new((scenes.len() * (runs + 1)) as u64).with_style(style);
        let (mut diagrams, mut points, mut exchanged) = (Vec::new(), Vec::new(), Vec::new());
        for scene in &scenes {
            let scenario = Scenario::find(scene)?;
            let (diagram, more, exchange) =
                self.scene(&scenario, &stock, &python, &out, &bar).with_context(|| scene.clone())?;
            diagrams.push(diagram);
            points.extend(more);
            exchanged.extend(exchange);
        }
        bar.finish_and_clear();
        write(&diagrams, &points, &exchanged, &out, section)
    }

    fn scene(
        &self,
        scenario: &Scenario,
        stock: &Stock,
        python: &Result<PathBuf>,
        out: &Path,
        bar: &ProgressBar,
    ) -> Result<(Diagram, Vec<HostPoint>, Vec<ExchangePoint>)> {
        let file = out.join(format!("{}.fmu", scenario.name));
        stock.package(scenario)?.save(&file)?;
        let fmu = Fmu::open(&file)?;
        let lengths = Lengths { window: self.window, span: self.span };
        let subject = Subject { file: &scenario.file, fmu: &fmu, lengths };
        let budget = if self.quick { Budget::QUICK } else { Budget::FULL };
        let ruler = Ruler::of(&scenario.file.scene);
        bar.set_message(format!("{} reference", scenario.name));
        let reference = Reference::of(&subject, &ruler, budget.reference)?;
        let diagram = Diagram::of(&subject, &ruler, &reference, &budget, |method, rung| {
            bar.set_message(format!("{} {} {:e}", scenario.name, method.name(), rung.number()));
            bar.inc(1);
        })?;
        bar.set_message(format!("{} FMPy", scenario.name));
        let (points, exchanged) = match python {
            Err(_) if !self.host => (vec![], vec![]),
            _ => (
                hosts::measure(python, &subject, &file, &ruler, &reference, diagram.span),
                exchange::measure(python, &subject, &file, &ruler, &reference),
            ),
        };
        bar.inc(1);
        Ok((diagram, points, exchanged))
    }
}

/// Figures, tables and the CSV.
fn write(
    diagrams: &[Diagram],
    points: &[HostPoint],
    exchanged: &[ExchangePoint],
    out: &Path,
    section: Option<Section>,
) -> Result<()> {
    let mut written = Vec::new();
    for diagram in diagrams {
        let file = out.join(format!("precision-{}.svg", diagram.scene));
        fs::write(&file, report::sheet_with(diagram, exchanged).svg()?)
            .with_context(|| format!("cannot write {}", file.display()))?;
        written.push(file);
    }
    let tables = [
        report::cheapest(diagrams),
        report::between(diagrams),
        report::tolerances(diagrams),
        report::hosts(points),
        report::exchange(exchanged),
    ];
    tables.iter().for_each(|table| println!("{}", table.print()));
    let sentences: Vec<String> = diagrams.iter().map(report::sentence).collect();
    println!("{}\n", sentences.join("\n"));
    let [csv, page] = ["csv", "md"].map(|ending| out.join(format!("precision.{ending}")));
    report::write_csv(diagrams, points, &csv)?;
    let text = tables
        .each_ref()
        .map(|table| table.markdown())
        .into_iter()
        .chain(sentences.into_iter().map(|line| line + "\n"));
    let text = text.collect::<Vec<_>>().join("\n");
    fs::write(&page, &text).with_context(|| format!("cannot write {}", page.display()))?;
    written.extend([csv, page]);
    written.iter().for_each(|file| println!("{}", shown(file)));
    Table::complete(&tables)?;
    section.map_or(Ok(()), |section| section.write(&text))
}
