//! One scene through an FMU, communication point by communication point.

mod march;
mod runner;

pub use march::{Ending, Look, March, Repeats, march};
pub use runner::Runner;

use crate::host::{Fmu, Log, LogLine, Setting};
use crate::inputs::Input;
use crate::trajectory::Trajectory;
use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The output that counts turns.
pub const ANGLE: &str = "crank.angle";
/// More communication points than this are taken for a mistake.
const MOST_POINTS: usize = 20_000_000;

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// [s]
    Time(f64),
    /// As soon as the crank has turned so often, in either direction; but no later than `latest` [s].
    Turns {
        /// How often.
        turns: f64,
        /// [s]
        latest: f64,
    },
}

/// What to do with an FMU.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Values to set before initialisation.
    pub settings: Vec<Setting>,
    /// Inputs while time runs.
    pub inputs: Vec<Input>,
    /// [s] First communication point.
    pub start: f64,
    /// When to end.
    pub until: Until,
    /// [s] Between communication points.
    pub step: f64,
    /// Handed to fmi2SetupExperiment.
    pub tolerance: Option<f64>,
}

/// What came of it.
pub struct Recording {
    /// All outputs at all communication points.
    pub trajectory: Trajectory,
    /// Names and values of the parameters as they were in the run.
    pub parameters: Vec<(String, f64)>,
    /// What it cost.
    pub cost: Cost,
}

impl Recording {
    /// The output of this name at all communication points.
    pub fn column(&self, name: &str) -> Result<&[f64]> {
        self.trajectory.column(name)
    }

    /// The parameter's value in the run.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
    }
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// [s] Time simulated.
    pub simulated: f64,
    /// In fmi2DoStep, by the clock on the wall.
    pub stepping: Duration,
    /// All communication points with inputs and outputs, by the clock on the wall.
    pub wall: Duration,
    /// The same, by this thread's use of the processor.
    pub cpu: Duration,
}

/// Runs the experiment and tells `progress` now and then which share of it is done. The FMU is asked to say why it
/// refuses something.
pub fn run(
    fmu: &Fmu,
    experiment: &Experiment,
    log: impl Fn(&LogLine) + Send + Sync + 'static,
    progress: impl Fn(f64),
) -> Result<Recording> {
    ensure!(experiment.step > 0.0, "the communication step is {} s, wanted more than 0", experiment.step);
    let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(log)), true)?;
    let (wall, cpu) = (Instant::now(), ThreadTime::now());
    let mut stepping = Duration::ZERO;
    for point in 1..=MOST_POINTS {
        let Some((from, to)) = experiment.interval(point) else { break };
        runner.apply_inputs(from)?;
        let before = Instant::now();
        runner.step(from, to)?;
        stepping += before.elapsed();
        runner.record(to)?;
        let share = runner.share_done(to)?;
        if point % 256 == 0 {
            progress(share);
        }
        if share >= 1.0 {
            break;
        }
        ensure!(point < MOST_POINTS, "{MOST_POINTS} communication points were not enough");
    }
    let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
    progress(1.0);
    let parameters = runner.parameters(fmu)?;
    let trajectory = runner.finish()?;
    let simulated = trajectory.times().last().unwrap_or(&experiment.start) - experiment.start;
    Ok(Recording { trajectory, parameters, cost: Cost { simulated, stepping, wall, cpu } })
}

impl Experiment {
    /// The interval that ends at communication point number `point`, or `None` past the end. Points lie at whole
    /// multiples of the step, so that no error adds up; the last interval is shortened to end in time.
    pub fn interval(&self, point: usize) -> Option<(f64, f64)> {
        let (Until::Time(end) | Until::Turns { latest: end, .. }) = self.until;
        let at = |point: usize| self.start + point as f64 * self.step;
        let (from, to) = (at(point - 1), at(point));
        // A millionth of a step is what remains of a quotient that was meant to be whole.
        let sliver = 1e-6 * self.step;
        (from < end - sliver).then_some((from, if to > end - sliver { end } else { to }))
    }
}
