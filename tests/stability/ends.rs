//! Every parameter at the ends of its declared range, one at a time, and next to 0.

use crate::run::not_finite;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::parameter::{Kind, Parameter};
use slidercrank::scene::{DriveMode, Elasticity, FrictionLaw, JointModel, PARAMETERS, Scene, Surface};
use slidercrank::simulation::Simulation;

/// Evaluations of the equations of motion after which a run has shown what it can, of one step and of all.
const ENOUGH: i32 = 20_000;
/// [s] A run is over.
const END: f64 = 2e-3;

fn clear(scene: &mut Scene) {
    let joint = &mut scene.joint;
    for model in [&mut joint.a.model, &mut joint.b.model, &mut joint.c.model, &mut joint.t.model] {
        *model = JointModel::Clearance;
    }
    for contact in [&mut joint.a.contact, &mut joint.b.contact, &mut joint.c.contact, &mut joint.t.contact] {
        contact.friction.law = FrictionLaw::Ambrosio;
    }
    (joint.a.clearance, joint.b.clearance) = (2e-5, 3e-5);
    (joint.c.clearance, joint.t.clearance) = (1e-4, 5e-5);
    scene.crank.angle_start = 0.7;
    scene.crank.speed_start = 200.0;
    scene.gravity = 9.81;
}

/// Mechanisms that between them use every parameter.
fn mechanisms() -> [(&'static str, Scene); 4] {
    let mut ideal = Scene::default();
    ideal.drive.mode = DriveMode::Speed;
    ideal.solver.max_evaluations = ENOUGH;
    let mut corners = Scene::default();
    corners.solver.max_evaluations = ENOUGH;
    clear(&mut corners);
    corners.energy.audit = true;
    let mut bristles = corners.clone();
    bristles.energy.audit = false;
    bristles.joint.b.contact.friction.law = FrictionLaw::Lugre;
    bristles.joint.t.contact.friction.law = FrictionLaw::Lugre;
    bristles.joint.a.contact.friction.law = FrictionLaw::Tanh;
    bristles.joint.c.contact.friction.law = FrictionLaw::Stribeck;
    bristles.joint.a.elasticity = Elasticity::Liu;
    bristles.joint.t.surface = Surface::Foundation;
    let mut elastic = Scene::default();
    elastic.solver.max_evaluations = ENOUGH;
    clear(&mut elastic);
    elastic.joint.a.model = JointModel::Ideal;
    (elastic.rod.flexible.bending_modes, elastic.rod.flexible.axial_modes) = (2, 1);
    [("ideal", ideal), ("corners", corners), ("bristles", bristles), ("elastic", elastic)]
}

/// Values of a parameter that are as far out as its range allows.
fn extremes(parameter: &Parameter) -> Vec<f64> {
    let least = f64::from_bits(1);
    let mut values = match parameter.kind {
        Kind::Real { min, max, .. } => vec![min, max, least, -least],
        Kind::Integer { min, max, .. } => vec![f64::from(min), f64::from(max)],
        Kind::Boolean { .. } => vec![0.0, 1.0],
        Kind::Enumeration { items, .. } => items.iter().map(|(_, value)| f64::from(*value)).collect(),
    };
    values.retain(|value| parameter.admit(*value).is_ok());
    values
}

/// Runs with communication steps that grow while they are cheap; the time reached.
fn run(what: &str, scene: &Scene) -> f64 {
    let inputs = Inputs { crank_torque: 3.0, slider_load: -20.0 };
    let mut simulation = match Simulation::start(scene, inputs) {
        Ok(simulation) => simulation,
        Err(error) => panic!("{what}: {error}"),
    };
    let sound = |outputs: &Outputs, time: f64| assert_eq!(not_finite(outputs), None, "{what}: at {time:e} s");
    let (mut time, mut step, mut spent) = (0.0, 1e-15, 0);
    while time < END && spent < ENOUGH {
        time = f64::min(time + step, END);
        if let Err(error) = simulation.advance_to(time) {
            println!("{what}: {error}");
            break;
        }
        let outputs = simulation.outputs();
        sound(&outputs, time);
        sound(&simulation.output_rates(), time);
        let cost = outputs.solver.evaluations - spent;
        spent = outputs.solver.evaluations;
        step = if cost < 500 { 3.0 * step } else { 0.5 * step };
        step = step.min(0.02 * END).max(f64::EPSILON * time);
    }
    sound(&simulation.outputs(), time);
    simulation.time()
}

#[test]
fn every_parameter_may_be_as_small_and_as_large_as_is_declared() {
    let (mut legal, mut refused) = (0, 0);
    for (name, scene) in mechanisms() {
        for parameter in PARAMETERS {
            for value in extremes(parameter) {
                let mut scene = scene.clone();
                parameter.write(&mut scene, value).expect("a value within the range");
                if scene.check().is_err() {
                    refused += 1;
                    continue;
                }
                legal += 1;
                let time = run(&format!("{name}, {} = {value:e}", parameter.name), &scene);
                assert!(time > 0.0, "{name}, {} = {value:e}", parameter.name);
            }
        }
    }
    println!("{legal} legal scenes, {refused} refused");
    assert!(legal > 5 * refused);
}
