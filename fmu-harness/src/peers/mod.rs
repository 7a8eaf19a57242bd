//! Other programs run the same scene: CPU time per simulated second against error.
//!
//! Every program runs a series of tolerances or of step sizes. [`Ruler`] measures the error. The time is that of the
//! fastest of several runs over the scene's whole time without output, on one thread. Programs with rigid contacts are
//! measured against our own solution with rigid contacts, and their cost is compared with its cost.

mod child;
mod ours;
mod programs;
mod ruler;
mod tools;

pub use ruler::Ruler;

use crate::precision;
use crate::scenes::{Scenario, contests};
use anyhow::Result;
use child::Answer;
use programs::Program;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::parameter::PARAMETERS;
use slidercrank::simulation::System;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;
use tools::Tools;

/// The runs of one method of one program.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The program.
    pub peer: String,
    /// Its method.
    pub method: String,
    /// Whether its contacts are rigid.
    pub rigid: bool,
    /// Its runs, from the loosest tolerance to the tightest.
    pub points: Vec<Point>,
    /// Notes for the reader: differences of its model, failures, how to install it.
    pub notes: Vec<String>,
}

/// One run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Tolerance, or step [s] of a method without one.
    pub tolerance: f64,
    /// Largest error of the run, divided by the clearance.
    pub error: f64,
    /// [s/s] CPU time per simulated second.
    pub cost: f64,
    /// Evaluations of the right-hand side per simulated second, or steps if the program does not count evaluations.
    pub evaluations: f64,
}

/// All programs on one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Contest {
    /// The scene.
    pub scene: String,
    /// The series of all programs. The first series is that of the packaged FMU, with which the others are compared.
    /// Series with rigid contacts are compared with the first series with rigid contacts.
    pub series: Vec<Series>,
    /// [s] Length of a run.
    pub span: f64,
    /// Difference between two reference solutions by different methods.
    pub reference_error: f64,
}

/// The problem to solve.
pub struct Task {
    /// The scene.
    pub scenario: Scenario,
    /// Path of its file.
    pub file: PathBuf,
    /// [s] Length of a run.
    pub span: f64,
    /// Number of equidistant instants at which the error is measured.
    pub points: usize,
}

impl Task {
    /// The whole run of a scene with the inputs' start values. The error is measured at the scene's communication
    /// points.
    pub fn of(name: &str) -> Result<Self> {
        let scenario = Scenario::find(name)?;
        let run = &scenario.file.run;
        let points = (run.stop(&scenario.file.scene) / run.step).round();
        let (span, points) = (points * run.step, points as usize);
        let file = crate::scenes::file(name)?;
        Ok(Self { scenario, file, span, points })
    }

    /// Keeps the first `points` of its instants.
    fn shorten(&mut self, points: usize) {
        self.span *= points as f64 / self.points as f64;
        self.points = points;
    }

    /// The input of a Python program, as JSON.
    fn job(&self, system: &System, tolerances: &[f64], library: &str) -> String {
        let scene = &self.scenario.file.scene;
        let inputs = Inputs::at_start(&self.scenario.file);
        let states = system.size().states;
        let (mut start, mut scales) = (vec![0.0; states], vec![0.0; states]);
        system.write_start(&mut start);
        system.write_scales(&mut scales);
        let parameters = PARAMETERS.iter().map(|parameter| (parameter.name, parameter.value(scene).into()));
        let parameters: serde_json::Map<String, serde_json::Value> =
            parameters.map(|(name, value)| (name.to_owned(), value)).collect();
        serde_json::json!({
            "parameters": parameters,
            "inputs": { "crank_torque": inputs.crank_torque, "slider_load": inputs.slider_load },
            "span": self.span,
            "points": self.points,
            "tolerances": tolerances,
            "start": start,
            "scales": scales,
            "longest_step": system.longest_step(),
            "file": self.file,
            "library": library,
        })
        .to_string()
    }
}

/// The default scenes: those in scenes/peers, and the scenes of `precision` that have no counterpart there.
pub fn scenes() -> Vec<String> {
    let mut all = contests();
    let others = precision::SCENES.into_iter().filter(|name| !made_for_contest(name));
    all.extend(others.map(str::to_owned));
    all
}

/// A shipped scene of this name, with precedence for scenes/peers, or a file.
pub fn scene(name: &str) -> String {
    if made_for_contest(name) { format!("peers/{name}") } else { name.to_owned() }
}

fn made_for_contest(name: &str) -> bool {
    contests().contains(&format!("peers/{name}"))
}

/// Runs all programs that support the scene, one after the other, for as long as its motion is known. `budget` is the
/// longest wall time for one method of one program. `progress` is called with the name of the next program.
pub fn contest(mut task: Task, budget: Duration, progress: impl Fn(&str)) -> Result<Contest> {
    progress("reference");
    let ruler = Ruler::new(&mut task)?;
    let task = &task;
    let mut series = ours::series(task, &ruler, &progress)?;
    let system = System::start(&task.scenario.file.scene, Inputs::at_start(&task.scenario.file))?;
    let tools = Tools::new(&progress);
    let programs = programs::of(&task.scenario.file.scene);
    let rigid = if programs.iter().any(|program| program.rigid) {
        progress("SliderCrank moreau");
        let rigid = Ruler::rigid(task)?;
        series.push(ours::rigid(task, &rigid)?);
        Some(rigid)
    } else {
        None
    };
    for program in programs {
        progress(&format!("{} {}", program.peer, program.method));
        let ruler = rigid.as_ref().filter(|_| program.rigid).unwrap_or(&ruler);
        series.push(compete(task, ruler, &system, &tools, program, budget)?);
    }
    let scene = task.scenario.name.clone();
    Ok(Contest { scene, series, span: task.span, reference_error: ruler.own_error })
}

/// Runs one method of one program.
fn compete(
    task: &Task,
    ruler: &Ruler,
    system: &System,
    tools: &Tools,
    program: &Program,
    budget: Duration,
) -> Result<Series> {
    let Program { peer, method, note, ladder, rigid, .. } = *program;
    let mut series = Series { peer: peer.into(), method: method.into(), rigid, points: vec![], notes: vec![] };
    series.notes.extend(note.map(str::to_owned));
    let job = tools.directory.join("job.json");
    fs::create_dir_all(&tools.directory)?;
    fs::write(&job, task.job(system, ladder, &tools.library_path()))?;
    let command = match tools.command(task, program, &job) {
        Ok(command) => command,
        Err(missing) => {
            series.notes = vec![format!("not installed: {missing}")];
            return Ok(series);
        }
    };
    let (answers, ending) = child::run(command, budget)?;
    series.notes.extend(ending);
    for answer in &answers {
        match answer {
            Answer::Run { tolerance, seconds, evaluations, found } => {
                let error = ruler.error(&ruler.paths(system, found));
                let (cost, evaluations) = (seconds / task.span, evaluations / task.span);
                series.points.push(Point { tolerance: *tolerance, error, cost, evaluations });
            }
            Answer::Failure { tolerance, note } => series.notes.push(format!("at {tolerance:.0e}: {note}")),
        }
    }
    Ok(series)
}
