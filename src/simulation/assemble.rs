//! Selects the mechanism and the method of a scene.

use super::motion::Motion;
use super::run::Run;
use super::time_stepping::TimeStepping;
use crate::model::Model;
use crate::model::audit::Audited;
use crate::model::drive::InputSignal;
use crate::model::mechanism_model::MechanismModel;
use crate::model::start::StartPose;
use crate::scene::{Method, Scene};

/// Starts the mechanism of `scene` from `pose` at time 0 under `inputs`, with an energy audit if the scene requests it.
///
/// Integrators are compiled once and call the mechanism through a table of functions. Only the loop over the stages of
/// a step is compiled together with some mechanisms; see [`Ode::stages`](crate::integrator::Ode::stages).
pub fn start(scene: &Scene, pose: &StartPose, inputs: InputSignal) -> Box<dyn Motion> {
    let model = model(scene);
    match scene.solver.method {
        Method::Moreau => Box::new(TimeStepping::start(scene, pose, inputs, model)),
        _ => Box::new(Run::start(scene, pose, inputs, model)),
    }
}

/// The equations of the mechanism of `scene`, with an audit where the scene asks for one.
pub fn model(scene: &Scene) -> Box<dyn MechanismModel> {
    let model: Box<dyn MechanismModel> = Box::new(Model::assemble(scene));
    if scene.energy.audit { Box::new(Audited::new(scene, model)) } else { model }
}
