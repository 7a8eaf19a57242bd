//! Whether a run makes the motion that others make, as long as that is one motion.
//!
//! Two runs of a chaotic motion part sooner or later. Until the same tolerance makes another method leave a reference, a
//! run must stay near it, too.

use super::trial::inputs;
use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{JointModel, Method, Scene};
use slidercrank::simulation::Simulation;

/// Of the reference, by a method of another order than that of the peer.
const REFERENCE: (Method, f64) = (Method::Dop853, 1e-11);
/// What is asked whether it has left the reference, at the tolerance of the run.
const PEER: Method = Method::Verner7;
/// Turns that are compared at most.
const TURNS: f64 = 1.0;
/// A peer that is so many clearances off has left the reference.
const LEFT: f64 = 1e-4;
/// A run may be so many times as far off as its peer has been, and so many times its tolerance, in clearances, in any case:
/// errors of blows and of what is interpolated between steps are larger than those of steps.
const FACTOR: f64 = 1e3;

/// By how much the run of a scene is off, in clearances, and when [s], if it leaves the reference before its peer does.
pub fn parts(file: &SceneFile) -> Option<String> {
    let scene = &file.scene;
    let ways = [(scene.solver.method, scene.solver.tolerance), (PEER, scene.solver.tolerance), REFERENCE];
    let mut runs = vec![];
    for (method, tolerance) in ways {
        let mut file = file.clone();
        (file.scene.solver.method, file.scene.solver.tolerance) = (method, tolerance);
        let start = inputs(&file, 0.0, file.scene.crank.angle_start);
        runs.push((Simulation::start(&file.scene, start).ok()?, file));
    }
    let turn = std::f64::consts::TAU / scene.crank.speed_start.abs();
    let points = (f64::min(TURNS * turn, file.run.stop(scene)) / file.run.step) as usize;
    let mut worst_of_peer = 0.0_f64;
    for point in 1..=points {
        let mut outputs = vec![];
        for (simulation, file) in &mut runs {
            let angle = simulation.outputs().crank.angle;
            simulation.set_inputs(inputs(file, simulation.time(), angle), Inputs::default());
            // Whether a run arrives is another question.
            simulation.advance_to(file.run.step * point as f64).ok()?;
            outputs.push(simulation.outputs());
        }
        let [own, peer] = [0, 1].map(|run| distance(scene, &outputs[run], &outputs[2]));
        worst_of_peer = worst_of_peer.max(peer);
        if worst_of_peer > LEFT {
            return None;
        }
        if own > FACTOR * worst_of_peer.max(scene.solver.tolerance) {
            let time = file.run.step * point as f64;
            return Some(format!(
                "{own:.1e} clearances from the reference, where {} has been {worst_of_peer:.1e}, at {time:e} s",
                PEER.name()
            ));
        }
    }
    None
}

/// The largest distance of the slider and the journals in two states, over the least clearance; without one, over the
/// crank's length.
fn distance(scene: &Scene, one: &Outputs, other: &Outputs) -> f64 {
    let joint = &scene.joint;
    let clearances = [
        (joint.a.model, joint.a.clearance),
        (joint.b.model, joint.b.clearance),
        (joint.c.model, joint.c.clearance),
        (joint.t.model, joint.t.clearance),
    ];
    let with_play = clearances.into_iter().filter(|(model, _)| *model == JointModel::Clearance);
    let least = with_play.map(|(_, clearance)| clearance).fold(f64::INFINITY, f64::min);
    let scale = if least.is_finite() { least } else { scene.crank.length };
    let places = |outputs: &Outputs| {
        let [a, b, c] = [&outputs.joint_a, &outputs.joint_b, &outputs.joint_c].map(|joint| joint.eccentricity);
        [[outputs.slider.x, outputs.slider.y], a, b, c]
    };
    let apart = places(one).into_iter().zip(places(other)).map(|([x1, y1], [x2, y2])| (x1 - x2).hypot(y1 - y2));
    apart.fold(0.0, f64::max) / scale
}
