//! `precision`: the cost of accuracy.

use super::{out_directory, say, shown};
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

/// [s] Range of durations that can be set.
const DURATIONS: RangeInclusive<f64> = 1e-4..=1e4;

/// Draws work-precision diagrams: the error and the cost of every method at a series of tolerances.
///
/// Every scene is packaged, and the package is run in this process, on one thread; the fastest of several runs counts.
/// The error is the largest position error divided by the clearance, against a reference solution on which two methods
/// of different orders agree. Runs that fail or take too long are drawn, too. If there is a Python environment, FMPy
/// runs the same files at three communication steps, and with its CVode in model exchange. Writes precision.csv,
/// precision.md and precision-SCENE.svg.
#[derive(Args)]
pub struct Precision {
    /// Only this scene: the name of a shipped scene, or a .toml file [default: six scenes]
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Time in which errors count, such as "20 ms" [default: two crank turns, or as long as the reference is known]
    #[arg(long, value_name = "DURATION", value_parser = duration)]
    window: Option<f64>,
    /// Time over which costs are measured, such as "1 s"; slow runs stop earlier [default: one crank turn]
    #[arg(long, value_name = "DURATION", value_parser = duration)]
    span: Option<f64>,
    /// Use few tolerances
    #[arg(long)]
    quick: bool,
    /// Install the Python environment for FMPy from the package index if it is missing
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
    let seconds = quantity(text, "s").map_err(|error| format!("{error}; expected a duration such as `20 ms`"))?;
    if DURATIONS.contains(&seconds) {
        Ok(seconds)
    } else {
        Err(format!("expected {:e} to {:e} s", DURATIONS.start(), DURATIONS.end()))
    }
}

impl Precision {
    /// Packages and runs the scenes and writes the diagrams.
    pub fn execute(&self) -> Result<()> {
        let section = self.docs.section("precision", self.scene.as_deref())?;
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenes = self.scene.clone().map_or(SCENES.map(String::from).into(), |scene| vec![scene]);
        let python = environment("hosts", if self.host { Missing::Make } else { Missing::Refuse });
        if let (Err(error), false) = (&python, self.host) {
            eprintln!("FMPy is left out: {error:#}; `precision --host` installs it");
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

/// Writes figures, tables and the CSV file.
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
    tables.iter().for_each(|table| say(table.print()));
    let sentences: Vec<String> = diagrams.iter().map(report::sentence).collect();
    say(format!("{}\n", sentences.join("\n")));
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
    written.iter().for_each(|file| say(shown(file)));
    Table::complete(&tables)?;
    section.map_or(Ok(()), |section| section.write(&text))
}
