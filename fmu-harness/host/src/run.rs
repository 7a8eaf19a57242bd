//! Runs an FMU from communication point to communication point and records its outputs.

mod march;
mod runner;

pub use march::{Ending, Look, March, Repeats, march};
pub use runner::Runner;

use crate::host::{Fmu, Log, LogLine, Setting};
use crate::inputs::Input;
use crate::trajectory::Trajectory;
use anyhow::{Result, ensure};
use cpu_time::ThreadTime;
use slidercrank::scene::JointModel;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The output that counts turns.
pub const ANGLE: &str = "crank.angle";
/// The output at whose rate the angle moves on.
pub const SPEED: &str = "crank.speed";
/// The joints.
pub const JOINTS: [&str; 4] = ["A", "B", "C", "T"];
/// A run with more communication points than this counts as a mistake.
const MOST_POINTS: usize = 20_000_000;
/// A remainder of a millionth of a step is the rounding error of an integer quotient.
const SLIVER: f64 = 1e-6;

/// The end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// [s]
    Time(f64),
    /// The run ends when the crank is so many turns away from its start angle, in either direction, but not later than
    /// `latest` [s].
    Turns {
        /// Number of turns.
        turns: f64,
        /// [s]
        latest: f64,
    },
}

/// An experiment with an FMU.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Values to set before initialization.
    pub settings: Vec<Setting>,
    /// Inputs during the run.
    pub inputs: Vec<Input>,
    /// [s] First communication point.
    pub start: f64,
    /// End of the run.
    pub until: Until,
    /// [s] Communication step.
    pub step: f64,
    /// Relative tolerance for fmi2SetupExperiment.
    pub tolerance: Option<f64>,
}

/// Settings that make all joints ideal.
pub fn ideal_joints() -> impl Iterator<Item = Setting> {
    JOINTS.into_iter().map(|joint| Setting::joint(joint, "model", JointModel::Ideal.name()))
}

/// The results of a run.
pub struct Recording {
    /// All outputs at all communication points.
    pub trajectory: Trajectory,
    /// Names and values of the parameters during the run.
    pub parameters: Vec<(String, f64)>,
    /// Cost of the run.
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

/// The cost of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// [s] Simulated time.
    pub simulated: f64,
    /// Wall time in fmi2DoStep.
    pub stepping: Duration,
    /// Wall time of all communication points, with inputs and outputs.
    pub wall: Duration,
    /// CPU time of this thread for all communication points, with inputs and outputs.
    pub cpu: Duration,
}

/// Runs the experiment and reports the finished share to `progress` from time to time. The FMU's log is on, so that
/// refused calls come with a reason.
pub fn run(
    fmu: &Fmu,
    experiment: &Experiment,
    log: impl Fn(&LogLine) + Send + Sync + 'static,
    progress: impl Fn(f64),
) -> Result<Recording> {
    experiment.afford()?;
    let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(log)), true)?;
    let (wall, cpu) = (Instant::now(), ThreadTime::now());
    let mut stepping = Duration::ZERO;
    for point in 1.. {
        let Some((from, to)) = experiment.interval(point)? else { break };
        runner.apply_inputs(from, to)?;
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
    }
    let (wall, cpu) = (wall.elapsed(), cpu.elapsed());
    progress(1.0);
    let parameters = runner.parameters(fmu)?;
    let trajectory = runner.finish()?;
    let simulated = trajectory.times().last().unwrap_or(&experiment.start) - experiment.start;
    Ok(Recording { trajectory, parameters, cost: Cost { simulated, stepping, wall, cpu } })
}

impl Experiment {
    /// Refuses too many communication points, where the end is known beforehand.
    fn afford(&self) -> Result<()> {
        match self.until {
            Until::Time(end) => afford(end - self.start, self.step),
            // How long its turns take is known when they are made.
            Until::Turns { .. } => afford(0.0, self.step),
        }
    }

    /// The interval that ends at communication point number `point`, or `None` past the end. Points are integer
    /// multiples of the step, so that rounding errors do not add up. The last interval is shorter if the end requires
    /// it.
    ///
    /// # Errors
    /// If a run cannot have so many points.
    pub fn interval(&self, point: usize) -> Result<Option<(f64, f64)>> {
        let (Until::Time(end) | Until::Turns { latest: end, .. }) = self.until;
        let at = |point: usize| self.start + point as f64 * self.step;
        let (from, to) = (at(point - 1), at(point));
        let sliver = SLIVER * self.step;
        if from >= end - sliver {
            return Ok(None);
        }
        ensure!(point <= MOST_POINTS, too_many(self.step));
        Ok(Some((from, if to > end - sliver { end } else { to })))
    }
}

/// Refuses to run so many seconds with this communication step [s].
///
/// # Errors
/// If the step is not above 0, or there are too many communication points.
pub fn afford(span: f64, step: f64) -> Result<()> {
    ensure!(step > 0.0 && step.is_finite(), "the communication step is {step} s; it must be finite and above 0");
    ensure!(span <= (MOST_POINTS as f64 + SLIVER) * step, too_many(step));
    Ok(())
}

fn too_many(step: f64) -> String {
    format!("with a communication step of {step:e} s the run has more than {MOST_POINTS} communication points")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_has_no_more_communication_points_than_it_may() {
        for (points, enough) in [(MOST_POINTS, true), (MOST_POINTS + 1, false)] {
            let (start, step) = (0.5, 1e-5);
            let latest = start + points as f64 * step;
            let until = Until::Turns { turns: 1.0, latest };
            let experiment = Experiment { settings: vec![], inputs: vec![], start, until, step, tolerance: None };
            assert_eq!(
                experiment.interval(points).map(|found| found.map(|(_, to)| to)).ok(),
                enough.then_some(Some(latest))
            );
            assert_eq!(experiment.interval(points + 1).ok(), Some(None));
            assert_eq!(afford(latest - start, step).is_ok(), enough);
        }
        assert!([0.0, -1e-3, f64::NAN, f64::INFINITY].into_iter().all(|step| afford(1.0, step).is_err()));
    }
}
