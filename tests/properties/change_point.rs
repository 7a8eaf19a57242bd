//! Where the crank brings the rod across the guide, ideal joints leave open which way the slider goes on.

use super::scenes::{inputs, speed_driven, start};
use slidercrank::scene::{Method, Scene};
use std::f64::consts::FRAC_PI_2;

/// An ideal mechanism with a crank of 0.1 m that turns at about 10 rad/s.
fn mechanism(rod: f64, angle_start: f64) -> Scene {
    let mut scene = Scene::default();
    (scene.crank.length, scene.rod.length) = (0.1, rod);
    (scene.crank.angle_start, scene.crank.speed_start) = (angle_start, 10.0);
    scene.solver.step = 1e-5;
    scene
}

/// [rad] Where it ends, and why.
fn end(scene: &Scene) -> (f64, String) {
    let mut simulation = start(scene, inputs(0.2, 0.0));
    let error = simulation.advance_to(5.0).expect_err("no way on");
    let outputs = simulation.outputs();
    let sums = [outputs.slider.x, outputs.slider.v, outputs.slider.a, outputs.rod.speed, outputs.joint_c.force[0]];
    assert!(sums.iter().all(|sum| sum.is_finite()), "{outputs:?}");
    (outputs.crank.angle, error.to_string())
}

#[test]
fn equal_lengths_end_at_a_right_angle_wherever_the_steps_fall() {
    // The reach is touched there and not passed: it must be seen within a step, whose place is chance.
    for i in 0..100 {
        let scene = mechanism(0.1, -0.5 - 0.0137 * f64::from(i));
        for scene in [speed_driven(scene.clone()), scene] {
            let (angle, why) = end(&scene);
            assert!((angle.abs() - FRAC_PI_2).abs() < 1.1e-3, "from {}: {angle}", scene.crank.angle_start);
            assert!(why.contains("the rod stands across the guide"), "{why}");
        }
    }
}

#[test]
fn a_short_rod_ends_at_its_reach_under_every_method_rigid_or_elastic() {
    for &method in Method::ALL {
        for (modes, audit) in [(0, false), (0, true), (1, false)] {
            for speed in [false, true] {
                let mut scene = mechanism(0.08, 0.3);
                (scene.solver.method, scene.energy.audit) = (method, audit);
                scene.rod.flexible.bending_modes = modes;
                if speed {
                    scene = speed_driven(scene);
                }
                if method == Method::Moreau && (modes > 0 || audit) {
                    continue;
                }
                let (angle, why) = end(&scene);
                let reach = 0.8_f64.asin();
                // A method that locates nothing stops a step of 1e-4 rad early or late.
                assert!((angle - reach).abs() < 1.1e-4, "{method:?}, {modes} modes: {angle}, reach {reach}");
                assert!(why.contains("the rod stands across the guide"), "{method:?}, {modes} modes: {why}");
            }
        }
    }
}

#[test]
fn steps_of_a_tenth_of_a_radian_do_not_jump_across_the_change_point() {
    // The rod cannot follow within 2.6° at most; a step is 8.6° long.
    for rod in [0.1, 0.0999] {
        for step in [1.5e-3, 1e-4] {
            for scene in [speed_driven(mechanism(rod, 0.2)), mechanism(rod, 0.2)] {
                let mut scene = scene;
                (scene.solver.method, scene.solver.step) = (Method::Moreau, step);
                (scene.crank.speed_start, scene.gravity) = (100.0, 0.0);
                let (angle, why) = end(&scene);
                let reach = (rod / 0.1).asin();
                assert!((angle - reach).abs() < 0.16, "{rod}, {step}: {angle}, reach {reach}");
                assert!(why.contains("the rod stands across the guide"), "{rod}, {step}, {angle}: {why}");
            }
        }
    }
}

#[test]
fn a_rod_that_is_longer_by_a_millionth_goes_round() {
    for scene in [mechanism(0.1 * (1.0 + 1e-6), 0.0), speed_driven(mechanism(0.1 * (1.0 + 1e-6), 0.0))] {
        let mut simulation = start(&scene, inputs(0.0, 0.0));
        simulation.advance_to(3.0).expect("a way on");
        let angle = simulation.outputs().crank.angle;
        assert!(angle > 4.0 * FRAC_PI_2, "{angle}");
    }
}
