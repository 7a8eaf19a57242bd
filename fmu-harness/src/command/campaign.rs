//! `campaign`: tests of randomly drawn scenes.

use super::{out_directory, say, shown};
use crate::campaign::trial::Verdict;
use crate::campaign::{Campaign as Draws, HANGS, Kind};
use crate::report::campaign::{slowest, table};
use crate::report::docs::Docs;
use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::write::write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::exit;

/// Draws scenes at random and tests each of them: any legal scene, and machines of plausible sizes, loads and speeds.
/// Or takes the shipped scenes with every choice of clearances, with both drives, at three tolerances; for these scenes
/// the default method must also compute the motion that the other methods compute, for as long as they agree.
///
/// Every scene must run without a panic and without a hang. Every output, its derivative and its sensitivity must be a
/// finite number at every communication point. A state that is saved during the run must continue to the same bits.
/// Where the energy is audited, it must balance. A run that ends with an error is repeated with the other adaptive
/// methods; the scene has failed if one of them finishes it. A second table lists the scenes that took the most
/// evaluations per turn, and what is stiff in them: the fastest rate of the equations, the joints that were closed, and
/// the contacts that had closed so slowly that their damping is that of the minimum approach speed. A scene that fails
/// is kept in campaign/ of the output directory, as drawn and in its simplest form that still fails. Run it with
/// --scene.
#[derive(Args)]
pub struct Campaign {
    /// Draw only scenes of this kind [default: legal and machines]
    #[arg(long, value_name = "KIND")]
    kind: Option<Kind>,
    /// Number of scenes of each kind [default: 1000, or all shipped scenes]
    #[arg(long, value_name = "NUMBER")]
    scenes: Option<u64>,
    /// Seed of the random numbers: the same seed draws the same scenes
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Crank turns of each run [default: 5 for legal scenes, 60 for machines and shipped scenes]
    #[arg(long, value_name = "NUMBER")]
    turns: Option<f64>,
    /// Number of the slowest scenes of each kind to list
    #[arg(long, value_name = "NUMBER", default_value_t = 10)]
    slowest: usize,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
    #[command(flatten)]
    docs: Docs,
}

/// Default number of scenes of a random kind.
const DRAWN: u64 = 1000;

/// Default number of turns of a run of each kind.
fn turns(kind: Kind) -> f64 {
    match kind {
        Kind::Legal => 5.0,
        Kind::Machines | Kind::Shipped => 60.0,
    }
}

/// The name of a kind on the command line.
fn name(kind: Kind) -> String {
    kind.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

impl Campaign {
    /// Draws the scenes, runs them and writes the tables.
    pub fn execute(&self) -> Result<()> {
        ensure!(self.turns.is_none_or(|turns| turns > 0.0 && turns <= 1e6), "turns must be above 0 and at most 1e6");
        let section = self.docs.section("campaign", self.kind.map(name).as_deref())?;
        let kinds = self.kind.map_or(vec![Kind::Legal, Kind::Machines], |kind| vec![kind]);
        let (mut failed, mut text) = (0, String::new());
        for kind in &kinds {
            failed += self.of_kind(*kind, &mut text)?;
        }
        section.map_or(Ok(()), |section| section.write(&text))?;
        ensure!(failed == 0, "{failed} scenes failed");
        Ok(())
    }

    /// Draws and runs scenes of one kind, adds their tables to `text`, and returns how many failed.
    fn of_kind(&self, kind: Kind, text: &mut String) -> Result<usize> {
        let name = name(kind);
        let out = self.output.clone().unwrap_or_else(out_directory).join("campaign").join(&name);
        let style = ProgressStyle::with_template("{msg:30} {wide_bar:.cyan/blue} {pos}/{len} {elapsed:>4}")?;
        let all = kind.count();
        let scenes = self.scenes.unwrap_or(all.unwrap_or(DRAWN)).min(all.unwrap_or(u64::MAX));
        let bar = ProgressBar::new(scenes).with_style(style).with_message(format!("{name}, seed {}", self.seed));
        let turns = self.turns.unwrap_or_else(|| turns(kind));
        let draws = Draws { kind, scenes, seed: self.seed, turns, effort: 1.0 };
        let hangs = |number: u64, file: &SceneFile| {
            let name = format!("{}-{number}-hangs", self.seed);
            let kept = keep(&out, &name, "The run does not end.", file);
            let place = kept.map_or_else(|error| format!("{error:#}"), |file| shown(&file));
            bar.suspend(|| eprintln!("scene {number} has been running for {} s: {place}", HANGS.as_secs()));
            // A thread cannot be stopped from another one.
            exit(1);
        };
        let outcomes = draws.run(|| bar.inc(1), hangs);
        bar.finish_and_clear();
        let heading = format!("{name}: {turns} turns, seed {}", self.seed);
        let counts = table(&outcomes);
        say(format!("{heading}\n{}", counts.print()));
        *text += &format!("Scenes of the kind {heading}.\n\n{}\n", counts.markdown());
        if self.slowest > 0 {
            let slowest = slowest(&draws.slowest(&outcomes, self.slowest));
            say(slowest.print());
            *text += &(slowest.markdown() + "\n");
        }
        let mut failed = 0;
        for outcome in &outcomes {
            if let (Verdict::Failed(what), Some([drawn, simplest])) = (&outcome.verdict, &outcome.failure) {
                failed += 1;
                keep(&out, &drawn.name, what, drawn)?;
                let file = keep(&out, &format!("{}-simplest", drawn.name), what, simplest)?;
                say(format!("{}: {what}", shown(&file)));
            }
        }
        Ok(failed)
    }
}

/// Writes a scene file with a comment that says why it is kept.
fn keep(out: &Path, name: &str, what: &str, file: &SceneFile) -> Result<PathBuf> {
    fs::create_dir_all(out).with_context(|| format!("cannot make the directory {}", out.display()))?;
    let path = out.join(format!("{name}.toml"));
    let file = SceneFile { name: name.to_owned(), description: what.to_owned(), ..file.clone() };
    fs::write(&path, write(&file)).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(path)
}
