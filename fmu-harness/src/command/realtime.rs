//! `realtime`: the time of one communication step.

use super::{out_directory, shown};
use crate::host::Fmu;
use crate::package::Stock;
use crate::precision::ladder::told;
use crate::precision::{Lengths, Subject};
use crate::realtime::Timing;
use crate::realtime::deadline::{TRIED, Trials};
use crate::report::docs::Docs;
use crate::report::table::Table;
use crate::report::{deadline, realtime as report};
use crate::scenes::{Scenario, directory, names};
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

/// With every setting only one step of so many is taken.
const SETTINGS_SHARE: u64 = 5;

/// Measures the time of every single communication step of 1 ms: median, 99.9 %, worst, and the contents of the worst
/// step.
///
/// Every scene is packaged, and the package is stepped in this process, with inputs set before each step. The times are
/// those in fmi2DoStep, as wall time and as CPU time, which distinguishes a long step from a step during which another
/// program ran. Then several settings of the solver are compared, with error control and with fixed steps: the longest
/// time of a step and the error, for a loop that waits for every step. Writes realtime.md, realtime.csv, realtime.svg,
/// realtime-settings.csv and realtime-settings.svg.
#[derive(Args)]
pub struct Realtime {
    /// Only this scene: the name of a shipped scene, or a .toml file [default: all shipped scenes]
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Number of steps of every scene; a fifth as many with every setting
    #[arg(long, default_value_t = 100_000, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..))]
    steps: u64,
    /// Longest time for one scene, and for one setting; a slower run takes fewer steps
    #[arg(long, default_value_t = 300.0, value_name = "SECONDS", value_parser = budget)]
    budget: f64,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
    #[command(flatten)]
    docs: Docs,
}

/// Reads a time above 0 and at most a million seconds.
fn budget(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0 && *seconds <= 1e6);
    seconds.ok_or_else(|| "expected seconds, above 0 and at most a million".into())
}

impl Realtime {
    /// Packages and runs the scenes and writes the tables.
    pub fn execute(&self) -> Result<()> {
        let section = self.docs.section("realtime", self.scene.as_deref())?;
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenes = self.scene.clone().map_or_else(|| names(&directory()), |scene| vec![scene]);
        let stock = Stock::build()?;
        let style = ProgressStyle::with_template("{msg:34} {wide_bar:.cyan/blue} {percent}% {elapsed:>4}")?;
        let fewer = self.steps.div_ceil(SETTINGS_SHARE);
        let of_scene = self.steps + TRIED.len() as u64 * fewer;
        let bar = ProgressBar::new(scenes.len() as u64 * of_scene).with_style(style);
        let (mut timings, mut trials) = (Vec::new(), Vec::new());
        for (number, scene) in scenes.iter().enumerate() {
            let before = number as u64 * of_scene;
            bar.set_message(scene.clone());
            bar.set_position(before);
            let scenario = Scenario::find(scene)?;
            let file = out.join(format!("{}.fmu", scenario.name));
            stock.package(&scenario)?.save(&file)?;
            let fmu = Fmu::open(&file)?;
            let budget = Duration::from_secs_f64(self.budget);
            let timing = Timing::of(&scenario.file, &fmu, vec![], self.steps as usize, budget, |done| {
                if done % 256 == 0 {
                    bar.inc(256);
                }
            });
            timings.push(timing.with_context(|| scene.clone())?);
            bar.set_position(before + self.steps);
            let subject = Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE };
            let tried = Trials::of(&subject, fewer as usize, budget, |method, rung| {
                bar.set_message(format!("{scene} {}", told(method, rung)));
                bar.inc(fewer);
            });
            trials.push(tried.with_context(|| scene.clone())?);
        }
        bar.finish_and_clear();
        let tables = [report::table(&timings), deadline::table(&trials)];
        let sentences: Vec<String> =
            timings.iter().map(report::sentence).chain(trials.iter().map(deadline::sentence)).collect();
        println!("{}\n{}\n", tables.each_ref().map(Table::print).join("\n"), sentences.join("\n"));
        let [csv, page, drawing] = ["csv", "md", "svg"].map(|ending| out.join(format!("realtime.{ending}")));
        let [settings, scatter] = ["csv", "svg"].map(|ending| out.join(format!("realtime-settings.{ending}")));
        report::write_csv(&timings, &csv)?;
        deadline::write_csv(&trials, &settings)?;
        let text =
            format!("{}\n{}\n", tables.each_ref().map(|table| table.markdown()).join("\n"), sentences.join("\n\n"));
        let by_setting = deadline::sheet(&trials).svg()?;
        for (file, text) in [(&page, &text), (&drawing, &report::sheet(&timings).svg()?), (&scatter, &by_setting)] {
            fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
        }
        [csv, settings, page, drawing, scatter].iter().for_each(|file| println!("{}", shown(file)));
        Table::complete(&tables)?;
        section.map_or(Ok(()), |section| section.write(&text))
    }
}
