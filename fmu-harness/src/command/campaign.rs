//! `campaign`: scenes drawn by lot, put to the test.

use super::{out_directory, shown};
use crate::campaign::trial::Verdict;
use crate::campaign::{Campaign as Draws, HANGS};
use crate::report::campaign::table;
use anyhow::{Context, Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::write::write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::exit;

/// Draws scenes by lot over all that a scene may be and puts each to the test.
///
/// Every legal scene must run without a panic and without a hang; every output, its derivative and its sensitivity must
/// be a number at every communication point; a state that is saved on the way must go on to the bit; the audited energy
/// must balance. A run that ends by an error in plain words, or by its budget of work, is counted as such. A scene that
/// fails is kept under campaign/ of the output directory, as it was drawn and as simple as it can be and still fail: run
/// it with --scene.
#[derive(Args)]
pub struct Campaign {
    /// How many scenes
    #[arg(long, value_name = "NUMBER", default_value_t = 2000)]
    scenes: u64,
    /// The same seed draws the same scenes
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Crank turns of each run
    #[arg(long, value_name = "NUMBER", default_value_t = 5.0)]
    turns: f64,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Campaign {
    /// Draws, runs, reports.
    pub fn execute(&self) -> Result<()> {
        ensure!(self.turns > 0.0 && self.turns <= 1e6, "turns must be above 0, at most 1e6");
        let out = self.output.clone().unwrap_or_else(out_directory).join("campaign");
        let style = ProgressStyle::with_template("{msg:30} {wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4}")?;
        let bar = ProgressBar::new(self.scenes).with_style(style).with_message(format!("seed {}", self.seed));
        let draws = Draws { scenes: self.scenes, seed: self.seed, turns: self.turns };
        let hangs = |number: u64, file: &SceneFile| {
            let name = format!("{}-{number}-hangs", self.seed);
            let kept = keep(&out, &name, "It does not end.", file);
            let place = kept.map_or_else(|error| format!("{error:#}"), |file| shown(&file));
            bar.suspend(|| eprintln!("scene {number} has been running for {} s: {place}", HANGS.as_secs()));
            // A thread cannot be stopped from outside.
            exit(1);
        };
        let outcomes = draws.run(|| bar.inc(1), hangs);
        bar.finish_and_clear();
        println!("{}", table(&outcomes).print());
        let mut failed = 0;
        for outcome in &outcomes {
            if let (Verdict::Failed(what), Some([drawn, simplest])) = (&outcome.verdict, &outcome.failure) {
                failed += 1;
                keep(&out, &drawn.name, what, drawn)?;
                let file = keep(&out, &format!("{}-simplest", drawn.name), what, simplest)?;
                println!("{}: {what}", shown(&file));
            }
        }
        ensure!(failed == 0, "{failed} of {} scenes failed", self.scenes);
        Ok(())
    }
}

/// Writes a scene file that tells why it is kept.
fn keep(out: &Path, name: &str, what: &str, file: &SceneFile) -> Result<PathBuf> {
    fs::create_dir_all(out).with_context(|| format!("cannot make the directory {}", out.display()))?;
    let path = out.join(format!("{name}.toml"));
    let file = SceneFile { name: name.to_owned(), description: what.to_owned(), ..file.clone() };
    fs::write(&path, write(&file)).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}
