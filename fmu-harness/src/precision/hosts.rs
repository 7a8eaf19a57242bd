//! Error and cost of the same FMU in FMPy, at several communication steps.

use super::Subject;
use super::reference::Reference;
use super::ruler::Ruler;
use crate::inputs::{self, Input};
use crate::python::{output, script};
use crate::trajectory::Trajectory;
use anyhow::{Context, Result};
use serde_json::{Value, json};
use slidercrank::scene::Method;
use slidercrank::scene::profile::Profile;
use std::fs;
use std::path::Path;

/// [s] Communication steps.
pub const STEPS: [f64; 3] = [1e-5, 1e-4, 1e-3];
/// Method that the FMU uses.
pub const METHOD: Method = Method::Automatic;
/// Its tolerance.
pub const TOLERANCE: f64 = 1e-6;
/// Number of runs. The cheapest one counts.
const REPEATS: usize = 5;
/// Outputs that a host reads at each communication point.
const READ: [&str; 4] = ["slider.x", "slider.v", "joint.C.force.x", "joint.C.force.y"];

/// One scene at one communication step.
#[derive(Clone, Debug, PartialEq)]
pub struct HostPoint {
    /// The scene.
    pub scene: String,
    /// [s] The communication step.
    pub step: f64,
    /// The results, or why there are none.
    pub outcome: Result<Found, String>,
}

/// The results of FMPy.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The largest error at the communication points of the window, if there is one after the start.
    pub error: Option<f64>,
    /// [s/s] CPU time of the host's process per simulated second, with four outputs read at each point.
    pub total: f64,
    /// [s/s] The same, minus the CPU time with an FMU that does nothing.
    pub unit: f64,
    /// Evaluations of the right-hand side per simulated second.
    pub evaluations: f64,
    /// [s] Simulated time over which costs were measured.
    pub over: f64,
    /// [s] Time in which errors count.
    pub window: f64,
}

/// Results of a host's runs, by the number of the run, or why there are none.
pub fn outcomes<T: Clone>(
    python: &Result<std::path::PathBuf>,
    run: impl FnOnce(&Path) -> Result<Vec<Result<T, String>>>,
) -> impl Fn(usize) -> Result<T, String> {
    let found = match python {
        Ok(python) => run(python).map_err(|error| format!("{error:#}")),
        Err(error) => Err(format!("{error:#}")),
    };
    move |place| match &found {
        // The first line of the error is enough.
        Err(why) => Err(why.lines().last().unwrap_or_default().to_owned()),
        Ok(found) => found.get(place).cloned().unwrap_or_else(|| Err("the host returned no result".to_owned())),
    }
}

/// Runs the packaged scene `file` in FMPy, with the interpreter `python`; over `span` [s] for its cost.
pub fn measure(
    python: &Result<std::path::PathBuf>,
    subject: &Subject,
    file: &Path,
    ruler: &Ruler,
    reference: &Reference,
    span: f64,
) -> Vec<HostPoint> {
    let outcome = outcomes(python, |python| {
        Ok(found(python, subject, file, ruler, reference, span)?.into_iter().map(Ok).collect())
    });
    let scene = &subject.file.name;
    let point = |(place, step): (usize, f64)| HostPoint { scene: scene.clone(), step, outcome: outcome(place) };
    STEPS.into_iter().enumerate().map(point).collect()
}

fn found(
    python: &Path,
    subject: &Subject,
    file: &Path,
    ruler: &Ruler,
    reference: &Reference,
    span: f64,
) -> Result<Vec<Found>> {
    let folder = tempfile::tempdir()?;
    let window = reference.window;
    let job = json!({
        "fmu": file,
        "folder": folder.path(),
        "settings": { "solver.method": METHOD.value(), "solver.tolerance": TOLERANCE },
        "inputs": inputs::of_scene(&subject.file.inputs).iter().map(input).collect::<Vec<Value>>(),
        "steps": STEPS,
        "window": window,
        "span": STEPS.into_iter().fold(span, f64::max),
        "kept": ruler.outputs(),
        "read": READ,
        "repeats": REPEATS,
    });
    let order = folder.path().join("job.json");
    fs::write(&order, job.to_string())?;
    let answer: Value = serde_json::from_str(&output(script(python, "cost.py").arg(&order))?)?;
    let list = answer.as_array().context("the host did not return a list")?;
    let entry = |(place, entry): (usize, &Value)| -> Result<Found> {
        let number = |name: &str| entry[name].as_f64().with_context(|| format!("the host did not return `{name}`"));
        let run = Trajectory::read_csv(&folder.path().join(format!("{place}.csv")))?;
        let (total, host) = (number("total")?, number("host")?);
        Ok(Found {
            error: if run.len() > 1 { Some(ruler.error(&run, &reference.trajectory, window)?) } else { None },
            total,
            unit: total - host,
            evaluations: number("evaluations")?,
            over: number("over")?,
            window,
        })
    };
    list.iter().enumerate().map(entry).collect()
}

/// The inputs as JSON for the script.
fn input(input: &Input) -> Value {
    match &input.profile {
        Profile::Constant(value) => json!({ "name": input.name, "value": value }),
        Profile::Points { against, points } => {
            let column = |place: usize| points.iter().map(|point| point[place]).collect::<Vec<f64>>();
            json!({ "name": input.name, "over": against.name(), "x": column(0), "y": column(1) })
        }
    }
}
