//! `dynamics`: classification of a motion over many turns.

use super::{out_directory, say, shown, write};
use crate::dynamics::bifurcation::{Branch as Simulated, From, Range};
use crate::dynamics::continuation::{Branch, Continuation};
use crate::dynamics::orbit::Orbit;
use crate::dynamics::poincare::PoincareMap;
use crate::dynamics::portrait::Plan;
use crate::dynamics::response::Response;
use crate::frame::ended;
use crate::host::Setting;
use crate::report::dynamics as report;
use crate::report::response::{Curves, Responses};
use crate::report::table::Table;
use crate::scenes::Scenario;
use anyhow::{Context, Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::scene::Scene;
use slidercrank::scene::parameter::Parameter;
use std::fs;
use std::path::{Path, PathBuf};

/// Poincaré sections, phase portrait, journal orbits, impacts, spectrum, Lyapunov exponents and a verdict.
///
/// `--parameter` adds a bifurcation diagram over the range of a parameter. Runs in this process. The largest exponent is
/// measured with a second, neighbouring motion; all of them are measured with the tangent of the motion, which is exact
/// through impacts. With `--follow-orbit` the diagram shows branches of periodic motions, stable or not, with their
/// folds, period doublings, Neimark-Sacker bifurcations and grazing. `--response` draws an output over the parameter:
/// with `--up-and-down` the frequency response with its jumps. Writes dynamics-SCENE.svg and its data as CSV and Parquet,
/// a table, with `--parameter` dynamics-SCENE-bifurcation.svg with data, and with `--response`
/// dynamics-SCENE-response.svg with data.
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
    /// Crank angle of the section, in the direction of rotation from the start angle
    #[arg(long, default_value_t = 0.0, value_name = "DEGREES", allow_negative_numbers = true)]
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
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    from: Option<f64>,
    /// Last value
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
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
    /// Run the values from the first to the last and back, each from the end state of the one before
    #[arg(long, requires = "parameter", conflicts_with = "follow")]
    up_and_down: bool,
    /// Draw an output, reduced over whole turns, over the parameter, such as rod.deflection:peak or joint.C.force:range
    #[arg(long, requires = "parameter", value_name = "OUTPUT:REDUCTION")]
    response: Option<Response>,
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
        ensure!(self.section.is_finite(), "the section must be an angle in degrees, not {}", self.section);
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenario = Scenario::find(&self.scene)?.with(&self.set)?;
        let range = self.range()?;
        if let Some(range) = &range {
            range.check(&scenario.file)?;
        }
        let plan = Plan {
            transient: self.transient,
            turns: self.turns as usize,
            section: self.section.rem_euclid(360.0).to_radians(),
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
        say(format!("{}\n{name}: {}\n", table.print(), report::sentence(&portrait)));
        let mut tables = vec![table];
        if let Some(exponents) = report::exponent_table(&portrait) {
            say(exponents.print());
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
            let file = out.join(format!("dynamics-{name}-{part}"));
            frame.save(&file)?;
            written.extend(["csv", "parquet"].map(|ending| ended(&file, ending)));
        }
        let mut followed = Ok(());
        if let Some(range) = range {
            let plan = Plan { turns: self.value_turns as usize, tangent_turns: 0, ..plan };
            let mut diagram = self.simulated(&scenario, &plan, range, style)?;
            if self.follow_orbit {
                // Branches take long: what is known by then stays if they are interrupted.
                diagram.write(&out, name, scene)?;
                write(&base, "md", &page)?;
                followed = self.orbits(&scenario, &plan, &mut diagram);
            }
            for table in diagram.tables() {
                say(table.print());
                page += &format!("\n{}", table.markdown());
                tables.push(table);
            }
            written.extend(diagram.write(&out, name, scene)?);
        }
        written.push(write(&base, "md", &page)?);
        written.iter().for_each(|file| say(shown(file)));
        followed?;
        Table::complete(&tables)
    }

    /// The simulated points over the range of the parameter.
    fn simulated(&self, scenario: &Scenario, plan: &Plan, range: Range, style: ProgressStyle) -> Result<Diagram> {
        let ways = if self.up_and_down { 2 } else { 1 };
        let bar = ProgressBar::new((ways * range.values.len()) as u64).with_style(style).with_message("bifurcation");
        let tick = || bar.inc(1);
        let (simulated, back) = if self.up_and_down {
            let [there, back] = range.up_and_down(&scenario.file, plan, tick)?;
            (there, back)
        } else {
            let from = if self.follow { From::Before } else { From::Fresh };
            (range.branches(&scenario.file, plan, from, tick)?, vec![])
        };
        bar.finish_and_clear();
        Ok(Diagram { range, simulated, back, followed: None, responses: vec![] })
    }

    /// Adds branches of periodic motions from the first value of the range on.
    fn orbits(&self, scenario: &Scenario, plan: &Plan, diagram: &mut Diagram) -> Result<()> {
        let Diagram { range, .. } = diagram;
        let parameter = Parameter::named(&range.name).context("a parameter")?;
        let (from, to) = (range.values[0], range.values[range.values.len() - 1]);
        let map = PoincareMap::new(&scenario.file, parameter, plan.section)?;
        let start = plan.periodic(&map, from).with_context(|| format!("{} = {from}", range.name))?;
        let bar = ProgressBar::new_spinner().with_message("branches");
        let continuation = Continuation { map: &map, from, to, doublings: self.doublings.into() };
        let branches = continuation.follow(start, |value| {
            bar.set_message(format!("branches: {} = {value:.5e}", range.name));
            bar.tick();
        })?;
        bar.finish_and_clear();
        if let Some(response) = &range.response {
            let of = |orbit: &Orbit| map.response(orbit, response).unwrap_or(f64::NAN);
            let all = branches.iter().map(|branch| Responses {
                motions: branch.orbits.iter().map(of).collect(),
                found: branch.found.iter().map(|found| of(&found.orbit)).collect(),
            });
            diagram.responses = all.collect();
        }
        diagram.followed = Some(branches);
        Ok(())
    }

    fn range(&self) -> Result<Option<Range>> {
        let Some(name) = &self.parameter else { return Ok(None) };
        let (from, to) = (self.from.context("--from is missing")?, self.to.context("--to is missing")?);
        let range = Range::new(name, from, to, self.values, self.logarithmic)?;
        ensure!(!self.follow_orbit || from != to, "--follow-orbit needs a range: --from and --to are both {from}");
        Ok(Some(Range { response: self.response.clone(), ..range }))
    }
}

/// What is known over the range of a parameter.
struct Diagram {
    range: Range,
    /// From the first value to the last, and back if that was asked for.
    simulated: Vec<Simulated>,
    back: Vec<Simulated>,
    /// Branches of periodic motions, if they were asked for, and their responses.
    followed: Option<Vec<Branch>>,
    responses: Vec<Responses>,
}

impl Diagram {
    fn followed(&self) -> &[Branch] {
        self.followed.as_deref().unwrap_or_default()
    }

    fn curves(&self) -> Curves<'_> {
        let Self { range, simulated, back, responses, .. } = self;
        Curves { range, simulated: [simulated, back], followed: self.followed(), responses }
    }

    fn tables(&self) -> Vec<Table> {
        let mut tables = vec![report::verdicts(&self.range, &self.simulated)];
        if !self.back.is_empty() {
            tables.push(report::verdicts(&self.range, &self.back));
        }
        if let Some(followed) = &self.followed {
            tables.extend([report::bifurcations(&self.range, followed), report::ends(followed)]);
        }
        if self.range.response.is_some() && !self.back.is_empty() {
            tables.push(self.curves().table());
        }
        tables
    }

    /// Writes figures and data of the scene `name`; the files.
    fn write(&self, out: &Path, name: &str, scene: &Scene) -> Result<Vec<PathBuf>> {
        let mut written = vec![];
        let base = |part: &str| out.join(format!("dynamics-{name}-{part}"));
        let simulated: Vec<&Simulated> = self.simulated.iter().chain(&self.back).collect();
        let sheet = report::bifurcation(name, scene, &self.range, &simulated, self.followed());
        written.push(write(&base("bifurcation"), "svg", &sheet.svg()?)?);
        let mut frames = vec![("bifurcation", report::bifurcation_frame(&self.range, &simulated))];
        if self.followed.is_some() {
            frames.push(("orbits", report::orbit_frame(&self.range, self.followed())));
        }
        if self.range.response.is_some() {
            written.push(write(&base("response"), "svg", &self.curves().sheet(name, scene).svg()?)?);
            frames.push(("response", self.curves().frame()));
        }
        for (part, frame) in frames {
            frame.save(&base(part))?;
            written.extend(["csv", "parquet"].map(|ending| ended(&base(part), ending)));
        }
        Ok(written)
    }
}
