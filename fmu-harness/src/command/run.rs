//! `run`: runs a scene or any FMU, draws figures and prints a table.

use super::{out_directory, package, say, shown};
use crate::host::{Archive, Fmu, LogLine, Setting, Status};
use crate::inputs::{self, Input};
use crate::package::MODES;
use crate::report::figure::{self, Pair};
use crate::report::summary;
use crate::run::{ANGLE, Experiment, JOINTS, Recording, Until, afford, ideal_joints, run};
use crate::scenes::{Scenario, number};
use crate::trajectory::Trajectory;
use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::read::{SceneFile, read_with};
use slidercrank::scene::run::End;
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};

/// Parameter of the FMU: the crank's start speed.
const SPEED: &str = "crank.speed_start";
/// A crank that needs so many times longer than at its start speed counts as stuck.
const PATIENCE: f64 = 20.0;

/// Runs a scene, or any co-simulation FMU of FMI 2.0 or 3.0.
#[derive(Args, Default)]
#[command(allow_negative_numbers = true)]
pub struct Run {
    /// Scene: the name of a shipped scene, or a .toml file
    #[arg(long, default_value = "wornpin", value_name = "NAME|FILE")]
    scene: String,
    /// FMU file to run instead of a scene. Packages of this program contain the inputs and the length of their scene's
    /// run
    #[arg(long, value_name = "FILE", conflicts_with = "scene")]
    fmu: Option<PathBuf>,
    /// Crank turns [default: the scene's]
    #[arg(long, value_name = "NUMBER", conflicts_with = "stop")]
    turns: Option<f64>,
    /// Stop time in seconds, instead of turns
    #[arg(long, value_name = "SECONDS")]
    stop: Option<f64>,
    /// Communication step in seconds [default: the scene's, or that of the FMU's default experiment]
    #[arg(long, value_name = "SECONDS")]
    step: Option<f64>,
    /// Relative tolerance, instead of the FMU's own
    #[arg(long, value_name = "NUMBER")]
    tolerance: Option<f64>,
    /// CSV file of inputs, in place of the scene's of the same names: the first column is time, the others have the
    /// inputs' names
    #[arg(long, value_name = "FILE")]
    input: Option<PathBuf>,
    /// Sets a variable before initialization, with a unit if it is a parameter of ours; an input has this value during
    /// the whole run; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Setting>,
    /// Directory of the results [default: target/out]
    #[arg(short, long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

/// An FMU to run, the name of its results, and its scene if it has one.
struct Subject {
    name: String,
    fmu: Fmu,
    scene: Option<SceneFile>,
}

impl Run {
    /// Packages the scene, unless there is an FMU, runs it and writes the results.
    pub fn execute(&self) -> Result<()> {
        let out = self.output.clone().unwrap_or_else(out_directory);
        fs::create_dir_all(&out).with_context(|| format!("cannot make the directory {}", out.display()))?;
        let subject = self.subject(&out)?;
        let experiment = self.experiment(&subject.fmu, subject.scene.as_ref())?;
        let actual = watched(&subject.fmu, &experiment, &subject.name)?;
        let csv = out.join(format!("{}.csv", subject.name));
        let mut written = vec![csv.clone()];
        actual.trajectory.write_csv(&csv)?;
        if is_slider_crank(&subject.fmu) {
            let ideal = with_ideal_joints(&subject.fmu, &experiment)?;
            let pair = Pair { title: &subject.name, actual: &actual, ideal: &ideal };
            written.extend(draw(&pair, &out)?);
            say(format!("\n{}", summary::mechanism(&pair)?.map(|table| table.print()).join("\n")));
        } else {
            say(format!("\n{}", summary::outputs(subject.fmu.description(), &actual)?));
        }
        written.iter().for_each(|file| say(shown(file)));
        Ok(())
    }

    /// The FMU of the command line, or the packaged scene.
    fn subject(&self, out: &Path) -> Result<Subject> {
        match &self.fmu {
            Some(file) => {
                let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let scene = packaged_scene(file, &name)?;
                Ok(Subject { name, fmu: Fmu::open(file)?, scene })
            }
            None => {
                let scenario = Scenario::find(&self.scene)?;
                let file = out.join(format!("{}.fmu", scenario.name));
                package::write(&scenario, &file)?;
                Ok(Subject { name: scenario.name, fmu: Fmu::open(&file)?, scene: Some(scenario.file) })
            }
        }
    }

    /// The experiment of the command line, or else of the scene, or else of the FMU's default experiment.
    fn experiment(&self, fmu: &Fmu, scene: Option<&SceneFile>) -> Result<Experiment> {
        let suggested = |name: &str| fmu.description().experiment.number(name);
        let start = suggested("startTime").unwrap_or(0.0);
        let end = match (self.stop, self.turns, scene) {
            (Some(stop), ..) => End::Time(stop),
            (None, Some(turns), _) => End::Turns(turns),
            (None, None, Some(scene)) => scene.run.end,
            (None, None, None) => End::Time(suggested("stopTime").unwrap_or(start + 1.0)),
        };
        if let End::Turns(turns) = end {
            ensure!(turns > 0.0, "turns must be above 0, not {turns}");
        }
        let settings = self.settings()?;
        let (until, span) = match (end, start_speed(fmu, &settings)) {
            (End::Time(stop), _) => (Until::Time(stop), stop - start),
            (End::Turns(turns), Some(speed)) => {
                let span = turns * TAU / speed;
                (Until::Turns { turns, latest: start + PATIENCE * span }, span)
            }
            (End::Turns(_), None) => bail!("without `{SPEED}` the length of a turn is unknown; give a --stop time"),
        };
        let (Until::Time(latest) | Until::Turns { latest, .. }) = until;
        ensure!(latest > start, "the end, {latest} s, is not after the start, {start} s");
        let step = self.step.or(scene.map(|scene| scene.run.step)).or_else(|| suggested("stepSize"));
        let step = step.unwrap_or((latest - start) / 1000.0);
        afford(span, step)?;
        let inputs = self.inputs(scene, &settings)?;
        let experiment = Experiment { settings, inputs, start, until, step, tolerance: self.tolerance };
        ensure!(
            experiment.interval(1)?.is_some(),
            "the end, {latest:e} s, is too near to the start for a step of {step} s"
        );
        Ok(experiment)
    }

    /// The inputs that change during the run: those of the table, and of the scene those that neither the table nor a
    /// setting replaces.
    fn inputs(&self, scene: Option<&SceneFile>, settings: &[Setting]) -> Result<Vec<Input>> {
        let is_set = |input: &Input| settings.iter().any(|setting| setting.name == input.name);
        let mut table = vec![];
        if let Some(file) = &self.input {
            table = inputs::of_table(&Trajectory::read_csv(file)?).with_context(|| file.display().to_string())?;
            if let Some(Input { name, .. }) = table.iter().find(|input| is_set(input)) {
                bail!("`{name}` is both in --set and in {}", file.display());
            }
        }
        let of_scene = scene.map_or(vec![], |scene| inputs::of_scene(&scene.inputs));
        let in_table = |input: &Input| table.iter().any(|own| own.name == input.name);
        let left: Vec<Input> = of_scene.into_iter().filter(|input| !in_table(input) && !is_set(input)).collect();
        Ok([left, table].concat())
    }

    /// What the command line sets, in SI units where it names another unit of one of our parameters.
    fn settings(&self) -> Result<Vec<Setting>> {
        let in_si = |setting: &Setting| {
            let Setting { name, value } = setting;
            let Some(Parameter { kind: Kind::Real { unit, .. }, .. }) = Parameter::named(name) else {
                return Ok(setting.clone());
            };
            let number = number(value, unit).with_context(|| format!("{name} = {value}"))?;
            Ok(Setting { name: name.clone(), value: number.to_string() })
        };
        self.set.iter().map(in_si).collect()
    }
}

/// [rad/s] Start speed of the crank, if the FMU has a crank that turns.
fn start_speed(fmu: &Fmu, settings: &[Setting]) -> Option<f64> {
    let set =
        settings.iter().rev().find(|setting| setting.name == SPEED).and_then(|setting| setting.value.parse().ok());
    let declared = || fmu.description().variable(SPEED).ok()?.of_kind.number("start");
    set.or_else(declared).map(f64::abs).filter(|speed| *speed > 0.0)
}

/// The scene in a package of this program.
fn packaged_scene(file: &Path, name: &str) -> Result<Option<SceneFile>> {
    let mut archive = Archive::open(file)?;
    let text = archive.text("documentation/scene.toml");
    // The package has the table of modes under this name, whatever name the scene gives it.
    let modes = archive.text(&format!("documentation/{MODES}")).unwrap_or_default();
    Ok(text.and_then(|text| read_with(&text, name, &|_| Ok(modes.clone())).ok()))
}

/// Whether the FMU has the outputs for the figures of a slider-crank.
fn is_slider_crank(fmu: &Fmu) -> bool {
    let has = |name: &str| fmu.description().variable(name).is_ok();
    has(ANGLE) && has("accuracy.position") && JOINTS.iter().all(|joint| has(&format!("joint.{joint}.model")))
}

/// Runs the same experiment with ideal joints.
fn with_ideal_joints(fmu: &Fmu, experiment: &Experiment) -> Result<Recording> {
    let mut experiment = experiment.clone();
    experiment.settings.extend(ideal_joints());
    watched(fmu, &experiment, "the same with ideal joints").context("with ideal joints")
}

/// Runs the package of a scene with the scene's joints and with ideal joints.
pub(super) fn beside_ideal(fmu: &Fmu, scene: &SceneFile, name: &str) -> Result<[Recording; 2]> {
    let run = Run::default();
    let experiment = run.experiment(fmu, Some(scene))?;
    Ok([watched(fmu, &experiment, name)?, with_ideal_joints(fmu, &experiment)?])
}

/// Runs with a progress bar. Log lines of the FMU are printed above the bar.
fn watched(fmu: &Fmu, experiment: &Experiment, name: &str) -> Result<Recording> {
    let style = ProgressStyle::with_template("{msg:30} {wide_bar:.cyan/blue} {percent:>3} % {elapsed:>4}")?;
    let bar = ProgressBar::new(1000).with_style(style).with_message(name.to_owned());
    let above = bar.clone();
    let log = move |line: &LogLine| {
        if line.status != Status::Ok {
            above.suspend(|| eprintln!("{} [{}] {}", line.status, line.category, line.message));
        }
    };
    let recording = run(fmu, experiment, log, |share| bar.set_position((share.min(1.0) * 1000.0) as u64));
    bar.finish_and_clear();
    recording
}

/// Draws every figure for which the run has data, and returns the files.
fn draw(pair: &Pair, out: &Path) -> Result<Vec<PathBuf>> {
    let sheets = [
        ("slider", Some(figure::slider_motion(pair)?)),
        ("forces", Some(figure::joint_forces(pair)?)),
        ("journal", figure::journal_paths(pair)?),
        ("guide", figure::guide_play(pair)?),
        ("rod", figure::rod_shape(pair)?),
    ];
    let mut files = Vec::new();
    for (what, sheet) in sheets {
        let Some(sheet) = sheet else { continue };
        let file = out.join(format!("{}-{what}.svg", pair.title));
        fs::write(&file, sheet.svg()?).with_context(|| format!("cannot write {}", file.display()))?;
        files.push(file);
    }
    Ok(files)
}
