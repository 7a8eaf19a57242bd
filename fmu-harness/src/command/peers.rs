//! `peers`: other programs run the same scene.

use super::{out_directory, say, shown};
use crate::peers::{Contest, Task, contest, scene, scenes};
use crate::report::contest::{sentence, sheet, summary, table, write_csv};
use crate::report::docs::{Docs, Section};
use crate::report::table::Table;
use anyhow::{Context, Result};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Measures what other programs need for the same scene: SUNDIALS, SciPy, heyoka, diffsol, Exudyn, MuJoCo, Siconos.
///
/// Every method of every program, this one included, runs a series of tolerances or step sizes, one after the other on
/// one thread. The table gives CPU seconds per simulated second at equal error, interpolated between runs, and the
/// ratio to the packaged FMU. The error is the largest difference of any joint's eccentricity from a reference
/// solution, divided by the clearance. Inputs keep their start values; a run ends where two reference solutions begin
/// to differ. Python packages are installed under target/peers; other missing tools are named, with the command that
/// installs them. Writes peers.csv, peers.md and peers.svg.
#[derive(Args)]
pub struct Peers {
    /// Scene: the name of a shipped scene, or a .toml file [default: the scenes in fmu-harness/scenes/peers, and those
    /// of `precision`]
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Longest wall time for one method of one program, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 60)]
    budget: u64,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
    #[command(flatten)]
    docs: Docs,
}

impl Peers {
    /// Runs all programs and writes the tables.
    pub fn execute(&self) -> Result<()> {
        let section = self.docs.section("peers", self.scene.as_deref())?;
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenes = self.scene.as_ref().map_or_else(scenes, |name| vec![scene(name)]);
        let mut done = vec![];
        for scene in &scenes {
            let task = Task::of(scene)?;
            let progress = |what: &str| eprintln!("{scene}: {what}");
            let found = contest(task, Duration::from_secs(self.budget), progress).with_context(|| scene.clone())?;
            say(format!("{}\n{}\n", table(&found).print(), sentence(&found)));
            done.push(found);
        }
        report(&done, &out, section)
    }
}

fn report(contests: &[Contest], out: &Path, section: Option<Section>) -> Result<()> {
    let [csv, page, drawing] = ["csv", "md", "svg"].map(|ending| out.join(format!("peers.{ending}")));
    write_csv(contests, &csv)?;
    let summary = summary(contests);
    say(summary.print());
    let tables: Vec<Table> = contests.iter().map(table).collect();
    let pages = contests.iter().zip(&tables).map(|(contest, table)| table.markdown() + "\n" + &sentence(contest));
    let text = std::iter::once(summary.markdown()).chain(pages).collect::<Vec<_>>().join("\n\n") + "\n";
    for (file, text) in [(&page, &text), (&drawing, &sheet(contests).svg()?)] {
        fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
    }
    [csv, page, drawing].iter().for_each(|file| say(shown(file)));
    Table::complete(&tables)?;
    section.map_or(Ok(()), |section| section.write(&text))
}
