//! What an output depends on is what the description says: a parameter or input that is not on its list
//! does not move it.

use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::model_description::{self, rows::Role};
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::{DriveMode, FrictionLaw, JointModel, Point, Scene, Surface};
use slidercrank::simulation::Simulation;

/// Every joint with play and closed at the start, the rod elastic, the crank turning, energies told.
fn worn() -> Scene {
    let mut scene = Scene { gravity: 9.81, ..Scene::default() };
    (scene.crank.angle_start, scene.crank.speed_start, scene.crank.com.y) = (0.7, 200.0, 0.001);
    (scene.rod.com.y, scene.slider.com.y, scene.guide.offset) = (0.002, 0.003, 0.004);
    (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (2, 1);
    let joints = &mut scene.joint;
    for joint in [&mut joints.a, &mut joints.b, &mut joints.c] {
        joint.model = JointModel::Clearance;
        joint.eccentricity_start = Point { x: 4e-4, y: 3.1e-4 };
        joint.contact.friction.law = FrictionLaw::Tanh;
    }
    (joints.t.model, joints.t.offset_start) = (JointModel::Clearance, 5.1e-4);
    scene.energy.audit = true;
    scene
}

fn scenes() -> [Scene; 5] {
    let (mut faces, mut rigid, mut speed, mut ideal) = (worn(), worn(), worn(), worn());
    faces.joint.t.surface = Surface::Foundation;
    (rigid.rod.flexible.bending_modes, rigid.rod.flexible.axial_modes) = (0, 0);
    speed.drive.mode = DriveMode::Speed;
    let joints = &mut ideal.joint;
    let models = [&mut joints.a.model, &mut joints.b.model, &mut joints.c.model, &mut joints.t.model];
    models.into_iter().for_each(|model| *model = JointModel::Ideal);
    [worn(), faces, rigid, speed, ideal]
}

/// The scene with another value of one parameter, if there is a legal one.
fn changed(scene: &Scene, parameter: &Parameter) -> Option<Scene> {
    let value = parameter.value(scene);
    let others = match parameter.kind {
        Kind::Real { .. } if value == 0.0 => vec![1e-5, 1.0],
        Kind::Real { .. } => vec![1.01 * value, 0.99 * value],
        Kind::Integer { .. } => vec![value + 1.0],
        Kind::Boolean { .. } => vec![1.0 - value],
        Kind::Enumeration { items, .. } => items.iter().map(|(_, item)| f64::from(*item)).collect(),
    };
    others.into_iter().filter(|other| *other != value).find_map(|other| {
        let mut scene = scene.clone();
        parameter.write(&mut scene, other).ok()?;
        scene.check().is_ok().then_some(scene)
    })
}

fn at_start(scene: &Scene, inputs: Inputs) -> Vec<f64> {
    let outputs: Outputs = Simulation::start(scene, inputs).expect("a start").outputs();
    let value = |access: &Access| match access {
        Access::RealOutput(get) => get(&outputs),
        Access::IntegerOutput(get) => f64::from(get(&outputs)),
        Access::BooleanOutput(get) => f64::from(u8::from(get(&outputs))),
        _ => 0.0,
    };
    VARIABLES.iter().map(|variable| value(&variable.access)).collect()
}

#[test]
fn no_parameter_moves_an_output_that_does_not_name_it() {
    let declaration = model_description::load().expect("the declaration");
    let (mut moved, mut unnamed) = (0, vec![]);
    for scene in scenes() {
        scene.check().expect("a legal scene");
        let before = at_start(&scene, Inputs::default());
        for (index, variable) in VARIABLES.iter().enumerate() {
            let Access::Parameter(parameter) = variable.access else { continue };
            let Some(other) = changed(&scene, parameter) else { continue };
            for (output, (one, two)) in before.iter().zip(at_start(&other, Inputs::default())).enumerate() {
                let Role::Output { at_start: Some(named), .. } = &declaration.rows[output].role else { continue };
                // Round-off is no dependency: a penetration of 10 um is a difference of places of 0.1 m, known
                // to 1e-16/1e-5 of itself.
                if (one - two).abs() > 1e-9 * one.abs().max(two.abs()).max(1e-3) {
                    moved += 1;
                    if !named.contains(&index) {
                        unnamed.push(format!("{} by {}", VARIABLES[output].name, variable.name));
                    }
                }
            }
        }
    }
    assert_eq!(unnamed, Vec::<String>::new());
    assert!(moved > 200, "{moved} outputs moved: nothing was tried");
}

#[test]
fn no_input_moves_an_output_that_does_not_feel_it_at_once() {
    let declaration = model_description::load().expect("the declaration");
    let index = |name: &str| VARIABLES.iter().position(|variable| variable.name == name).expect("an input");
    let mut moved = 0;
    for scene in scenes() {
        let before = at_start(&scene, Inputs::default());
        for (input, inputs) in [
            (index("crank.torque"), Inputs { crank_torque: 10.0, slider_load: 0.0 }),
            (index("slider.load"), Inputs { crank_torque: 0.0, slider_load: 100.0 }),
        ] {
            for (output, (one, two)) in before.iter().zip(at_start(&scene, inputs)).enumerate() {
                let Role::Output { depends, .. } = &declaration.rows[output].role else { continue };
                if *one != two {
                    moved += 1;
                    assert!(depends.contains(&input), "{}", VARIABLES[output].name);
                }
            }
        }
    }
    assert!(moved > 30, "{moved} outputs moved: nothing was tried");
}
