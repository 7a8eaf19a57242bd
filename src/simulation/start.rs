//! Sets the mechanism of a scene to its start pose.

use super::assemble;
use super::error::SimulationError;
use super::motion::Motion;
use crate::model::drive::InputSignal;
use crate::model::signals::Inputs;
use crate::model::start::StartPose;
use crate::scene::Scene;

/// The mechanism of `scene` in its start pose at time 0, under constant `inputs`.
///
/// # Errors
/// `Scene` if the loop does not close in the start pose.
pub fn start(scene: &Scene, inputs: Inputs) -> Result<Box<dyn Motion>, SimulationError> {
    let pose = pose(scene)?;
    let signal = InputSignal { at: 0.0, value: inputs, rate: Inputs::default() };
    Ok(assemble::start(scene, &pose, signal))
}

/// Where the scene's mechanism starts.
///
/// # Errors
/// `Scene` if the start position does not close the loop.
pub fn pose(scene: &Scene) -> Result<StartPose, SimulationError> {
    StartPose::of(scene).ok_or_else(|| {
        SimulationError::Scene("crank.angle_start: the rod is too short to close the loop at the start".into())
    })
}
