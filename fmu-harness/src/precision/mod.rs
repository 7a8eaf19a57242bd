//! What accuracy costs: every method at a ladder of tolerances, the error that it reaches and the time that it takes.
//!
//! All runs go through the packaged FMU, by its C interface, in this process: what is timed is the machine code that is
//! shipped. Errors are taken on a grid of communication points; costs at long communication steps, so that they are
//! those of the integration alone. [`hosts`] tells what a host's communication steps add,
//! [`exchange`] what a host's own integrator makes of the same equations.

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

/// Scenes whose diagrams are drawn unless one is asked for.
pub const SCENES: [&str; 6] = ["wornpin", "press", "allplay", "guideplay", "flexrod", "seed"];

/// [s] Communication step that leaves a method alone.
const LONG_STEP: f64 = 1e-3;

/// A scene as a packaged FMU.
pub struct Subject<'a> {
    /// What was asked for.
    pub file: &'a SceneFile,
    /// The same, packaged.
    pub fmu: &'a Fmu,
    /// How long it is looked at.
    pub lengths: Lengths,
}

/// How long a scene is looked at, where that is not left to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lengths {
    /// [s] No error is taken after this.
    pub window: Option<f64>,
    /// [s] What costs are taken over; the window in any case.
    pub span: Option<f64>,
}

impl Lengths {
    /// Two turns of the crank for errors, one for costs.
    pub const OF_SCENE: Self = Self { window: None, span: None };
}

impl Subject<'_> {
    /// [s] One turn of the crank at its start speed; `None` of a crank at rest.
    pub fn turn(&self) -> Option<f64> {
        let speed = self.file.scene.crank.speed_start.abs();
        (speed > 0.0).then_some(TAU / speed)
    }

    /// [s] The end of the scene's own run.
    pub fn stop(&self) -> f64 {
        self.file.run.stop(&self.file.scene)
    }

    /// [s] What costs are taken over, if nothing else is asked for: the first turn; the whole window in any case.
    pub fn span(&self, window: f64) -> f64 {
        self.lengths.span.or_else(|| self.turn().map(|turn| turn.min(self.stop()))).unwrap_or(window).max(window)
    }

    /// A run to `end` [s] in communication steps of `step` [s].
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

    /// [s] The communication step at which costs are taken: the scene's own where inputs change, since every change
    /// begins a new integration, and a long one otherwise.
    pub fn cost_step(&self) -> f64 {
        let constant = inputs::of_scene(&self.file.inputs).iter().all(Input::is_constant);
        if constant { LONG_STEP } else { self.file.run.step }
    }
}
