//! How long one communication step takes, again and again: what a controller that waits for it asks.
//!
//! A step is timed by the clock on the wall, which other programs on the machine lengthen, and by this thread's use of
//! the processor, which they hardly do: a step that is long by the first and not by the second was interrupted.

pub mod deadline;

use crate::host::{Fmu, Log, Selection, Setting};
use crate::inputs;
use crate::run::{ANGLE, Experiment, Runner, Until};
use anyhow::{Context, Result};
use cpu_time::ThreadTime;
use slidercrank::scene::read::SceneFile;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// [s] The communication step.
pub const STEP: f64 = 1e-3;
/// A crank that makes less than this share of a turn in a turn's time at its start speed begins anew: a mechanism at
/// rest is no test.
const SLOW: f64 = 0.5;
/// What the FMU is asked after every step: its counters, and how far the crank has turned.
const ASKED: [&str; 4] = ["solver.steps", "solver.evaluations", "solver.events", ANGLE];

/// One communication step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// [s] The time that it led to.
    pub end: f64,
    /// [s] In fmi2DoStep, by the clock on the wall.
    pub wall: f64,
    /// [s] The same, by this thread's use of the processor.
    pub cpu: f64,
    /// Steps of the integrator in it.
    pub steps: f64,
    /// Evaluations of the right-hand side in it.
    pub evaluations: f64,
    /// Contacts that opened or closed in it.
    pub events: f64,
}

/// Many steps of one scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timing {
    /// The scene.
    pub scene: String,
    /// In their order.
    pub steps: Vec<Step>,
    /// How often the scene began anew.
    pub restarts: usize,
    /// How many steps were asked for.
    pub asked: usize,
}

impl Timing {
    /// Takes `count` steps of the packaged scene with these settings, or as many as `budget` allows; `tick` hears of
    /// every one, how many there are.
    ///
    /// # Errors
    /// If the FMU refuses a setting or a step.
    pub fn of(
        file: &SceneFile,
        fmu: &Fmu,
        settings: Vec<Setting>,
        count: usize,
        budget: Duration,
        tick: impl Fn(usize),
    ) -> Result<Self> {
        let experiment = Experiment {
            settings,
            inputs: inputs::of_scene(&file.inputs),
            start: 0.0,
            until: Until::Time(f64::MAX),
            step: STEP,
            tolerance: None,
        };
        let speed = file.scene.crank.speed_start.abs();
        let steps_of_a_turn = (TAU / (speed * STEP)).ceil();
        let clock = Instant::now();
        let mut timing = Self { scene: file.name.clone(), asked: count, ..Self::default() };
        let is_over = |timing: &Self| timing.steps.len() >= count || clock.elapsed() > budget;
        while !is_over(&timing) {
            let mut bench = Bench::start(fmu, &experiment)?;
            let (mut since, mut last) = (0.0, bench.angle());
            while !is_over(&timing) {
                timing.steps.push(bench.step()?);
                tick(timing.steps.len());
                since += 1.0;
                if since < steps_of_a_turn {
                    continue;
                }
                if (bench.angle() - last).abs() < SLOW * TAU {
                    timing.restarts += 1;
                    break;
                }
                (since, last) = (0.0, bench.angle());
            }
        }
        Ok(timing)
    }

    /// The step that took longest by this measure.
    pub fn longest(&self, measure: fn(&Step) -> f64) -> Step {
        self.steps.iter().copied().max_by(|a, b| measure(a).total_cmp(&measure(b))).unwrap_or_default()
    }

    /// The measure of all steps, in ascending order.
    pub fn sorted(&self, measure: fn(&Step) -> f64) -> Vec<f64> {
        let mut numbers: Vec<f64> = self.steps.iter().map(measure).collect();
        numbers.sort_by(f64::total_cmp);
        numbers
    }

    /// [s] CPU time per evaluation, events, outputs and interface shared out.
    pub fn per_evaluation(&self) -> f64 {
        let sum = |measure: fn(&Step) -> f64| self.steps.iter().map(measure).sum::<f64>();
        sum(|step| step.cpu) / sum(|step| step.evaluations)
    }

    /// [s] What the step with the most evaluations takes on a processor that nobody else uses.
    pub fn bound(&self) -> f64 {
        self.longest(|step| step.evaluations).evaluations * self.per_evaluation()
    }
}

/// The number that `share` of the ascending `numbers` do not exceed.
pub fn quantile(numbers: &[f64], share: f64) -> f64 {
    let place = (share * numbers.len() as f64).ceil() as usize;
    numbers.get(place.clamp(1, numbers.len().max(1)) - 1).copied().unwrap_or_default()
}

/// An FMU between two steps.
struct Bench<'a> {
    experiment: &'a Experiment,
    runner: Runner<'a>,
    asked: Selection,
    counts: [f64; 3],
    point: usize,
}

impl<'a> Bench<'a> {
    fn start(fmu: &'a Fmu, experiment: &'a Experiment) -> Result<Self> {
        let variables =
            ASKED.map(|name| fmu.description().variable(name)).into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut asked = Selection::new(variables);
        let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(|_| {})), true)?;
        runner.ask(&mut asked)?;
        let counts = counts(&asked);
        Ok(Self { experiment, runner, asked, counts, point: 0 })
    }

    /// [rad] Of the crank.
    fn angle(&self) -> f64 {
        self.asked.values()[3]
    }

    fn step(&mut self) -> Result<Step> {
        self.point += 1;
        let (from, to) = self.experiment.interval(self.point).context("time is over")?;
        self.runner.apply_inputs(from)?;
        let (cpu, wall) = (ThreadTime::now(), Instant::now());
        self.runner.step(from, to)?;
        let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
        self.runner.ask(&mut self.asked)?;
        let after = counts(&self.asked);
        let [steps, evaluations, events] = std::array::from_fn(|i| after[i] - self.counts[i]);
        self.counts = after;
        Ok(Step { end: to, wall, cpu, steps, evaluations, events })
    }
}

fn counts(asked: &Selection) -> [f64; 3] {
    [0, 1, 2].map(|place| asked.values()[place])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timing() -> Timing {
        let step = |wall: f64, cpu: f64, evaluations: f64| Step {
            end: 0.001,
            wall,
            cpu,
            steps: 2.0,
            evaluations,
            events: 1.0,
        };
        let steps = vec![step(5.0, 1.0, 100.0), step(2.0, 2.0, 200.0), step(3.0, 3.0, 200.0), step(1.0, 1.0, 200.0)];
        Timing { scene: "own".into(), steps, restarts: 0, asked: 4 }
    }

    #[test]
    fn quantiles_are_numbers_of_the_list() {
        let numbers: Vec<f64> = (1..=1000).map(f64::from).collect();
        let found = [0.0, 0.5, 0.999, 0.9991, 1.0].map(|share| quantile(&numbers, share));
        assert_eq!(found, [1.0, 500.0, 999.0, 1000.0, 1000.0]);
        assert_eq!(quantile(&[], 0.5), 0.0);
    }

    #[test]
    fn an_interrupted_step_is_long_by_the_clock_alone() {
        let timing = timing();
        assert_eq!((timing.longest(|step| step.wall).cpu, timing.longest(|step| step.cpu).wall), (1.0, 3.0));
        assert_eq!(timing.sorted(|step| step.wall), [1.0, 2.0, 3.0, 5.0]);
    }

    #[test]
    fn the_bound_is_the_most_evaluations_at_their_mean_price() {
        let timing = timing();
        assert_eq!(timing.per_evaluation(), 7.0 / 700.0);
        assert_eq!(timing.bound(), 200.0 * 7.0 / 700.0);
    }
}
