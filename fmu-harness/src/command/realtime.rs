//! `realtime`: the time of one communication step.

use super::{out_directory, say, shown};
use crate::host::Fmu;
use crate::package::Stock;
use crate::precision::ladder::told;
use crate::precision::{Lengths, Subject};
use crate::realtime::Timing;
use crate::realtime::budget::Budgeted;
use crate::realtime::deadline::{Bench, TRIED, Trials};
use crate::report::docs::Docs;
use crate::report::table::Table;
use crate::report::{budget as within, deadline, realtime as report};
use crate::scenes::{Scenario, directory, names};
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// With every setting only one step of so many is taken.
const SETTINGS_SHARE: u64 = 5;
/// Usual number of runs until a deadline is found, for the progress bar.
const USUAL_GUESSES: u64 = 4;

/// Measures the time of every single communication step of 1 ms: median, 99.9 %, worst, and the contents of the worst
/// step.
///
/// Every scene is packaged, and the package is stepped in this process, with inputs set before each step. The times are
/// those in fmi2DoStep, as wall time and as CPU time, which distinguishes a long step from a step during which another
/// program ran. Then several settings of the solver are compared, with error control and with fixed steps: the longest
/// time of a step and the error, for a loop that waits for every step. At last the value of `solver.deadline` is searched
/// with which no step takes more than a share of a core, under a real-time scheduler where the machine allows it. Writes
/// realtime.md, realtime.csv, realtime.svg, realtime-settings.csv, realtime-settings.svg and realtime-deadline.csv.
#[derive(Args)]
pub struct Realtime {
    /// Only this scene: the name of a shipped scene, or a .toml file [default: all shipped scenes]
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Number of steps of every scene; a fifth as many with every setting
    #[arg(long, default_value_t = 100_000, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..))]
    steps: u64,
    /// Share of a core that a step may take, in percent; a scene that loses the motion within it gets twice as much
    #[arg(long, default_value_t = 50.0, value_name = "PERCENT", value_parser = percent)]
    share: f64,
    /// Only search for solver.deadline
    #[arg(long, conflicts_with = "docs")]
    deadline: bool,
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

/// Reads percent, above 0 and at most 100.
fn percent(text: &str) -> Result<f64, String> {
    let percent = text.parse().ok().filter(|percent: &f64| *percent > 0.0 && *percent <= 100.0);
    percent.ok_or_else(|| "expected percent, above 0 and at most 100".into())
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
        let bar = ProgressBar::new(scenes.len() as u64 * self.steps_of_scene()).with_style(style);
        let mut found = Found::default();
        for (number, scene) in scenes.iter().enumerate() {
            bar.set_message(scene.clone());
            bar.set_position(number as u64 * self.steps_of_scene());
            let scenario = Scenario::find(scene)?;
            let file = out.join(format!("{}.fmu", scenario.name));
            stock.package(&scenario)?.save(&file)?;
            let fmu = Fmu::open(&file)?;
            let subject = Subject { file: &scenario.file, fmu: &fmu, lengths: Lengths::OF_SCENE };
            self.measure(&subject, &bar, &mut found).with_context(|| scene.clone())?;
        }
        bar.finish_and_clear();
        let (tables, text) = found.write(&out, !self.deadline)?;
        Table::complete(&tables)?;
        section.map_or(Ok(()), |section| section.write(&text))
    }

    /// Number of steps with every setting and every guess of a deadline.
    fn fewer(&self) -> u64 {
        self.steps.div_ceil(SETTINGS_SHARE)
    }

    /// Number of steps of the progress bar for one scene, with the usual number of guesses.
    fn steps_of_scene(&self) -> u64 {
        let settings = if self.deadline { 0 } else { TRIED.len() as u64 };
        let all = if self.deadline { 0 } else { self.steps };
        all + (settings + USUAL_GUESSES) * self.fewer()
    }

    /// Measures one scene.
    fn measure(&self, subject: &Subject, bar: &ProgressBar, found: &mut Found) -> Result<()> {
        let (fewer, budget) = (self.fewer(), Duration::from_secs_f64(self.budget));
        let name = &subject.file.name;
        let bench = Bench::of(subject);
        if !self.deadline {
            let timing = Timing::of(subject.file, subject.fmu, vec![], self.steps as usize, budget, |done| {
                if done % 256 == 0 {
                    bar.inc(256);
                }
            });
            found.timings.push(timing?);
            let tried = Trials::of(&bench, fewer as usize, budget, |method, rung| {
                bar.set_message(format!("{name} {}", told(method, rung)));
                bar.inc(fewer);
            });
            found.trials.push(tried?);
        }
        let share = self.share * 1e-2;
        let shares = if share < 1.0 { vec![share, (2.0 * share).min(1.0)] } else { vec![share] };
        let budgeted = Budgeted::of(&bench, &shares, fewer as usize, budget, || {
            bar.set_message(format!("{name} deadline"));
            bar.inc(fewer);
        });
        found.budgeted.extend(budgeted?);
        Ok(())
    }
}

/// All results.
#[derive(Default)]
struct Found {
    timings: Vec<Timing>,
    trials: Vec<Trials>,
    budgeted: Vec<Budgeted>,
}

impl Found {
    /// Prints and writes the tables and figures, those of the settings only if there are `settings`. Returns the tables
    /// and the text of the section.
    fn write(&self, out: &Path, settings: bool) -> Result<(Vec<Table>, String)> {
        let Self { timings, trials, budgeted } = self;
        let mut tables = vec![within::table(budgeted)];
        if settings {
            tables.splice(0..0, [report::table(timings), deadline::table(trials)]);
        }
        let scheduler = budgeted.first().map(|own| own.scheduler.sentence());
        let sentences: Vec<String> = timings
            .iter()
            .map(report::sentence)
            .chain(trials.iter().map(deadline::sentence))
            .chain(budgeted.iter().map(within::sentence))
            .chain(scheduler)
            .collect();
        say(format!("{}\n{}\n", tables.iter().map(Table::print).collect::<Vec<_>>().join("\n"), sentences.join("\n")));
        let markdown: Vec<String> = tables.iter().map(Table::markdown).collect();
        let text = format!("{}\n{}\n", markdown.join("\n"), sentences.join("\n\n"));
        let file = |name: &str| out.join(format!("realtime{name}"));
        let mut files = vec![file("-deadline.csv")];
        within::write_csv(budgeted, &files[0])?;
        if settings {
            let [csv, of_settings] = [".csv", "-settings.csv"].map(file);
            report::write_csv(timings, &csv)?;
            deadline::write_csv(trials, &of_settings)?;
            let drawings = [(report::sheet(timings).svg()?, ".svg"), (deadline::sheet(trials).svg()?, "-settings.svg")];
            files.extend([csv, of_settings]);
            for (text, ending) in [(text.clone(), ".md")].into_iter().chain(drawings) {
                let file = file(ending);
                fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
                files.push(file);
            }
        }
        files.iter().for_each(|file| say(shown(file)));
        Ok((tables, text))
    }
}
