//! What an importer can set: the scene, the experiment and the inputs.

use super::experiment::Experiment;
use super::inputs::InputLines;
use crate::math::PORTABLE;
use crate::model::ideal::IdealMechanism;
use crate::model_description::number::number;
use crate::scene::parameter::{PARAMETERS, Parameter};
use crate::scene::{DriveMode, JointModel, Scene, SceneError};
use serde::{Deserialize, Serialize};

/// All values that an importer can set, or their start values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The scene as edited by the importer.
    pub scene: Scene,
    /// Times and tolerance.
    pub experiment: Experiment,
    /// Inputs.
    pub inputs: InputLines,
    /// Whether the importer has set the scene's tolerance. If so, it takes precedence over the experiment's tolerance,
    /// which many importers take from the model description by default.
    pub tolerance_set: bool,
}

impl Settings {
    /// The settings of a new slave.
    pub fn of(scene: Scene) -> Self {
        Self { scene, experiment: Experiment::default(), inputs: InputLines::default(), tolerance_set: false }
    }

    /// Whether an importer could have set all these values.
    pub fn are_sound(&self) -> bool {
        let in_range = |parameter: &Parameter| parameter.admit(parameter.value(&self.scene)).is_ok();
        PARAMETERS.iter().all(in_range) && self.experiment.is_sound() && self.inputs.are_finite()
    }

    /// The tolerance in use: the scene's if the importer has set it, else the experiment's if it has one, else that of
    /// the packaged scene.
    pub fn tolerance(&self) -> f64 {
        match self.experiment.tolerance {
            Some(tolerance) if !self.tolerance_set => tolerance,
            _ => self.scene.solver.tolerance,
        }
    }

    /// Refuses a run that is certain to end early: a crank with prescribed speed that must pass a position at which the
    /// rod is perpendicular to the guide, unless the experiment stops before. With a torque the crank may or may not
    /// get there.
    fn check_way(&self) -> Result<(), SceneError> {
        let Scene { drive, crank, rod, joint, .. } = &self.scene;
        let ideal = [joint.a.model, joint.b.model, joint.c.model, joint.t.model] == [JointModel::Ideal; 4];
        let rigid = rod.flexible.bending_modes == 0 && rod.flexible.axial_modes == 0;
        if drive.mode != DriveMode::Speed || !ideal || !rigid {
            return Ok(());
        }
        let mechanism = IdealMechanism::new(&self.scene);
        let Some(lasts) = mechanism.time_to_change_point(crank.angle_start, crank.speed_start) else {
            return Ok(());
        };
        let end = self.experiment.start + lasts;
        if self.experiment.stop.is_some_and(|stop| stop < end) {
            return Ok(());
        }
        let least = number(mechanism.crank + mechanism.height.abs());
        let allowed = format!(
            "above {least} m for the crank to turn; it brings the rod across the guide at t = {end:.6} s, \
             so that the run ends there, unless the experiment stops before"
        );
        Err(SceneError::Conflict { name: "rod.length".into(), value: rod.length, allowed })
    }

    /// The scene to simulate, with the tolerance in use. It is an error if its parameters contradict each other.
    pub fn simulated_scene(&self) -> Result<Scene, SceneError> {
        self.scene.check()?;
        if self.scene.solver.portable && !PORTABLE {
            let allowed = "false: this library is compiled for newer processors".into();
            return Err(SceneError::Conflict { name: "solver.portable".into(), value: 1.0, allowed });
        }
        self.check_way()?;
        let mut scene = self.scene.clone();
        scene.solver.tolerance = self.tolerance();
        Ok(scene)
    }
}
