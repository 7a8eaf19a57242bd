//! `dynamics`: classification of a motion over many turns.

use super::{out_directory, shown};
use crate::dynamics::bifurcation::{From, Range};
use crate::dynamics::continuation::{Branch, Continuation};
use crate::dynamics::poincare::PoincareMap;
use crate::dynamics::portrait::Plan;
use crate::host::Setting;
use crate::report::dynamics as report;
use crate::report::table::Table;
use crate::scenes::Scenario;
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::scene::parameter::Parameter;
use std::fs;
use std::path::{Path, PathBuf};

/// Poincaré sections, phase portrait, journal orbits, impacts, spectrum, Lyapunov exponents and a verdict.
///
/// `--parameter` adds a bifurcation diagram over the range of a parameter. Runs in this process. The largest exponent is
/// measured with a second, neighbouring motion; all of them are measured with the tangent of the motion, which is exact
/// through impacts. With `--follow-orbit` the diagram shows branches of periodic motions, stable or not, with their
/// folds, period doublings, Neimark-Sacker bifurcations and grazing. Writes dynamics-SCENE.svg and its data as CSV and Parquet, a table, and
/// with `--parameter` dynamics-SCENE-bifurcation.svg with data.
#[derive(Args)]
pub struct Dynamics {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// Sets a parameter to a value in SI units or with a unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// Crank turns before the evaluation starts
    #[arg(long, default_value_t = 100, value_name = "TURNS")]
    transient: usize,
    /// Crank turns that are evaluated
    #[arg(long, default_value_t = 400, value_name = "TURNS", value_parser = clap::value_parser!(u32).range(6..=1_000_000))]
    turns: u32,
    /// Crank angle of the section, relative to the start angle
    #[arg(long, default_value_t = 0.0, value_name = "DEGREES")]
    section: f64,
    /// Crank turns in which all Lyapunov exponents are measured from the tangent of the motion; 0 for none
    #[arg(long, default_value_t = 100, value_name = "TURNS", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    tangent_turns: u32,
    /// Number of measurements of the exponents in each turn
    #[arg(long, default_value_t = 25, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    per_turn: u32,
    /// Draw a bifurcation diagram over this parameter
    #[arg(long, value_name = "NAME", requires = "from", requires = "to")]
    parameter: Option<String>,
    /// First value, in SI units
    #[arg(long, value_name = "VALUE")]
    from: Option<f64>,
    /// Last value
    #[arg(long, value_name = "VALUE")]
    to: Option<f64>,
    /// Number of values
    #[arg(long, default_value_t = 60, value_name = "NUMBER")]
    values: usize,
    /// Crank turns that are evaluated for each value
    #[arg(long, default_value_t = 60, value_name = "TURNS", value_parser = clap::value_parser!(u32).range(6..=100_000))]
    value_turns: u32,
    /// Space the values logarithmically
    #[arg(long)]
    logarithmic: bool,
    /// Follow a branch: start each value from the end state of the value before, instead of the scene's start state
    #[arg(long)]
    follow: bool,
    /// Follow the branch of periodic motions that begins at the first value, stable or not, through folds
    #[arg(long, requires = "parameter")]
    follow_orbit: bool,
    /// How often the branch is left for one of twice the period
    #[arg(long, default_value_t = 1, value_name = "NUMBER", value_parser = clap::value_parser!(u8).range(0..=4))]
    doublings: u8,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Dynamics {
    /// Runs the scene, classifies the motion and writes the results.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let range = self.range()?;
        let plan = Plan {
            transient: self.transient,
            turns: self.turns as usize,
            section: self.section.to_radians(),
            per_turn: self.per_turn as usize,
            tangent_turns: self.tangent_turns as usize,
        };
        let style = ProgressStyle::with_template("{msg:14} {wide_bar:.cyan/blue} {percent}% {elapsed:>4} (eta {eta})")?;
        let bar = ProgressBar::new(plan.ticks() as u64).with_style(style.clone()).with_message("portrait");
        let portrait = plan.portrait(&scenario.file, || bar.inc(1))?;
        bar.finish_and_clear();
        let (name, scene) = (&scenario.name, &scenario.file.scene);
        let base = out.join(format!("dynamics-{name}"));
        let table = report::table(&portrait);
        println!("{}\n{name}: {}\n", table.print(), report::sentence(&portrait));
        let mut tables = vec![table];
        if let Some(exponents) = report::exponent_table(&portrait) {
            println!("{}", exponents.print());
            tables.push(exponents);
        }
        let mut written = vec![write(&base, "svg", &report::sheet(name, scene, &portrait).svg()?)?];
        let mut page = tables.iter().map(Table::markdown).collect::<Vec<_>>().join("\n");
        for (part, frame) in [
            ("section", report::visits(&portrait.visits)),
            ("path", report::visits(&portrait.path)),
            ("impacts", report::impact_frame(&portrait)),
            ("spectrum", report::spectrum_frame(&portrait)),
        ] {
            let file = out.join(format!("dynamics-{name}-{part}.parquet"));
            frame.save(&file)?;
            written.extend([file.with_extension("csv"), file]);
        }
        if let Some(range) = range {
            let plan = Plan { turns: self.value_turns as usize, tangent_turns: 0, ..plan };
            let bar = ProgressBar::new(range.values.len() as u64).with_style(style).with_message("bifurcation");
            let from = if self.follow { From::Before } else { From::Fresh };
            let branches = range.branches(&scenario.file, &plan, from, || bar.inc(1))?;
            bar.finish_and_clear();
            let verdicts = report::verdicts(&range, &branches);
            println!("{}", verdicts.print());
            page += &format!("\n{}", verdicts.markdown());
            tables.push(verdicts);
            let orbits = if self.follow_orbit { self.orbits(&scenario, &plan, &range)? } else { vec![] };
            if self.follow_orbit {
                for table in [report::bifurcations(&range, &orbits), report::ends(&orbits)] {
                    println!("{}", table.print());
                    page += &format!("\n{}", table.markdown());
                    tables.push(table);
                }
                let base = out.join(format!("dynamics-{name}-orbits"));
                report::orbit_frame(&range, &orbits).save(&base)?;
                written.extend(["csv", "parquet"].map(|ending| base.with_extension(ending)));
            }
            let base = out.join(format!("dynamics-{name}-bifurcation"));
            let sheet = report::bifurcation(name, scene, &range, &branches, &orbits);
            written.push(write(&base, "svg", &sheet.svg()?)?);
            report::bifurcation_frame(&range, &branches).save(&base)?;
            written.extend(["csv", "parquet"].map(|ending| base.with_extension(ending)));
        }
        written.push(write(&base, "md", &page)?);
        written.iter().for_each(|file| println!("{}", shown(file)));
        Table::complete(&tables)
    }

    /// Branches of periodic motions from the first value of the range on.
    fn orbits(&self, scenario: &Scenario, plan: &Plan, range: &Range) -> Result<Vec<Branch>> {
        let parameter = Parameter::named(&range.name).context("a parameter")?;
        let (from, to) = (range.values[0], range.values[range.values.len() - 1]);
        let map = PoincareMap::new(&scenario.file, parameter, plan.section)?;
        let start = plan.periodic(&map, from)?;
        let bar = ProgressBar::new_spinner().with_message("branches");
        let continuation = Continuation { map: &map, from, to, doublings: self.doublings.into() };
        let branches = continuation.follow(start, |value| {
            bar.set_message(format!("branches: {} = {value:.5e}", range.name));
            bar.tick();
        });
        bar.finish_and_clear();
        branches
    }

    fn range(&self) -> Result<Option<Range>> {
        let Some(name) = &self.parameter else { return Ok(None) };
        let (from, to) = (self.from.context("--from is missing")?, self.to.context("--to is missing")?);
        Range::new(name, from, to, self.values, self.logarithmic).map(Some)
    }
}

fn write(base: &Path, ending: &str, text: &str) -> Result<PathBuf> {
    let file = base.with_extension(ending);
    fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}
