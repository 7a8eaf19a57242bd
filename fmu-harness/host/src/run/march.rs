//! Runs that end early without an error: results, cost, and the reason of the end.

use super::{Experiment, Runner, Until};
use crate::host::{Fmu, Log};
use crate::trajectory::Trajectory;
use anyhow::{Result, bail};
use cpu_time::ThreadTime;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The communication points of a run that are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// The first and the last point.
    AtEnds,
    /// All points.
    Everywhere,
}

/// The reason why a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It reached its end time.
    Reached,
    /// It took longer than its budget.
    Stopped,
    /// The FMU could not go on, or there are too many communication points; with the message.
    Failed(String),
}

impl Ending {
    /// Returns an error if the run did not reach its end within `budget`.
    ///
    /// # Errors
    /// With the reason.
    pub fn complete(self, budget: Duration) -> Result<()> {
        match self {
            Self::Reached => Ok(()),
            Self::Stopped => bail!("stopped after {} s", budget.as_secs_f64()),
            Self::Failed(why) => bail!(why),
        }
    }
}

/// The results of a run.
pub struct March {
    /// The recorded outputs, up to the last communication point that was reached.
    pub trajectory: Trajectory,
    /// [s] Simulated time.
    pub simulated: f64,
    /// CPU time of this thread in steps and inputs, and in reading outputs if all points are recorded.
    pub spent: Duration,
    /// Why it ended.
    pub ending: Ending,
}

/// Number of steps between two checks of the budget.
const UNWATCHED: usize = 8;

/// Runs the experiment for at most about `budget`. Turns are counted only if all points are recorded.
///
/// # Errors
/// If the run cannot start. What happens later is reported as its ending.
pub fn march(fmu: &Fmu, experiment: &Experiment, look: Look, budget: Duration) -> Result<March> {
    experiment.afford()?;
    let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(|_| {})), true)?;
    let mut reached = experiment.start;
    let mut ending = Ending::Reached;
    let (clock, start) = (Instant::now(), ThreadTime::now());
    for point in 1.. {
        let (from, to) = match experiment.interval(point) {
            Ok(Some(interval)) => interval,
            Ok(None) => break,
            Err(error) => {
                ending = Ending::Failed(error.to_string());
                break;
            }
        };
        let stepped = runner.apply_inputs(from, to).and_then(|()| runner.step(from, to));
        if let Err(error) = stepped {
            ending = Ending::Failed(error.to_string());
            break;
        }
        reached = to;
        if look == Look::Everywhere {
            runner.record(to)?;
            if matches!(experiment.until, Until::Turns { .. }) && runner.share_done(to)? >= 1.0 {
                break;
            }
        }
        if budget < Duration::MAX && point % UNWATCHED == 0 && clock.elapsed() > budget {
            ending = Ending::Stopped;
            break;
        }
    }
    let spent = start.elapsed();
    if look == Look::AtEnds {
        runner.record(reached)?;
    }
    Ok(March { trajectory: runner.into_trajectory(), simulated: reached - experiment.start, spent, ending })
}

/// Number of repetitions of a run. The fastest one counts, since other programs can only slow a run down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// Minimum number of repetitions.
    pub least: usize,
    /// Repetitions continue until they have taken this long together.
    pub enough: Duration,
    /// Maximum number of repetitions.
    pub most: usize,
}

impl Repeats {
    /// The fastest run of the experiment. A run that does not reach its end within `budget` is not repeated.
    pub fn fastest(&self, fmu: &Fmu, experiment: &Experiment, budget: Duration) -> Result<March> {
        let mut fastest = march(fmu, experiment, Look::AtEnds, budget)?;
        let mut total = fastest.spent;
        for run in 1..self.most {
            if fastest.ending != Ending::Reached || (run >= self.least && total >= self.enough) {
                break;
            }
            let next = march(fmu, experiment, Look::AtEnds, budget)?;
            total += next.spent;
            if next.ending == Ending::Reached && next.spent < fastest.spent {
                fastest = next;
            }
        }
        Ok(fastest)
    }
}
