//! What coupling does to the press: the study that Python runs on the package, and what it found.

use crate::python::{output, script};
use crate::trajectory::Trajectory;
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What to run: see `python/press/study.py`.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// [s] Communication step of the strokes.
    pub stroke_step: f64,
    /// [s] How long they are run.
    pub stroke_stop: f64,
    /// Factors of every clearance; 0 stands for ideal joints.
    pub factors: Vec<f64>,
    /// [s] Communication step of these runs.
    pub clearance_step: f64,
    /// [s] How long they are run.
    pub clearance_stop: f64,
    /// [s] Communication steps to compare.
    pub steps: Vec<f64>,
    /// [s] Communication steps of the reference and of a run that tells how good it is.
    pub references: [f64; 2],
    /// [s] How long runs are compared.
    pub step_stop: f64,
    /// [s] They are compared at multiples of this, which all steps divide.
    pub grid: f64,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            stroke_step: 1e-4,
            stroke_stop: super::STOP,
            factors: vec![0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0],
            clearance_step: 5e-5,
            clearance_stop: 1.55,
            steps: vec![1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3],
            references: [4e-6, 5e-6],
            step_stop: 0.25,
            grid: 2e-3,
        }
    }
}

/// What was found.
#[derive(Clone, Debug, Deserialize)]
pub struct Study {
    /// The run that hosts see.
    pub strokes: Strokes,
    /// Bottom dead centre, by clearance.
    pub clearances: Vec<DeadCentre>,
    /// By master and communication step, with ideal joints.
    pub ideal: Convergence,
    /// The same with play.
    pub worn: Convergence,
    /// Every output over the strokes.
    #[serde(skip)]
    pub trajectory: Trajectory,
}

/// An account of some whole strokes.
#[derive(Clone, Debug, Deserialize)]
pub struct Strokes {
    /// How many.
    pub strokes: f64,
    /// [s] How long one lasts.
    pub lasts: f64,
    /// [N·m] Largest torque.
    pub torque: f64,
    /// [N·m] Its root mean square.
    pub rms_torque: f64,
    /// Share of the time at the limit.
    pub limited: f64,
    /// [N·m] The limit.
    pub limit: f64,
    /// [rad/s] Least speed of the crank.
    pub slowest: f64,
    /// [rad/s] Greatest.
    pub fastest: f64,
    /// [J] Work that a stroke does on the sheet.
    pub cut: f64,
    /// Energy through each port.
    pub ports: Ports,
}

/// One factor of the clearances.
#[derive(Clone, Debug, Deserialize)]
pub struct DeadCentre {
    /// [m] Of main bearing and crank pin.
    pub clearance: f64,
    /// [m] How far beyond its place with ideal joints the slider turns back, for each stroke.
    pub dead_centre: Vec<f64>,
    /// [m] Its error where the sheet holds it back most, for each stroke.
    pub loaded: Vec<f64>,
}

/// Runs by master and step against a reference.
#[derive(Clone, Debug, Deserialize)]
pub struct Convergence {
    /// The runs.
    pub points: Vec<Point>,
    /// What two references differ by.
    pub floor: Floor,
}

/// Root mean squares of what two references differ by.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Floor {
    /// [rad/s] Of the crank's speed.
    pub speed: f64,
    /// [m] Of the slider's place.
    pub position: f64,
}

/// One run.
#[derive(Clone, Debug, Deserialize)]
pub struct Point {
    /// How inputs go on between communication points.
    pub method: String,
    /// [s] Communication step.
    pub step: f64,
    /// [rad/s] Root mean square error of the crank's speed.
    pub speed: f64,
    /// [m] Of the slider's place.
    pub position: f64,
    /// How often a step was taken.
    pub passes: f64,
    /// [s/s] CPU time per simulated second, of the whole master.
    pub cost: f64,
    /// Energy through each port.
    pub ports: Ports,
}

/// By name: `torque` and `load`.
pub type Ports = BTreeMap<String, Port>;

/// Energy that went into the press, [J].
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct Port {
    /// By its own books.
    pub inside: f64,
    /// By the other side's.
    pub outside: f64,
    /// Without signs.
    pub exchanged: f64,
}

impl Port {
    /// [J] What the coupling made, or lost.
    pub fn residual(&self) -> f64 {
        self.inside - self.outside
    }
}

impl Study {
    /// Runs the plan on a package under the interpreter `python`. The strokes go to the file `strokes` as a table.
    pub fn run(python: &Path, package: &Path, strokes: &Path, plan: &Plan) -> Result<Self> {
        #[derive(Serialize)]
        struct Job<'a> {
            package: &'a Path,
            strokes: &'a Path,
            #[serde(flatten)]
            plan: &'a Plan,
        }
        let folder = tempfile::tempdir()?;
        let order: PathBuf = folder.path().join("job.json");
        fs::write(&order, serde_json::to_string(&Job { package, strokes, plan })?)?;
        let answer = output(script(python, "press/study.py").arg(&order))?;
        let study: Self = serde_json::from_str(&answer).context("the study's answer is not what was asked for")?;
        Ok(Self { trajectory: Trajectory::read_csv(strokes)?, ..study })
    }
}
