//! `report`: one page about a scene.

use super::{out_directory, package, run as runs, say, shown};
use crate::accuracy::{self, comparisons};
use crate::dynamics::portrait;
use crate::effects::Price;
use crate::host::Fmu;
use crate::precision::diagram::{Budget, Diagram};
use crate::precision::reference::Reference;
use crate::precision::ruler::Ruler;
use crate::precision::{Lengths, Subject};
use crate::report::figure::{self, Pair};
use crate::report::page::film::Film;
use crate::report::page::{Section, calls, page};
use crate::report::{self as reports, summary};
use crate::scenes::Scenario;
use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::model::signals::Inputs;
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::Simulation;
use std::fs;
use std::path::PathBuf;

/// Number of measurements of the exponent in each turn.
const PER_TURN: usize = 25;

/// One self-contained HTML page about a scene, with an animation, figures that can be zoomed, and tables.
///
/// The scene is packaged, and the package is run with its joints and with ideal joints. The page also shows the motion
/// over many turns, its accuracy, and the cost of accuracy from a work-precision diagram with few tolerances. The page
/// needs no network. Writes report-SCENE.html.
#[derive(Args)]
pub struct Report {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// Crank turns before the motion over many turns is evaluated
    #[arg(long, default_value_t = 20, value_name = "TURNS")]
    transient: usize,
    /// Crank turns for which the motion over many turns is evaluated
    #[arg(long, default_value_t = 100, value_name = "TURNS", value_parser = clap::value_parser!(u32).range(6..=1_000_000))]
    turns: u32,
    /// Leave out measured times: the cost of accuracy and of an evaluation
    #[arg(long)]
    unmeasured: bool,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

impl Report {
    /// Runs the scene and writes the page.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let scenario = Scenario::find(&self.scene)?;
        let (name, file) = (&scenario.name, &scenario.file);
        let packaged = out.join(format!("{name}.fmu"));
        package::write(&scenario, &packaged)?;
        let fmu = Fmu::open(&packaged)?;

        let style = ProgressStyle::with_template("{msg:20} {wide_bar:.cyan/blue} {percent:>3} % {elapsed:>4}")?;
        let bar = ProgressBar::new(0).with_style(style);
        let [actual, ideal] = runs::beside_ideal(&fmu, file, name)?;
        let pair = Pair { title: name, actual: &actual, ideal: &ideal };
        let film = Film::of(&actual)?;
        let mut sections = vec![called_for(file)?, motion(&pair)?];
        sections.extend(journals(&pair)?);
        sections.extend(effects(&pair)?);
        sections.push(or_why("In the long run", self.long_run(file, &bar)));
        sections.push(or_why("Accuracy of the slider", accuracy_of(file, &bar)));
        if !self.unmeasured {
            let subject = Subject { file, fmu: &fmu, lengths: Lengths::OF_SCENE };
            sections.push(or_why("Cost of accuracy", price(&subject, &bar)));
        }
        bar.finish_and_clear();

        let html = out.join(format!("report-{name}.html"));
        let text = page(name, &file.description, &film, &sections)?;
        fs::write(&html, text).with_context(|| format!("cannot write {}", html.display()))?;
        say(shown(&html));
        Ok(())
    }

    fn long_run(&self, file: &SceneFile, bar: &ProgressBar) -> Result<Section> {
        let turns = self.turns as usize;
        let plan =
            portrait::Plan { transient: self.transient, turns, section: 0.0, per_turn: PER_TURN, tangent_turns: 0 };
        begin(bar, "in the long run", plan.ticks());
        let portrait = plan.portrait(file, || bar.inc(1))?;
        let sheet = reports::dynamics::sheet(&file.name, &file.scene, &portrait);
        let section =
            Section::new("In the long run").saying(capitalized(&reports::dynamics::sentence(&portrait)) + ".");
        Ok(section.showing(&sheet).telling(reports::dynamics::table(&portrait)))
    }
}

/// A section, or its title with the error that prevented it.
fn or_why(title: &str, section: Result<Section>) -> Section {
    section.unwrap_or_else(|error| Section::missing(title, format!("Not shown: {error:#}.")))
}

fn begin(bar: &ProgressBar, what: &'static str, ticks: usize) {
    bar.set_message(what);
    bar.set_length(ticks as u64);
    bar.set_position(0);
}

fn called_for(file: &SceneFile) -> Result<Section> {
    let size = Simulation::start(&file.scene, Inputs::at_start(file))?.size();
    Ok(Section::new("What the scene calls for").saying(calls::sentence(&size)).telling(calls::table(file)))
}

fn motion(pair: &Pair) -> Result<Section> {
    let mut section = Section::new("Motion and forces").showing(&figure::slider_motion(pair)?);
    section = section.showing(&figure::slider_error(pair)?).showing(&figure::joint_forces(pair)?);
    for sheet in [figure::guide_play(pair)?, figure::rod_shape(pair)?].into_iter().flatten() {
        section = section.showing(&sheet);
    }
    let tables = summary::mechanism(pair)?;
    Ok(tables.into_iter().fold(section, Section::telling))
}

fn journals(pair: &Pair) -> Result<Option<Section>> {
    Ok(figure::journal_paths(pair)?.map(|sheet| Section::new("Journals in their bearings").showing(&sheet)))
}

/// A section for each effect that the scene calls for: oil, what lies between communication points, energies.
fn effects(pair: &Pair) -> Result<Vec<Section>> {
    let mut sections = vec![];
    if let Some(sheet) = figure::oil_films(pair)? {
        let text = "The film beside the dry contact of rough surfaces, which begins at three times the roughness.";
        let section = Section::new("Oil").saying(text).showing(&sheet);
        sections.push(section.telling(summary::oil_films(pair.actual)?));
    }
    if let Some(table) = summary::intervals(pair.actual)? {
        let text = "Found within the integrator's steps, whatever the communication points are.";
        sections.push(Section::new("Between communication points").saying(text).telling(table));
    }
    if let Some(table) = summary::energies(pair.actual)? {
        let text = "Since the start; the residual is the error of the balance.";
        sections.push(Section::new("Energies").saying(text).telling(table));
    }
    Ok(sections)
}

fn accuracy_of(file: &SceneFile, bar: &ProgressBar) -> Result<Section> {
    let plan = accuracy::Plan { transient: 2, turns: 5 };
    let parts = comparisons(file);
    begin(bar, "accuracy", parts.iter().map(|(_, cases)| cases.len()).sum());
    let text = "The slider against that of the ideal mechanism at the same crank angle. At bottom dead centre \
                crank and rod are in line, and the slider is farthest from the crank.";
    let section = Section::new("Accuracy of the slider").saying(text);
    Ok(parts.iter().fold(section, |section, (heading, cases)| {
        let measured = plan.measure_all(cases, || bar.inc(1));
        section.telling(reports::accuracy::table(heading, cases, &measured))
    }))
}

fn price(subject: &Subject, bar: &ProgressBar) -> Result<Section> {
    begin(bar, "price of accuracy", 0);
    let ruler = Ruler::of(&subject.file.scene);
    let reference = Reference::of(subject, &ruler, Budget::QUICK.reference)?;
    let diagram = Diagram::of(subject, &ruler, &reference, &Budget::QUICK, |_, _| bar.tick())?;
    let diagrams = [diagram];
    let [diagram] = &diagrams;
    let section = Section::new("Cost of accuracy").saying(reports::precision::sentence(diagram));
    let mut section = section.showing(&reports::precision::sheet(diagram));
    section.legend.clear();
    let section = section.telling(reports::precision::cheapest(&diagrams));
    let section = section.telling(reports::precision::tolerances(&diagrams));
    let price = Price::of(subject.file, subject.fmu, subject.span(reference.window))?;
    Ok(section.telling(reports::price::prices(&[price])))
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
