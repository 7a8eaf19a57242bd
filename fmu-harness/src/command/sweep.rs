//! `sweep`: runs a study.

use super::{out_directory, say, shown, write};
use crate::frame::ended;
use crate::package::Stock;
use crate::report::study as report;
use crate::report::table::Table;
use crate::scenes::Scenario;
use crate::sweep::{Journal, Linear, Plan, Study, Sweep as Studied, journal};
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Runs a study: a scene with many parameter values, on all cores.
///
/// Finished runs are recorded in sweep-NAME.jsonl and are not run again, so that a study that was killed continues. A
/// run that fails does not stop the others, and one that takes longer than its budget is run again when the command is
/// repeated. Results do not depend on the number of workers. Writes sweep-NAME.parquet, .csv and a summary,
/// sweep-NAME.md: mean, standard deviation, quantiles and, of random draws, a confidence interval of the mean for
/// each quantity.
#[derive(Args)]
pub struct Sweep {
    /// Study: a .toml file; examples are in fmu-harness/studies/
    study: PathBuf,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=1024))]
    workers: Option<u32>,
    /// Longest time for one run
    #[arg(long, default_value_t = 600, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    budget: u64,
    /// Write the table of runs with their settings, sweep-NAME-plan.csv and .json, and run nothing
    #[arg(long)]
    plan: bool,
    /// Compare the standard deviations with those of a linear analysis, by exact derivatives at the means of all
    /// distributions, and give the share of each parameter; writes sweep-NAME-linear.csv and .parquet
    #[arg(long)]
    linear: bool,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Sweep {
    /// Runs the runs that are not finished yet and writes the results.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let study = Study::read(&self.study)?;
        let plan = Plan::of(&study)?;
        let base = out.join(format!("sweep-{}", study.name));
        let scenario = Scenario::find(&study.scene())?;
        if self.plan {
            return write_plan(&study, &scenario, &plan, &out);
        }
        let linear = self.linear.then(|| Linear::of(&study, &scenario)).transpose()?;
        let package = Stock::build()?.package(&scenario)?;
        let digest = Studied::digest(&study, &scenario, &plan);
        let journal = Journal::open(&journal::path(&out, &study.name), &digest)?;
        package.save(&out.join(format!("{}.fmu", scenario.name)))?;
        let fmu = package.copy()?;
        let budget = Duration::from_secs(self.budget);
        let sweep = Studied { study: &study, scenario: &scenario, plan: &plan, fmu: fmu.path(), budget };
        let style = ProgressStyle::with_template("{msg} {wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4} (eta {eta})")?;
        let bar = ProgressBar::new(plan.len() as u64).with_style(style).with_message(study.name.clone());
        bar.set_position(journal.len() as u64);
        bar.reset_eta();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.workers.unwrap_or(0) as usize).build()?;
        pool.install(|| sweep.run(&journal, || bar.inc(1)))?;
        bar.finish_and_clear();
        let frame = sweep.frame(&journal)?;
        frame.save(&base)?;
        let table = report::summary(&study, &frame);
        say(format!("{}{}\n", table.print(), report::failures(&frame)));
        let mut page = table.markdown();
        let mut written = vec![ended(&base, "parquet"), ended(&base, "csv"), ended(&base, "md")];
        if let Some(linear) = linear {
            let (tables, sentences) = report::linear(&linear, &frame);
            tables.iter().for_each(|table| say(table.print()));
            sentences.iter().for_each(say);
            page += &tables.iter().map(|table| format!("\n{}", table.markdown())).collect::<String>();
            page += &sentences.iter().map(|sentence| format!("\n{sentence}.\n")).collect::<String>();
            let file = out.join(format!("sweep-{}-linear", study.name));
            report::derivatives(&linear).save(&file)?;
            written.extend(["parquet", "csv"].map(|ending| ended(&file, ending)));
        }
        write(&base, "md", &page)?;
        written.iter().for_each(|file| say(shown(file)));
        Table::complete([&table])
    }
}

/// Writes the table of runs and their recipe.
fn write_plan(study: &Study, scenario: &Scenario, plan: &Plan, out: &Path) -> Result<()> {
    let file = out.join(format!("sweep-{}-plan.csv", study.name));
    report::plan(plan).save_csv(&file)?;
    let recipe = file.with_extension("json");
    fs::write(&recipe, format!("{:#}\n", Studied::recipe(study, scenario, plan)))
        .with_context(|| format!("cannot write {}", recipe.display()))?;
    say(format!("{} runs\n{}\n{}", plan.len(), shown(&file), shown(&recipe)));
    Ok(())
}
