//! Times of single communication steps, for controllers that wait for each step.
//!
//! Every step has a wall time, which other programs on the machine lengthen, and a CPU time of this thread, which they
//! hardly change. If only the wall time is long, the step was interrupted.

pub mod budget;
pub mod deadline;
pub mod scheduler;

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
/// The run is restarted if the crank makes less than this share of a turn in the time of a turn at its start speed,
/// since a mechanism at rest is not a useful measurement.
const SLOW: f64 = 0.5;
/// Outputs that are read after every step: counters, and the crank's angle.
const ASKED: [&str; 6] =
    ["solver.steps", "solver.evaluations", "solver.events", "solver.deadline_hits", "solver.error_estimate", ANGLE];

/// One communication step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// [s] Time at its end.
    pub end: f64,
    /// [s] Wall time in fmi2DoStep.
    pub wall: f64,
    /// [s] CPU time of this thread in fmi2DoStep.
    pub cpu: f64,
    /// Number of steps of the integrator.
    pub steps: f64,
    /// Number of evaluations of the right-hand side.
    pub evaluations: f64,
    /// Number of contacts that opened or closed.
    pub events: f64,
    /// Number of steps of the integrator with a larger error than the tolerance, for lack of evaluations.
    pub hits: f64,
    /// Estimated error of the step, in clearances.
    pub error: f64,
}

/// Many steps of one scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timing {
    /// The scene.
    pub scene: String,
    /// The steps in their order.
    pub steps: Vec<Step>,
    /// Number of restarts.
    pub restarts: usize,
    /// Number of steps that were requested.
    pub asked: usize,
}

impl Timing {
    /// Takes `count` steps of the packaged scene with these settings, or as many as `budget` allows. `tick` is called
    /// with the number of steps so far.
    ///
    /// # Errors
    /// If a setting or a step fails.
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

    /// The longest step by this measure.
    pub fn longest(&self, measure: fn(&Step) -> f64) -> Step {
        self.steps.iter().copied().max_by(|a, b| measure(a).total_cmp(&measure(b))).unwrap_or_default()
    }

    /// The measured times of all steps in ascending order.
    pub fn sorted(&self, measure: fn(&Step) -> f64) -> Vec<f64> {
        let mut numbers: Vec<f64> = self.steps.iter().map(measure).collect();
        numbers.sort_by(f64::total_cmp);
        numbers
    }

    /// [s] CPU time per evaluation, including events, outputs and interface.
    pub fn per_evaluation(&self) -> f64 {
        let sum = |measure: fn(&Step) -> f64| self.steps.iter().map(measure).sum::<f64>();
        sum(|step| step.cpu) / sum(|step| step.evaluations)
    }

    /// [s] CPU time of the longest step.
    pub fn worst(&self) -> f64 {
        self.longest(|step| step.cpu).cpu
    }

    /// The same steps with the shorter times of two runs. The motion is the same in both, to the bit; what the machine did
    /// beside it is not.
    #[must_use]
    pub fn shorter_of(mut self, again: &Self) -> Self {
        for (step, again) in self.steps.iter_mut().zip(&again.steps) {
            (step.wall, step.cpu) = (step.wall.min(again.wall), step.cpu.min(again.cpu));
        }
        self
    }

    /// [s] Time of the step with the most evaluations on an otherwise idle processor.
    pub fn bound(&self) -> f64 {
        self.longest(|step| step.evaluations).evaluations * self.per_evaluation()
    }
}

/// Quantile `share` of numbers in ascending order.
pub fn quantile(numbers: &[f64], share: f64) -> f64 {
    let place = (share * numbers.len() as f64).ceil() as usize;
    numbers.get(place.clamp(1, numbers.len().max(1)) - 1).copied().unwrap_or_default()
}

/// An FMU between two steps.
struct Bench<'a> {
    experiment: &'a Experiment,
    runner: Runner<'a>,
    asked: Selection,
    counts: [f64; 4],
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

    /// [rad] Angle of the crank.
    fn angle(&self) -> f64 {
        self.asked.values()[5]
    }

    fn step(&mut self) -> Result<Step> {
        self.point += 1;
        let (from, to) = self.experiment.interval(self.point)?.context("the run has reached its end")?;
        self.runner.apply_inputs(from, to)?;
        let (cpu, wall) = (ThreadTime::now(), Instant::now());
        self.runner.step(from, to)?;
        let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
        self.runner.ask(&mut self.asked)?;
        let after = counts(&self.asked);
        let [steps, evaluations, events, hits] = std::array::from_fn(|i| after[i] - self.counts[i]);
        self.counts = after;
        Ok(Step { end: to, wall, cpu, steps, evaluations, events, hits, error: self.asked.values()[4] })
    }
}

fn counts(asked: &Selection) -> [f64; 4] {
    [0, 1, 2, 3].map(|place| asked.values()[place])
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
            ..Step::default()
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
    fn what_interrupts_one_run_does_not_count() {
        let (mut once, mut again) = (timing(), timing());
        (once.steps[0].cpu, again.steps[1].cpu) = (9.0, 9.0);
        assert_eq!((once.worst(), again.worst()), (9.0, 9.0));
        assert_eq!(once.shorter_of(&again), timing());
        assert_eq!((timing().worst(), Timing::default().worst()), (3.0, 0.0));
    }

    #[test]
    fn the_bound_is_the_most_evaluations_at_their_mean_price() {
        let timing = timing();
        assert_eq!(timing.per_evaluation(), 7.0 / 700.0);
        assert_eq!(timing.bound(), 200.0 * 7.0 / 700.0);
    }
}
