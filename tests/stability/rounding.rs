//! Tolerances down to rounding. With micrometre clearances a tolerance of 1e-12 asks for less than the rounding of a
//! position. The error must fall with the tolerance to what rounding allows, and stay there; the steps must not shrink
//! as if rounding could be resolved.

use slidercrank::model::signals::Outputs;
use slidercrank::scene::read::read;
use slidercrank::scene::{Method, Scene};
use slidercrank::simulation::Simulation;
use std::f64::consts::PI;

/// [s] Length of a motion, and communication points in it.
const SPAN: f64 = 0.02;
const POINTS: u32 = 20;
/// Largest deviation of a force over its amplitude that rounding may cause.
const ROUNDING: f64 = 2e-6;

/// Clearances [m] of main bearing, crank pin, slider pin and guide.
const CLEARANCES: [[f64; 4]; 3] =
    [[5.7e-6, 1.1e-5, 1.9e-5, 1.1e-5], [1.4e-5, 1.0e-5, 1.3e-5, 8.8e-6], [4e-6, 60e-6, 9e-6, 25e-6]];

/// A slow mechanism in which all joints have little clearance.
fn slow(clearance: [f64; 4]) -> Scene {
    let text = include_str!("../../fmu-harness/scenes/allplay.toml");
    let mut scene = read(text, "allplay.toml").expect("a shipped scene").scene;
    scene.crank.speed_start = 120.0 * PI / 30.0;
    let joint = &mut scene.joint;
    [joint.a.clearance, joint.b.clearance, joint.c.clearance, joint.t.clearance] = clearance;
    scene
}

/// The magnitudes of the forces in the four joints at each communication point, and the number of steps.
fn forces(scene: &Scene, method: Method, tolerance: f64) -> (Vec<[f64; 4]>, i32) {
    let mut scene = scene.clone();
    (scene.solver.method, scene.solver.tolerance) = (method, tolerance);
    let mut simulation = Simulation::start(&scene, Default::default()).expect("a start");
    let mut steps = 0;
    let all = (1..=POINTS).map(|point| {
        simulation.advance_to(SPAN * f64::from(point) / f64::from(POINTS)).expect("an end");
        let Outputs { joint_a, joint_b, joint_c, joint_t, solver, .. } = simulation.outputs();
        steps = solver.steps;
        [joint_a.force, joint_b.force, joint_c.force, joint_t.force].map(|[x, y]| x.hypot(y))
    });
    (all.collect(), steps)
}

/// The largest deviation of any force over that joint's largest force.
fn deviation(one: &[[f64; 4]], other: &[[f64; 4]]) -> f64 {
    let of_joint = |joint: usize| {
        let amplitude = other.iter().map(|forces| forces[joint]).fold(0.0, f64::max);
        one.iter().zip(other).map(|(one, other)| (one[joint] - other[joint]).abs()).fold(0.0, f64::max) / amplitude
    };
    (0..4).map(of_joint).fold(0.0, f64::max)
}

#[test]
fn an_error_falls_with_the_tolerance_to_rounding_and_stays_there() {
    for clearance in CLEARANCES {
        let scene = slow(clearance);
        let (reference, _) = forces(&scene, Method::Rodas4, 1e-10);
        let (loose, steps) = forces(&scene, Method::Automatic, 1e-9);
        let error = deviation(&loose, &reference);
        assert!(error < ROUNDING, "{clearance:?}: {error:e} at 1e-9");
        for (method, tolerance) in [1e-10, 1e-11, 1e-12, 1e-13].map(|tolerance| (Method::Automatic, tolerance)) {
            let (tight, more) = forces(&scene, method, tolerance);
            let error = deviation(&tight, &reference);
            assert!(error < ROUNDING, "{clearance:?}: {error:e} at {tolerance:e}");
            assert!(more < 60 * steps, "{clearance:?}: {more} steps at {tolerance:e}, {steps} at 1e-9");
        }
    }
}

#[test]
fn roundings_of_places_do_not_shorten_the_steps_of_a_flexible_rod() {
    for clearance in &CLEARANCES[..2] {
        let mut scene = slow(*clearance);
        scene.rod.flexible.bending_modes = 2;
        let (loose, steps) = forces(&scene, Method::Automatic, 1e-9);
        for tolerance in [1e-11, 1e-13] {
            let (tight, more) = forces(&scene, Method::Automatic, tolerance);
            let error = deviation(&tight, &loose);
            assert!(error < 10.0 * ROUNDING, "{clearance:?}: {error:e} at {tolerance:e}");
            assert!(more < 4 * steps, "{clearance:?}: {more} steps at {tolerance:e}, {steps} at 1e-9");
        }
    }
}
