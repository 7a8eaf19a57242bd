//! How long a scene runs and how often it is looked at: what a harness does with it.

use super::data::Scene;
use super::parameter::{DEFAULT_STEP, DEFAULT_STOP};
use std::f64::consts::TAU;

/// Length and output step of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// When it is over.
    pub end: End,
    /// [s] Communication and output step.
    pub step: f64,
}

/// When a run is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// After as many turns of a crank that keeps its start speed.
    Turns(f64),
    /// [s] At a time.
    Time(f64),
}

impl Default for Run {
    fn default() -> Self {
        Self { end: End::Time(DEFAULT_STOP), step: DEFAULT_STEP }
    }
}

impl Run {
    /// [s] When it is over. Turns of a crank at rest never end: `read` refuses them.
    pub fn stop(&self, scene: &Scene) -> f64 {
        match self.end {
            End::Turns(turns) => turns * TAU / scene.crank.speed_start.abs(),
            End::Time(time) => time,
        }
    }
}
