//! The cost of accuracy: error and time of every method at a series of tolerances.
//!
//! All runs use the packaged FMU through its C interface, in this process, so that the shipped machine code is timed.
//! Errors are measured on a grid of communication points. Costs are measured at long communication steps, so that they
//! are those of the integration alone. [`hosts`] measures what a host's communication steps add, [`exchange`] a host's
//! own integrator with the same equations.

pub mod choice;
pub mod diagram;
pub mod exchange;
pub mod hosts;
pub mod ladder;
pub mod reference;
pub mod ruler;

use crate::host::Fmu;
use crate::inputs::{self, Input};
use crate::run::{Experiment, Until};
use ladder::{Rung, settings};
use slidercrank::scene::Method;
use slidercrank::scene::read::SceneFile;
use std::f64::consts::TAU;

/// Scenes whose diagrams are drawn by default.
pub const SCENES: [&str; 6] = ["wornpin", "press", "allplay", "guideplay", "flexrod", "seed"];

/// [s] Communication step that does not shorten the method's steps.
const LONG_STEP: f64 = 1e-3;

/// A scene as a packaged FMU.
pub struct Subject<'a> {
    /// The scene.
    pub file: &'a SceneFile,
    /// Its package.
    pub fmu: &'a Fmu,
    /// Lengths of its runs.
    pub lengths: Lengths,
}

/// Lengths of runs; without a value the scene decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// [s] Time in which errors count.
    pub window: Option<f64>,
    /// [s] Time over which costs are measured; not shorter than the window.
    pub span: Option<f64>,
}

impl Lengths {
    /// The default: two crank turns for errors, one for costs.
    pub const OF_SCENE: Self = Self { window: None, span: None };
}

impl Subject<'_> {
    /// [s] Time of one crank turn at the start speed; `None` if the crank is at rest.
    pub fn turn(&self) -> Option<f64> {
        let speed = self.file.scene.crank.speed_start.abs();
        (speed > 0.0).then_some(TAU / speed)
    }

    /// [s] The end of the scene's own run.
    pub fn stop(&self) -> f64 {
        self.file.run.stop(&self.file.scene)
    }

    /// [s] Time over which costs are measured by default: the first turn, but not less than the window.
    pub fn span(&self, window: f64) -> f64 {
        self.lengths.span.or_else(|| self.turn().map(|turn| turn.min(self.stop()))).unwrap_or(window).max(window)
    }

    /// An experiment up to `end` [s] in communication steps of `step` [s].
    pub fn experiment(&self, method: Method, rung: Rung, end: f64, step: f64) -> Experiment {
        Experiment {
            settings: settings(method, rung),
            inputs: inputs::of_scene(&self.file.inputs),
            start: 0.0,
            until: Until::Time(end),
            step,
            tolerance: None,
        }
    }

    /// [s] Communication step for measuring costs: the scene's own if inputs change, since every change restarts the
    /// integration; otherwise a long one.
    pub fn cost_step(&self) -> f64 {
        let constant = inputs::of_scene(&self.file.inputs).iter().all(Input::is_constant);
        if constant { LONG_STEP } else { self.file.run.step }
    }
}
