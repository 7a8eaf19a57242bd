//! The error of the coupled press: a study that Python runs on the package, and its results.

use crate::python::{output, script};
use crate::trajectory::Trajectory;
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The plan of the study; see `python/press/study.py`.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// [s] Communication step of the strokes.
    pub stroke_step: f64,
    /// [s] Length of the run of strokes.
    pub stroke_stop: f64,
    /// Factors of all clearances; 0 means ideal joints.
    pub factors: Vec<f64>,
    /// [s] Communication step of the runs with different clearances.
    pub clearance_step: f64,
    /// [s] Length of these runs.
    pub clearance_stop: f64,
    /// [s] Communication steps that are compared.
    pub steps: Vec<f64>,
    /// [s] Communication steps of the reference and of a second run that measures the reference's error.
    pub references: [f64; 2],
    /// [s] Time for which runs are compared.
    pub step_stop: f64,
    /// [s] Runs are compared at multiples of this time, which is a multiple of all steps.
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

/// The results of the study.
#[derive(Clone, Debug, Deserialize)]
pub struct Study {
    /// The run of the strokes.
    pub strokes: Strokes,
    /// Bottom dead centre for each clearance.
    pub clearances: Vec<DeadCentre>,
    /// Runs with ideal joints, by master and communication step.
    pub ideal: Convergence,
    /// Runs with clearances, by master and communication step.
    pub worn: Convergence,
    /// All outputs over the strokes.
    #[serde(skip)]
    pub trajectory: Trajectory,
}

/// Statistics of some complete strokes.
#[derive(Clone, Debug, Deserialize)]
pub struct Strokes {
    /// Number of strokes.
    pub strokes: f64,
    /// [s] Time of one stroke.
    pub lasts: f64,
    /// [N·m] Largest torque.
    pub torque: f64,
    /// [N·m] Root mean square of the torque.
    pub rms_torque: f64,
    /// Share of the time at the torque limit.
    pub limited: f64,
    /// [N·m] Torque limit.
    pub limit: f64,
    /// [rad/s] Minimum speed of the crank.
    pub slowest: f64,
    /// [rad/s] Maximum speed of the crank.
    pub fastest: f64,
    /// [J] Work on the sheet in one stroke, as the sheet counts it: by the velocity at the start of each step.
    pub cut: f64,
    /// Energy through each port.
    pub ports: Ports,
}

/// Results for one factor of the clearances.
#[derive(Clone, Debug, Deserialize)]
pub struct DeadCentre {
    /// [m] Clearance of main bearing and crank pin.
    pub clearance: f64,
    /// [m] Distance of the slider's turning point beyond that with ideal joints, for each stroke.
    pub dead_centre: Vec<f64>,
    /// [m] Error of the slider's position at the largest load, for each stroke.
    pub loaded: Vec<f64>,
}

/// Errors of runs by master and step against a reference.
#[derive(Clone, Debug, Deserialize)]
pub struct Convergence {
    /// The runs.
    pub points: Vec<Point>,
    /// Difference between two references.
    pub floor: Floor,
}

/// Root mean squares of the difference between two references.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Floor {
    /// [rad/s] Difference in the crank's speed.
    pub speed: f64,
    /// [m] Difference in the slider's position.
    pub position: f64,
}

/// One run.
#[derive(Clone, Debug, Deserialize)]
pub struct Point {
    /// Master: the way in which inputs continue between communication points.
    pub method: String,
    /// [s] Communication step.
    pub step: f64,
    /// [rad/s] Root mean square of the error of the crank's speed.
    pub speed: f64,
    /// [m] Root mean square of the error of the slider's position.
    pub position: f64,
    /// Mean number of passes for one step.
    pub passes: f64,
    /// [s/s] CPU time of the whole master per simulated second.
    pub cost: f64,
    /// Energy through each port.
    pub ports: Ports,
}

/// Energies by the name of the port, `torque` and `load`.
pub type Ports = BTreeMap<String, Port>;

/// [J] Energy that went into the press through a port.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct Port {
    /// Computed from the press's outputs.
    pub inside: f64,
    /// Computed from the outputs of the other component.
    pub outside: f64,
    /// Sum of the absolute values.
    pub exchanged: f64,
}

impl Port {
    /// [J] Energy that the coupling generated or, if negative, lost.
    pub fn residual(&self) -> f64 {
        self.inside - self.outside
    }
}

impl Study {
    /// Runs the plan on a package with the interpreter `python`. The strokes are written to the file `strokes` as a
    /// table.
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
        let study: Self = serde_json::from_str(&answer).context("the results of the study cannot be read")?;
        Ok(Self { trajectory: Trajectory::read_csv(strokes)?, ..study })
    }
}
