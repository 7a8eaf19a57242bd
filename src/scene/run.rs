//! Duration and output step of a run, for a harness.

use super::data::Scene;
use super::parameter::{DEFAULT_STEP, DEFAULT_STOP};
use std::f64::consts::TAU;

/// Duration and output step of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// End of the run.
    pub end: End,
    /// [s] Communication and output step.
    pub step: f64,
}

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// After this number of turns of the crank at its start speed.
    Turns(f64),
    /// [s] At this time.
    Time(f64),
}

impl Default for Run {
    fn default() -> Self {
        Self { end: End::Time(DEFAULT_STOP), step: DEFAULT_STEP }
    }
}

impl Run {
    /// [s] Time of the end. `read` rejects turns of a crank that starts at rest.
    pub fn stop(&self, scene: &Scene) -> f64 {
        match self.end {
            End::Turns(turns) => turns * TAU / scene.crank.speed_start.abs(),
            End::Time(time) => time,
        }
    }
}
