//! The flexible rod against the beam's closed forms.

use super::scenes::inputs;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::{DriveMode, JointModel, Scene};
use slidercrank::simulation::Simulation;
use std::f64::consts::PI;

/// The crank held at dead centre, the rod lying between crank pin and slider.
fn held(bending_modes: i32, axial_modes: i32) -> Scene {
    let mut scene = Scene::default();
    (scene.drive.mode, scene.gravity, scene.solver.tolerance) = (DriveMode::Speed, 9.81, 1e-10);
    let rod = &mut scene.rod.flexible;
    (rod.bending_modes, rod.axial_modes, rod.damping_ratio) = (bending_modes, axial_modes, 0.0);
    scene
}

/// [N·m²], [kg/m], [m]
fn beam(scene: &Scene) -> (f64, f64, f64) {
    let f = &scene.rod.flexible;
    (f.young * f.second_moment, f.density * f.area, scene.rod.length)
}

/// [rad/s] (iπ/l)²·√(EI/ρA).
fn bending_frequency(scene: &Scene, mode: f64) -> f64 {
    let (stiffness, line, l) = beam(scene);
    (mode * PI / l).powi(2) * (stiffness / line).sqrt()
}

fn after(scene: &Scene, inputs: Inputs, time: f64) -> Outputs {
    let mut simulation = Simulation::start(scene, inputs).expect("a scene whose loop closes");
    simulation.advance_to(time).expect("no trouble");
    simulation.outputs()
}

/// [m] Of mid-span at rest: damped for 40 time constants.
fn sag(scene: &Scene, load: f64) -> f64 {
    let mut scene = scene.clone();
    scene.rod.flexible.damping_ratio = 0.7;
    after(&scene, inputs(0.0, load), 60.0 / bending_frequency(&scene, 1.0)).rod.deflection
}

#[test]
fn gravity_makes_a_mode_swing_about_its_sag_at_its_frequency() {
    let mut scene = held(1, 0);
    scene.gravity = 1.0; // small enough for the swing to be linear
    let (stiffness, line, l) = beam(&scene);
    let still = -4.0 * line * scene.gravity * l.powi(4) / (PI.powi(5) * stiffness);
    let period = 2.0 * PI / bending_frequency(&scene, 1.0);
    for share in [0.25, 0.5, 0.8, 3.1, 10.0] {
        let found = after(&scene, Inputs::default(), share * period).rod.deflection;
        let wanted = still * (1.0 - (2.0 * PI * share).cos());
        assert!((found - wanted).abs() < 1e-7 * still.abs(), "after {share} periods {found}, not {wanted}");
    }
}

#[test]
fn a_static_load_gives_the_beam_s_deflection() {
    let (stiffness, line, l) = beam(&held(1, 0));
    let textbook = -5.0 * line * 9.81 * l.powi(4) / (384.0 * stiffness);
    let error = |modes| (sag(&held(modes, 0), 0.0) / textbook - 1.0).abs();
    let (one, three, five) = (error(1), error(3), error(5));
    println!("of 5·ρA·g·l⁴/(384·EI): {one:.1e}, {three:.1e}, {five:.1e} off with 1, 3, 5 modes");
    // The series alternates as 1/i⁵ over odd i.
    assert!((one - 3.9e-3).abs() < 2e-4 && three < 3e-4 && five < 6e-5, "{one:e}, {three:e}, {five:e}");
}

#[test]
fn an_axial_load_stretches_the_rod_as_a_bar() {
    let mut scene = held(0, 8);
    scene.rod.flexible.damping_ratio = 0.7;
    let f = &scene.rod.flexible;
    let slowest = PI / (2.0 * scene.rod.length) * (f.young / f.density).sqrt();
    let load = 2e4;
    let found = after(&scene, inputs(0.0, load), 60.0 / slowest).rod.stretch;
    let bar = load * scene.rod.length / (f.young * f.area);
    // Modes converge as Σ 8/(π²(2j − 1)²): eight of them carry all but 1/(4·8) of 8/π².
    let carried: f64 = (1..=8).map(|j| 8.0 / (PI * (2.0 * f64::from(j) - 1.0)).powi(2)).sum();
    assert!((found / (bar * carried) - 1.0).abs() < 1e-6, "{found} is not {}", bar * carried);
}

#[test]
fn euler_s_buckling_load_appears_with_geometric_stiffness_and_only_with_it() {
    let mut scene = held(1, 0);
    scene.gravity = 1.0;
    let (stiffness, _, l) = beam(&scene);
    let critical = (PI / l).powi(2) * stiffness;
    let unloaded = sag(&scene, 0.0);
    for share in [-1.0, 0.3, 0.6] {
        // The sag of a mode grows by 1/(1 − F/F_critical); the load pushes the slider towards the crank.
        let growth = sag(&scene, -share * critical) / unloaded;
        let wanted = 1.0 / (1.0 - share);
        assert!((growth / wanted - 1.0).abs() < 1e-5, "at {share} of Euler's load the sag grows by {growth}");
    }
    // Above it the sag grows with exp(0.13·ωt), while gravity alone is at rest.
    let buckling = sag(&scene, -1.2 * critical) / unloaded;
    assert!(buckling > 1e3, "above Euler's load the rod stands: the sag grows by {buckling}");
    scene.rod.flexible.geometric_stiffness = false;
    let straight = sag(&scene, -1.2 * critical);
    assert!((straight / unloaded - 1.0).abs() < 1e-9, "without foreshortening no load bends: {straight}");
}

#[test]
fn a_rod_tends_to_the_rigid_one_as_its_modulus_grows() {
    let flexible = |young: f64| {
        let mut scene = held(2, 1);
        scene.joint.c.model = JointModel::Clearance;
        (scene.crank.speed_start, scene.crank.angle_start) = (100.0, 0.4);
        (scene.rod.flexible.young, scene.rod.flexible.damping_ratio) = (young, 0.7);
        scene
    };
    let mut rigid = flexible(2e11);
    let f = &rigid.rod.flexible;
    (rigid.rod.mass, rigid.rod.com.x) = (f.density * f.area * rigid.rod.length, 0.5 * rigid.rod.length);
    rigid.rod.inertia = rigid.rod.mass * rigid.rod.length * rigid.rod.length / 12.0;
    (rigid.rod.flexible.bending_modes, rigid.rod.flexible.axial_modes) = (0, 0);
    // Free flight of the pin: nothing but the rod's inertia acts.
    let place = |scene: &Scene| after(scene, Inputs::default(), 1.5e-3);
    let wanted = place(&rigid);
    assert!(!wanted.joint_c.contact && wanted.joint_c.eccentricity[1].abs() > 1e-6);
    let error = |young: f64| {
        let found = place(&flexible(young));
        (found.joint_c.eccentricity[0] - wanted.joint_c.eccentricity[0])
            .hypot(found.joint_c.eccentricity[1] - wanted.joint_c.eccentricity[1])
    };
    let errors = [2e11, 2e12, 2e13].map(error);
    println!("eccentricity off the rigid rod's by {errors:?} m");
    assert!(errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1] && errors[2] < 1e-6, "{errors:?}");
}
