//! LuGre's bristles: they stick where a law of the sliding speed alone lets creep.

use super::scenes::inputs;
use slidercrank::model::signals::Outputs;
use slidercrank::scene::{DampingLaw, FrictionLaw, JointModel, Scene};
use slidercrank::simulation::Simulation;

/// [N] Along the guide, less than friction holds.
const LOAD: f64 = -3.0;

/// The crank stands upright, so that nothing but friction in the guide holds the slider.
fn resting(law: FrictionLaw) -> Scene {
    let mut scene = Scene::default();
    (scene.crank.angle_start, scene.gravity) = (std::f64::consts::FRAC_PI_2, 500.0);
    scene.crank.com.x = 0.0;
    let guide = &mut scene.joint.t;
    (guide.model, guide.clearance, guide.offset_start) = (JointModel::Clearance, 1e-4, -1e-4);
    (guide.contact.law, guide.contact.restitution) = (DampingLaw::HuntCrossley, 0.0);
    guide.contact.stiffness = 1e9;
    let friction = &mut guide.contact.friction;
    (friction.law, friction.coefficient, friction.static_coefficient) = (law, 0.1, 0.15);
    scene.solver.tolerance = 1e-7;
    scene
}

/// Under the load, at 0.3 s and 0.2 s later.
fn late(scene: &Scene) -> [Outputs; 2] {
    let mut simulation = Simulation::start(scene, inputs(0.0, LOAD)).expect("a scene whose loop closes");
    [0.3, 0.5].map(|t| {
        simulation.advance_to(t).expect("no trouble");
        simulation.outputs()
    })
}

#[test]
fn bristles_hold_what_ambrosio_s_ramp_lets_creep() {
    let [sooner, later] = late(&resting(FrictionLaw::Lugre));
    let moved = later.slider.x - sooner.slider.x;
    println!("lugre: {moved:.1e} m in 0.2 s at {:.1e} m/s, held by {} N", later.slider.v, later.joint_t.force[0]);
    assert!(moved.abs() < 1e-9 && later.slider.v.abs() < 1e-8, "it sticks: {moved:e} m, {:e} m/s", later.slider.v);
    // Friction balances the load; sticking, it is below what it would be when sliding.
    assert!((later.joint_t.force[0] + LOAD).abs() < 0.05 * LOAD.abs());
    assert!(later.joint_t.force[0] < 0.1 * later.joint_t.force[1]);

    let [sooner, later] = late(&resting(FrictionLaw::Ambrosio));
    let moved = later.slider.x - sooner.slider.x;
    println!("ambrosio: {moved:.1e} m in 0.2 s at {:.1e} m/s", later.slider.v);
    // The ramp begins at 1 mm/s: so fast it creeps at least, 0.2 mm in 0.2 s.
    assert!(moved < -1.9e-4, "it creeps: {moved:e} m");
}

#[test]
fn a_load_beyond_static_friction_breaks_the_bristles_loose() {
    let scene = resting(FrictionLaw::Lugre);
    let mut simulation = Simulation::start(&scene, inputs(0.0, -40.0)).expect("a scene whose loop closes");
    simulation.advance_to(0.02).expect("no trouble");
    assert!(simulation.outputs().slider.v < -0.5, "{}", simulation.outputs().slider.v);
}
