//! Error and cost of an importer's own integrator with model exchange: CVode in FMPy.
//!
//! The host is written in Python and calls the FMU for every evaluation. Most of the cost is that of the calls.

use super::Subject;
use super::hosts::outcomes;
use super::reference::Reference;
use super::ruler::Ruler;
use crate::inputs;
use crate::python::{output, script};
use crate::trajectory::Trajectory;
use anyhow::{Context, Result, bail};
use serde_json::{Map, Value, json};
use slidercrank::scene::Method;
use slidercrank::scene::profile::Profile;
use std::fs;
use std::path::Path;

/// Relative tolerances of the host.
pub const TOLERANCES: [f64; 4] = [1e-5, 1e-7, 1e-9, 1e-11];
/// [s] Interval of outputs.
const STEP: f64 = 1e-5;

/// One scene at one tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct ExchangePoint {
    /// The scene.
    pub scene: String,
    /// The host's relative tolerance.
    pub tolerance: f64,
    /// The results, or why there are none.
    pub outcome: Result<Found, String>,
}

/// The results of CVode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The largest error in the window.
    pub error: f64,
    /// [s/s] CPU time of the host's process per simulated second.
    pub cost: f64,
}

/// Runs the packaged scene `file` in FMPy, with the interpreter `python`.
pub fn measure(
    python: &Result<std::path::PathBuf>,
    subject: &Subject,
    file: &Path,
    ruler: &Ruler,
    reference: &Reference,
) -> Vec<ExchangePoint> {
    let outcome = outcomes(python, |python| found(python, subject, file, ruler, reference));
    let scene = &subject.file.name;
    let point = |(place, tolerance)| ExchangePoint { scene: scene.clone(), tolerance, outcome: outcome(place) };
    TOLERANCES.into_iter().enumerate().map(point).collect()
}

fn found(
    python: &Path,
    subject: &Subject,
    file: &Path,
    ruler: &Ruler,
    reference: &Reference,
) -> Result<Vec<Result<Found, String>>> {
    let mut constant = Map::new();
    for input in inputs::of_scene(&subject.file.inputs) {
        let Profile::Constant(value) = input.profile else {
            bail!("its inputs change over time, which this host does not support")
        };
        constant.insert(input.name, value.into());
    }
    if subject.file.scene.solver.method == Method::Moreau {
        bail!("scenes with rigid contacts have no model exchange");
    }
    let folder = tempfile::tempdir()?;
    let job = json!({
        "fmu": file,
        "folder": folder.path(),
        "settings": {},
        "inputs": constant,
        "tolerances": TOLERANCES,
        "window": reference.window,
        "step": STEP,
        "kept": ruler.outputs(),
    });
    let order = folder.path().join("job.json");
    fs::write(&order, job.to_string())?;
    let answer: Value = serde_json::from_str(&output(script(python, "exchange.py").arg(&order))?)?;
    let list = answer.as_array().context("the host did not return a list")?;
    let entry = |(place, entry): (usize, &Value)| -> Result<Result<Found, String>> {
        if let Some(why) = entry["failed"].as_str() {
            return Ok(Err(why.to_owned()));
        }
        let cost = entry["cost"].as_f64().context("the host did not return `cost`")?;
        let run = Trajectory::read_csv(&folder.path().join(format!("{place}.csv")))?;
        Ok(Ok(Found { error: ruler.error(&run, &reference.trajectory, reference.window)?, cost }))
    };
    list.iter().enumerate().map(entry).collect()
}
