//! What an importer can set: the scene, the experiment and the inputs.

use super::experiment::Experiment;
use super::inputs::InputLines;
use crate::scene::parameter::{PARAMETERS, Parameter};
use crate::scene::{Scene, SceneError};
use serde::{Deserialize, Serialize};

/// Everything that an importer has set, or left at its start value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The scene as edited by the importer.
    pub scene: Scene,
    /// Times and tolerance.
    pub experiment: Experiment,
    /// Inputs.
    pub inputs: InputLines,
}

impl Settings {
    /// Those of a slave of which nothing has been set yet.
    pub fn of(scene: Scene) -> Self {
        Self { scene, experiment: Experiment::default(), inputs: InputLines::default() }
    }

    /// Whether an importer can have set all of this.
    pub fn are_sound(&self) -> bool {
        let in_range = |parameter: &Parameter| parameter.admit(parameter.value(&self.scene)).is_ok();
        PARAMETERS.iter().all(in_range) && self.experiment.is_sound() && self.inputs.are_finite()
    }

    /// The scene to be simulated, if its parameters go together. The experiment's tolerance takes
    /// precedence over the scene's.
    pub fn simulated_scene(&self) -> Result<Scene, SceneError> {
        self.scene.check()?;
        let mut scene = self.scene.clone();
        if let Some(tolerance) = self.experiment.tolerance {
            scene.solver.tolerance = tolerance;
        }
        Ok(scene)
    }
}
