//! `solver.deadline` for this machine: the evaluations within which no communication step takes more than its share of a
//! core.
//!
//! The method gives up accuracy before it makes more evaluations, so that the longest step is bounded by their number.
//! What an evaluation takes depends on machine, scene and method. The search therefore measures steps within a first
//! guess, corrects the guess by what the worst step took, and measures again. Each run is made twice, and the shorter time
//! of a step counts.

use super::deadline::{Bench, Trial};
use super::scheduler::{Scheduler, in_real_time};
use super::{STEP, Step, Timing};
use crate::precision::ladder::Rung;
use anyhow::Result;
use std::time::Duration;

/// Maximum number of guesses.
const GUESSES: usize = 6;
/// A guess whose worst step takes at least this share of what it may take needs no correction.
const CLOSE: f64 = 0.9;
/// Part of a step that a corrected guess is meant to take of what it may take.
const AIM: f64 = 0.95;
/// Largest error, in clearances, that a loop can do with.
pub const TOLERABLE: f64 = 1e-2;

/// A scene within a budget of evaluations, and without.
#[derive(Clone, Debug, PartialEq)]
pub struct Budgeted {
    /// The scene.
    pub scene: String,
    /// Share of a core.
    pub share: f64,
    /// [s] Time in which errors count, or why there is no reference.
    pub window: Result<f64, String>,
    /// Without a deadline.
    pub free: Trial,
    /// [1/s] The largest deadline found whose worst step keeps to the share; the one whose worst step is shortest if none
    /// does.
    pub deadline: f64,
    /// Within it.
    pub kept: Trial,
    /// The scheduler of the steps within it.
    pub scheduler: Scheduler,
}

impl Budgeted {
    /// Searches for the deadline of one scene for each of the `shares` of a core, in ascending order, until one of them
    /// is kept with a tolerable error. Takes `count` steps for every guess, or as many as `budget` allows.
    ///
    /// # Errors
    /// If a run cannot be compared with the reference.
    pub fn of(bench: &Bench, shares: &[f64], count: usize, budget: Duration, tick: impl Fn()) -> Result<Vec<Self>> {
        let scene = &bench.subject.file.scene;
        let (method, tolerance) = (scene.solver.method, Rung::Tolerance(scene.solver.tolerance));
        let trial = |rung| {
            tick();
            let (trial, scheduler) = in_real_time(|| bench.trial(method, rung, count, budget, true));
            Ok::<_, anyhow::Error>((trial?, scheduler))
        };
        let (free, scheduler) = trial(tolerance)?;
        let mut all: Vec<Self> = Vec::new();
        for share in shares {
            let (window, name) = (bench.window(), bench.subject.file.name.clone());
            let mut found = Self {
                scene: name,
                share: *share,
                window,
                free: free.clone(),
                deadline: 0.0,
                kept: free.clone(),
                scheduler: scheduler.clone(),
            };
            let (mut guess, mut least_refused) = (found.first_guess(), f64::INFINITY);
            for _ in 0..GUESSES {
                let (kept, _) = trial(Rung::Deadline(guess))?;
                let tried = Self { deadline: guess, kept, ..found.clone() };
                let part = tried.part();
                // A smaller deadline need not make the worst step shorter.
                let is_better =
                    if found.is_kept() { tried.is_kept() && guess > found.deadline } else { part < found.part() };
                if is_better || found.deadline == 0.0 {
                    found = tried;
                }
                if (CLOSE..=1.0).contains(&part) || !part.is_finite() || found.has_spare() {
                    break;
                }
                if part > 1.0 {
                    least_refused = guess.min(least_refused);
                }
                guess = if found.is_kept() && least_refused.is_finite() {
                    (found.deadline * least_refused).sqrt()
                } else {
                    guess * (AIM / part).clamp(0.5, 2.0)
                };
            }
            let done = found.is_kept() && found.kept.point.error.is_none_or(|error| error <= TOLERABLE);
            all.push(found);
            if done {
                break;
            }
        }
        Ok(all)
    }

    /// [1/s] The evaluations that the share would allow at the price that they have in the longest step without a deadline.
    fn first_guess(&self) -> f64 {
        let longest =
            self.free.timing.as_ref().map_or_else(|_| Step::default(), |timing| timing.longest(|step| step.cpu));
        if longest.cpu > 0.0 { self.share * longest.evaluations.max(1.0) / longest.cpu } else { 1.0 / STEP }
    }

    /// The worst step within the deadline over what it may take.
    fn part(&self) -> f64 {
        self.kept.timing.as_ref().map_or(f64::INFINITY, Timing::worst) / (self.share * STEP)
    }

    /// Whether the worst step within the deadline keeps to the share.
    pub fn is_kept(&self) -> bool {
        self.deadline > 0.0 && self.part() <= 1.0
    }

    /// Whether no step needed more evaluations than it had.
    fn has_spare(&self) -> bool {
        self.is_kept() && self.hits() == 0.0
    }

    /// Share of the steps of the integrator that had larger errors for lack of evaluations.
    pub fn hits(&self) -> f64 {
        let Ok(timing) = &self.kept.timing else { return f64::NAN };
        let sum = |measure: fn(&super::Step) -> f64| timing.steps.iter().map(measure).sum::<f64>();
        sum(|step| step.hits) / sum(|step| step.steps).max(1.0)
    }
}
