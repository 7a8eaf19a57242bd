//! States and their names.

use slidercrank::integrator::Ode;
use slidercrank::model::Model;
use slidercrank::model::audit::STATES;
use slidercrank::model::coordinates::{Role, state_variables};
use slidercrank::scene::{DriveMode, FrictionLaw, JointModel, Scene, Surface};
use std::collections::HashSet;

/// Every mechanism, with what else has states.
fn scenes() -> Vec<Scene> {
    let model = |clearance: bool| if clearance { JointModel::Clearance } else { JointModel::Ideal };
    let mut all = vec![];
    for bits in 0..64 {
        let has = |bit: u32| bits >> bit & 1 == 1;
        let mut scene = Scene::default();
        let joint = &mut scene.joint;
        (joint.a.model, joint.b.model) = (model(has(0)), model(has(1)));
        (joint.c.model, joint.t.model) = (model(has(2)), model(has(3)));
        if has(4) {
            scene.drive.mode = DriveMode::Speed;
            (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (2, 1);
            scene.joint.t.surface = Surface::Foundation;
        }
        if has(5) {
            let joint = &mut scene.joint;
            joint.a.contact.friction.law = FrictionLaw::Lugre;
            joint.t.contact.friction.law = FrictionLaw::Lugre;
        }
        all.push(scene);
    }
    all
}

#[test]
fn there_is_one_name_for_each_state_and_no_name_twice() {
    for scene in scenes() {
        let variables = state_variables(&scene);
        let layout = Model::assemble(&scene).layout();
        assert_eq!(variables.len(), layout.states);
        assert_eq!(variables.iter().map(|state| &state.name).collect::<HashSet<_>>().len(), layout.states);
        let positions = variables.iter().filter(|state| matches!(state.role, Role::Position(_))).count();
        assert_eq!(positions, layout.positions);
        let mut with_audit = scene.clone();
        with_audit.energy.audit = true;
        assert_eq!(state_variables(&with_audit).len(), layout.states + STATES);
    }
}
