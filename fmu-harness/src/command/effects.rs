//! `effects`: the cost of every effect.

use super::{out_directory, say, shown};
use crate::effects::{Price, TangentPrice};
use crate::host::Fmu;
use crate::package::Stock;
use crate::report::docs::{Docs, Section};
use crate::report::price;
use crate::scenes::{Scenario, ladder};
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::PathBuf;

/// Share of each scene's time that `--quick` runs.
const QUICK: f64 = 0.02;
/// Runs with a tangent of which the fastest counts.
const TANGENT_RUNS: usize = 5;
/// Scenes whose tangent is timed, too.
const WITH_TANGENT: [&str; 4] =
    ["effects/02-one-play", "effects/04-four-plays", "effects/06-faces", "effects/08-rod-4-modes"];

/// Measures the cost of every effect: runs a series of scenes, each with one effect more than the scene before.
///
/// The scenes are those in fmu-harness/scenes/effects. Each scene is packaged, and the package is run over the scene's
/// whole time on one thread, at least three times; the fastest run counts. "All in" is its CPU time in fmi2DoStep
/// divided by its number of evaluations; "bare" is the right-hand side alone, called by this program at states of the
/// run. The last table is about the tangent of the motion, in this program: the CPU time of a run with it over that of the
/// same run without. Writes effects.csv, effects.md, effects.svg and the packaged scenes.
#[derive(Args)]
pub struct Effects {
    /// Run every scene for only a fiftieth of its time, and only once with each tangent
    #[arg(long)]
    quick: bool,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
    #[command(flatten)]
    docs: Docs,
}

impl Effects {
    /// Packages and runs the scenes and writes the tables.
    pub fn execute(&self) -> Result<()> {
        let section = self.docs.section("effects", None)?;
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let stock = Stock::build()?;
        let scenes = ladder();
        let style = ProgressStyle::with_template("{msg:30} {wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4}")?;
        let bar = ProgressBar::new(scenes.len() as u64).with_style(style);
        let (mut prices, mut tangents) = (vec![], vec![]);
        for scene in &scenes {
            bar.set_message(scene.clone());
            let scenario = Scenario::find(scene)?;
            let file = out.join(format!("{scene}.fmu"));
            stock.package(&scenario)?.save(&file)?;
            let (share, tangent_runs) = if self.quick { (QUICK, 1) } else { (1.0, TANGENT_RUNS) };
            let span = scenario.file.run.stop(&scenario.file.scene) * share;
            prices.push(Price::of(&scenario.file, &Fmu::open(&file)?, span).with_context(|| scene.clone())?);
            if WITH_TANGENT.contains(&scene.as_str()) {
                tangents.extend(TangentPrice::of(&scenario.file, span, tangent_runs)?);
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        self.report(&prices, &tangents, &out, section)
    }

    fn report(
        &self,
        prices: &[Price],
        tangents: &[TangentPrice],
        out: &std::path::Path,
        section: Option<Section>,
    ) -> Result<()> {
        let tables = [price::prices(prices), price::increments(prices), price::tangents(tangents)];
        tables.iter().for_each(|table| say(table.print()));
        let [csv, page, drawing] = ["csv", "md", "svg"].map(|ending| out.join(format!("effects.{ending}")));
        price::write_csv(prices, &csv)?;
        let text = tables.map(|table| table.markdown()).join("\n");
        for (file, text) in [(&page, &text), (&drawing, &price::sheet(prices).svg()?)] {
            fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
        }
        [csv, page, drawing].iter().for_each(|file| say(shown(file)));
        section.map_or(Ok(()), |section| section.write(&text))
    }
}
