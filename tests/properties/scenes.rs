//! Mechanisms that more than one property is asserted of.

use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{Contact, DampingLaw, DriveMode, FrictionLaw, JointModel, Revolute, Scene};
use slidercrank::simulation::Simulation;

/// Which of A, B, C, T have clearance.
pub type Play = [bool; 4];

/// All sixteen.
pub fn all_plays() -> impl Iterator<Item = Play> {
    (0..16).map(|bits| std::array::from_fn(|i| bits >> i & 1 == 1))
}

/// The letters of the joints with clearance.
pub fn letters(play: Play) -> String {
    let letters = ['A', 'B', 'C', 'T'].into_iter().zip(play);
    letters.map(|(letter, clear)| if clear { letter } else { '-' }).collect()
}

/// Gives clearance to the joints of `play`.
pub fn with_play(mut scene: Scene, play: Play) -> Scene {
    let model = play.map(|clear| if clear { JointModel::Clearance } else { JointModel::Ideal });
    [scene.joint.a.model, scene.joint.b.model, scene.joint.c.model, scene.joint.t.model] = model;
    scene
}

/// A mechanism without symmetry: offsets and centres of mass off every axis, gravity.
pub fn crooked() -> Scene {
    let mut scene = Scene { gravity: 9.81, ..Scene::default() };
    (scene.crank.angle_start, scene.crank.speed_start) = (0.4, 150.0);
    (scene.crank.com.x, scene.crank.com.y) = (0.011, -0.007);
    (scene.rod.com.x, scene.rod.com.y) = (0.047, 0.005);
    (scene.slider.com.x, scene.slider.com.y) = (0.006, 0.004);
    (scene.slider.centre.x, scene.slider.centre.y) = (-0.003, 0.002);
    scene.guide.offset = 0.015;
    scene
}

/// The three revolute joints.
pub fn revolutes(scene: &mut Scene) -> [&mut Revolute; 3] {
    let joint = &mut scene.joint;
    [&mut joint.a, &mut joint.b, &mut joint.c]
}

/// The contacts of all four joints.
pub fn contacts(scene: &mut Scene) -> [&mut Contact; 4] {
    let joint = &mut scene.joint;
    [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact]
}

/// Contacts that dissipate nothing.
pub fn elastic(mut scene: Scene) -> Scene {
    for contact in contacts(&mut scene) {
        contact.law = DampingLaw::Hertz;
        contact.friction.law = FrictionLaw::None;
    }
    scene
}

/// The crank's angle is prescribed.
pub fn speed_driven(mut scene: Scene) -> Scene {
    scene.drive.mode = DriveMode::Speed;
    scene
}

/// At this tolerance.
pub fn at_tolerance(mut scene: Scene, tolerance: f64) -> Scene {
    scene.solver.tolerance = tolerance;
    scene
}

/// Starts at time 0.
pub fn start(scene: &Scene, inputs: Inputs) -> Simulation {
    scene.check().expect("a legal scene");
    Simulation::start(scene, inputs).expect("a scene whose loop closes")
}

/// Outputs at `t`.
pub fn at(simulation: &mut Simulation, t: f64) -> Outputs {
    simulation.advance_to(t).expect("a motion without trouble");
    simulation.outputs()
}

/// A torque and a load.
pub fn inputs(crank_torque: f64, slider_load: f64) -> Inputs {
    Inputs { crank_torque, slider_load }
}

/// All real outputs with their names.
pub fn reals(o: &Outputs) -> Vec<(&'static str, f64)> {
    vec![
        ("slider.x", o.slider.x),
        ("slider.v", o.slider.v),
        ("slider.a", o.slider.a),
        ("slider.y", o.slider.y),
        ("slider.angle", o.slider.angle),
        ("crank.angle", o.crank.angle),
        ("crank.speed", o.crank.speed),
        ("crank.acceleration", o.crank.acceleration),
        ("rod.angle", o.rod.angle),
        ("rod.speed", o.rod.speed),
        ("joint.A.force.x", o.joint_a.force[0]),
        ("joint.A.force.y", o.joint_a.force[1]),
        ("joint.B.force.x", o.joint_b.force[0]),
        ("joint.B.force.y", o.joint_b.force[1]),
        ("joint.C.force.x", o.joint_c.force[0]),
        ("joint.C.force.y", o.joint_c.force[1]),
        ("joint.T.force.x", o.joint_t.force[0]),
        ("joint.T.force.y", o.joint_t.force[1]),
        ("joint.T.moment", o.joint_t.moment),
        ("joint.A.eccentricity.x", o.joint_a.eccentricity[0]),
        ("joint.A.eccentricity.y", o.joint_a.eccentricity[1]),
        ("joint.B.eccentricity.x", o.joint_b.eccentricity[0]),
        ("joint.B.eccentricity.y", o.joint_b.eccentricity[1]),
        ("joint.C.eccentricity.x", o.joint_c.eccentricity[0]),
        ("joint.C.eccentricity.y", o.joint_c.eccentricity[1]),
        ("joint.A.penetration", o.joint_a.penetration),
        ("joint.B.penetration", o.joint_b.penetration),
        ("joint.C.penetration", o.joint_c.penetration),
        ("joint.T.penetration", o.joint_t.penetration),
        ("drive.torque", o.drive_torque),
        ("accuracy.position", o.accuracy.position),
        ("accuracy.velocity", o.accuracy.velocity),
        ("accuracy.acceleration", o.accuracy.acceleration),
    ]
}

/// Largest difference of each real output over a run, relative to the largest value of that output in
/// the first run; the worst with its name.
pub fn worst_difference(runs: &[(Outputs, Outputs)]) -> (f64, &'static str) {
    let mut worst = (0.0, "none");
    let count = reals(&Outputs::default()).len();
    for i in 0..count {
        let (mut size, mut difference, mut name) = (0.0f64, 0.0f64, "");
        for (one, other) in runs {
            let (one, other) = (reals(one)[i], reals(other)[i]);
            name = one.0;
            size = size.max(one.1.abs());
            difference = difference.max((one.1 - other.1).abs());
        }
        if difference > worst.0 * size {
            worst = (if size > 0.0 { difference / size } else { f64::INFINITY }, name);
        }
    }
    worst
}
