//! A run without a word on the way: what it gave, what it cost, why it ended.

use super::{Experiment, MOST_POINTS, Runner, Until};
use crate::host::{Fmu, Log};
use crate::trajectory::Trajectory;
use anyhow::Result;
use cpu_time::ThreadTime;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Which communication points of a march are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// The first and the last one.
    AtEnds,
    /// All.
    Everywhere,
}

/// Why a march is over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Its time came.
    Reached,
    /// It took longer than it was given.
    Stopped,
    /// The FMU refused to go on; in its own words.
    Failed(String),
}

/// What came of a march.
pub struct March {
    /// What was recorded; up to the last communication point reached.
    pub trajectory: Trajectory,
    /// [s] Time simulated.
    pub simulated: f64,
    /// This thread's use of the processor in steps and inputs, and in looks if it looks everywhere.
    pub spent: Duration,
    /// Why it is over.
    pub ending: Ending,
}

/// Steps between two looks at the clock.
const UNWATCHED: usize = 8;

/// Runs the experiment without a word on the way and for at most about `budget`. Turns are counted where it looks
/// everywhere.
///
/// # Errors
/// If it cannot begin; whatever happens later is its ending.
pub fn march(fmu: &Fmu, experiment: &Experiment, look: Look, budget: Duration) -> Result<March> {
    let mut runner = Runner::start(fmu, experiment, Arc::new(Log::new(|_| {})), true)?;
    let mut reached = experiment.start;
    let mut ending = Ending::Reached;
    let (clock, start) = (Instant::now(), ThreadTime::now());
    for point in 1..=MOST_POINTS {
        let Some((from, to)) = experiment.interval(point) else { break };
        let stepped = runner.apply_inputs(from).and_then(|()| runner.step(from, to));
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

/// How often a run is repeated, of which the fastest counts: what other programs do to a run only makes it slower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// So often.
    pub least: usize,
    /// More often, until they have taken so long together.
    pub enough: Duration,
    /// But no more often.
    pub most: usize,
}

impl Repeats {
    /// The fastest run of the experiment; one that does not reach its end within `budget` is not repeated.
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
