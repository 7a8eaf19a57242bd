//! Compares a run with a reference motion, for as long as that motion can be computed.
//!
//! Two runs of a chaotic motion diverge sooner or later. A run must stay near the reference at least for as long as
//! another method stays near it at the same tolerance.

use slidercrank::model::signals::{Inputs, Outputs};
use slidercrank::scene::read::SceneFile;
use slidercrank::scene::{JointModel, Method, Scene};
use slidercrank::simulation::Simulation;

/// Method of the reference. Its order differs from that of the peer.
const REFERENCE: (Method, f64) = (Method::Dop853, 1e-11);
/// The peer: a method that runs with the tolerance of the run.
const PEER: Method = Method::Verner7;
/// Maximum number of turns that are compared.
const TURNS: f64 = 1.0;
/// [clearances] A peer at this distance has left the reference.
const LEFT: f64 = 1e-4;
/// Allowed distance of a run: this factor times the largest distance of its peer so far, or this factor times the
/// tolerance in clearances. Errors at impacts and of values interpolated between steps are larger than errors of steps.
const FACTOR: f64 = 1e3;

/// If the run of a scene leaves the reference before its peer does: a text with the distance in clearances and the
/// time.
pub fn parts(file: &SceneFile) -> Option<String> {
    let scene = &file.scene;
    let ways = [(scene.solver.method, scene.solver.tolerance), (PEER, scene.solver.tolerance), REFERENCE];
    let mut runs = vec![];
    for (method, tolerance) in ways {
        let mut file = file.clone();
        (file.scene.solver.method, file.scene.solver.tolerance) = (method, tolerance);
        runs.push((Simulation::start(&file.scene, Inputs::at_start(&file)).ok()?, file));
    }
    let turn = std::f64::consts::TAU / scene.crank.speed_start.abs();
    let points = (f64::min(TURNS * turn, file.run.stop(scene)) / file.run.step) as usize;
    let mut worst_of_peer = 0.0_f64;
    for point in 1..=points {
        let time = file.run.step * point as f64;
        let mut outputs = vec![];
        for (simulation, file) in &mut runs {
            let crank = simulation.outputs().crank;
            let [inputs, rates] = Inputs::chords(&file.inputs, [simulation.time(), time], &crank);
            simulation.set_inputs(inputs, rates);
            // A run that ends early is judged elsewhere.
            simulation.advance_to(time).ok()?;
            outputs.push(simulation.outputs());
        }
        let [own, peer] = [0, 1].map(|run| distance(scene, &outputs[run], &outputs[2]));
        worst_of_peer = worst_of_peer.max(peer);
        if worst_of_peer > LEFT {
            return None;
        }
        if own > FACTOR * worst_of_peer.max(scene.solver.tolerance) {
            return Some(format!(
                "{own:.1e} clearances from the reference, where {} has been {worst_of_peer:.1e}, at {time:e} s",
                PEER.name()
            ));
        }
    }
    None
}

/// Largest distance of the slider and of the journals in two states, divided by the smallest clearance, or by the
/// crank's length if there is no clearance.
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
