//! Settings for a loop that waits for every step: the longest time of a step, and the error.
//!
//! A method with error control makes its evaluations where the motion requires them, so that few communication steps
//! contain most evaluations. A method with a fixed step makes the same number in each step, and a few more for every
//! contact that opens or closes.

use super::{STEP, Timing};
use crate::precision::Subject;
use crate::precision::diagram::{Point, Verdict};
use crate::precision::ladder::{Rung, settings};
use crate::precision::reference::Reference;
use crate::precision::ruler::Ruler;
use anyhow::Result;
use slidercrank::scene::Method;
use std::time::Duration;

/// The settings that are compared.
pub const TRIED: [(Method, Rung); 6] = [
    (Method::Automatic, Rung::Tolerance(1e-6)),
    (Method::Automatic, Rung::Tolerance(1e-4)),
    (Method::Automatic, Rung::Tolerance(1e-3)),
    (Method::Rk4, Rung::Step(1e-6)),
    (Method::Rk4, Rung::Step(2e-6)),
    (Method::Rk4, Rung::Step(5e-6)),
];
/// Share of a step that the mechanism may take in a loop.
pub const SHARE: f64 = 0.5;
/// A setting with a larger error has lost the motion.
const LOST: f64 = 0.1;
/// Time limits of the reference's two runs, and of a run over its window.
const BUDGET: Duration = Duration::from_secs(8);

/// One setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Its error in the window, and the ending of that run.
    pub point: Point,
    /// Its communication steps, or why they ended early.
    pub timing: Result<Timing, String>,
}

impl Trial {
    /// Why it failed, in the window or in a later step.
    pub fn failure(&self) -> Option<&str> {
        match &self.point.verdict {
            Verdict::Failed(why) => Some(why),
            _ => self.timing.as_ref().err().map(String::as_str),
        }
    }

    /// Longest time of a step, as a share of the step.
    pub fn share(&self) -> Option<f64> {
        Some(self.timing.as_ref().ok()?.bound() / STEP)
    }
}

/// A scene and its reference solution.
pub struct Bench<'a> {
    /// The scene and its package.
    pub subject: &'a Subject<'a>,
    ruler: Ruler,
    /// The reference, or why there is none.
    reference: Result<Reference, String>,
}

impl<'a> Bench<'a> {
    /// Computes the reference solution of a scene.
    pub fn of(subject: &'a Subject<'a>) -> Self {
        let ruler = Ruler::of(&subject.file.scene);
        let reference = Reference::of(subject, &ruler, BUDGET).map_err(|error| format!("{error:#}"));
        Self { subject, ruler, reference }
    }

    /// [s] Time in which errors count, or why there is no reference.
    pub fn window(&self) -> Result<f64, String> {
        self.reference.as_ref().map(|reference| reference.window).map_err(Clone::clone)
    }

    /// Measures the error of a setting, and the times of `count` steps with it, or of as many as `budget` allows, in one run
    /// or in the shorter of two.
    ///
    /// # Errors
    /// If the run cannot be compared with the reference.
    pub fn trial(&self, method: Method, rung: Rung, count: usize, budget: Duration, twice: bool) -> Result<Trial> {
        let Self { subject, ruler, reference } = self;
        let point = match reference {
            Ok(reference) => Point::in_window(subject, ruler, reference, method, rung, BUDGET)?,
            Err(why) => Point::stopped(method, rung, why),
        };
        let run = || Timing::of(subject.file, subject.fmu, settings(method, rung), count, budget, |_| {});
        let timing = run().and_then(|once| Ok(if twice { once.shorter_of(&run()?) } else { once }));
        Ok(Trial { point, timing: timing.map_err(|error| format!("{error:#}")) })
    }
}

/// All settings of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Trials {
    /// The scene.
    pub scene: String,
    /// [s] Time in which errors count, or why there is no reference.
    pub window: Result<f64, String>,
    /// The settings in the order of [`TRIED`].
    pub trials: Vec<Trial>,
}

impl Trials {
    /// Takes `count` steps with every setting, or as many as `budget` allows. `tick` is called for every setting.
    ///
    /// # Errors
    /// If a run cannot be compared with the reference.
    pub fn of(bench: &Bench, count: usize, budget: Duration, tick: impl Fn(Method, Rung)) -> Result<Self> {
        let trial = |(method, rung)| {
            tick(method, rung);
            bench.trial(method, rung, count, budget, false)
        };
        let trials = TRIED.into_iter().map(trial).collect::<Result<_>>()?;
        Ok(Self { scene: bench.subject.file.name.clone(), window: bench.window(), trials })
    }

    /// The most accurate setting that leaves a loop its share of every step and does not lose the motion.
    pub fn choice(&self) -> Option<&Trial> {
        let in_time = |trial: &&Trial| trial.failure().is_none() && trial.share().is_some_and(|share| share <= SHARE);
        let known = self.trials.iter().filter(in_time).filter_map(|trial| Some((trial, trial.point.error?)));
        known.filter(|(_, error)| *error <= LOST).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(trial, _)| trial)
    }
}
