//! The cost of every effect, measured with a series of scenes, each with one effect more than the scene before.
//!
//! Work and time come from the packaged FMU, stepped through its C interface. The number of equations and the time of
//! an evaluation alone, which an FMU does not provide, come from the same sources in this program.

use crate::host::Fmu;
use crate::inputs;
use crate::run::{Ending, Experiment, March, Repeats, Until};
use anyhow::{Context, Result, ensure};
use cpu_time::ThreadTime;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::read::SceneFile;
use slidercrank::simulation::variation::{Seed, Variation};
use slidercrank::simulation::{Simulation, Size};
use std::time::Duration;

/// Number of runs of a scene. The fastest run counts.
const REPEATS: Repeats = Repeats { least: 3, enough: Duration::from_millis(200), most: 200 };
/// Number of states of a run at which the right-hand side is evaluated.
const STATES: usize = 400;
/// Number of evaluations at each state in one measurement.
const EVALUATIONS: usize = 128;
/// Number of measurements at each state. The shortest one counts.
const MEASUREMENTS: usize = 5;

/// The cost of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Price {
    /// The scene.
    pub scene: String,
    /// Size of its equations of motion.
    pub size: Size,
    /// [s] Time of one evaluation of the right-hand side alone, mean over the evaluations of the run.
    pub evaluation: f64,
    /// Evaluations per simulated second.
    pub evaluations: f64,
    /// Steps per simulated second.
    pub steps: f64,
    /// Events per simulated second.
    pub events: f64,
    /// [s/s] CPU time in fmi2DoStep per simulated second.
    pub time: f64,
}

impl Price {
    /// [s] CPU time in fmi2DoStep per evaluation. It includes integration, events and interface.
    pub fn all_in(&self) -> f64 {
        self.time / self.evaluations
    }

    /// Measures the cost of the scene, packaged as `fmu`, over its first `span` [s].
    pub fn of(file: &SceneFile, fmu: &Fmu, span: f64) -> Result<Self> {
        let experiment = Experiment {
            settings: vec![],
            inputs: inputs::of_scene(&file.inputs),
            start: 0.0,
            until: Until::Time(span),
            step: file.run.step,
            tolerance: None,
        };
        let March { trajectory, spent, ending, .. } = REPEATS.fastest(fmu, &experiment, Duration::MAX)?;
        ensure!(ending == Ending::Reached, "the run ended early: {ending:?}");
        let count = |name: &str| -> Result<f64> {
            let column = trajectory.column(&format!("solver.{name}"))?;
            Ok(column.last().context("the run has no rows")? / span)
        };
        let (evaluations, steps, events) = (count("evaluations")?, count("steps")?, count("events")?);
        let simulation = Simulation::start(&file.scene, Inputs::at_start(file))?;
        let size = simulation.size();
        let evaluation = evaluation(simulation, span)?;
        let time = spent.as_secs_f64() / span;
        Ok(Self { scene: file.name.clone(), size, evaluation, evaluations, steps, events, time })
    }
}

/// The cost of a scene's tangent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TangentPrice {
    /// The scene.
    pub scene: String,
    /// Number of directions.
    pub directions: usize,
    /// CPU time with the tangent over that of the same run without.
    pub ratio: f64,
}

impl TangentPrice {
    /// Measures the cost of the tangent along one state, along four and along all, over the first `span` [s]; the fastest
    /// of `runs` runs counts.
    ///
    /// # Errors
    /// If the scene cannot run.
    pub fn of(file: &SceneFile, span: f64, runs: usize) -> Result<Vec<Self>> {
        let inputs = Inputs::at_start(file);
        let states = Simulation::start(&file.scene, inputs)?.phase_scales().states.len();
        let mut plain = || -> Result<()> { Ok(Simulation::start(&file.scene, inputs)?.advance_to(span)?) };
        let alone = least(runs, &mut plain)?;
        let mut counts = vec![1, 4.min(states), states];
        counts.dedup();
        let price = |directions: usize| {
            let seeds: Vec<Seed> = (0..directions).map(Seed::State).collect();
            let time = least(runs, &mut || Ok(Variation::start(&file.scene, inputs, &seeds)?.advance_to(span)?))?;
            Ok(Self { scene: file.name.clone(), directions, ratio: time / alone })
        };
        counts.into_iter().map(price).collect()
    }
}

/// [s] CPU time of the fastest of `runs` runs of `work`.
fn least(runs: usize, work: &mut impl FnMut() -> Result<()>) -> Result<f64> {
    let mut failure = None;
    let time = fastest(runs, || failure = work().err());
    failure.map_or(Ok(time), Err)
}

/// [s] Time of one evaluation of the right-hand side alone, at states of the first `span` [s] of a run. The weight of
/// each state is the number of the run's evaluations near it.
pub fn evaluation(mut simulation: Simulation, span: f64) -> Result<f64> {
    let (mut spent, mut done) = (0.0, 0);
    for state in 1..=STATES {
        simulation.advance_to(span * state as f64 / STATES as f64)?;
        let before = std::mem::replace(&mut done, simulation.outputs().solver.evaluations);
        let least = fastest(MEASUREMENTS, || simulation.evaluate(EVALUATIONS)) / EVALUATIONS as f64;
        spent += f64::from(done - before) * least;
    }
    Ok(spent / f64::from(done))
}

/// [s] CPU time of the fastest of `runs` runs of `work`.
pub fn fastest(runs: usize, mut work: impl FnMut()) -> f64 {
    let measure = |_| {
        let start = ThreadTime::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..runs).map(measure).fold(f64::INFINITY, f64::min)
}
