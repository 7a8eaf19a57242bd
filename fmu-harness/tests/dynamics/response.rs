//! The frequency response of a slender rod that bends at twice the speed of its crank: it folds over, since bending
//! draws the slider in.

use super::light_crank;
use fmu_harness::dynamics::bifurcation::{Branch as Simulated, Range};
use fmu_harness::dynamics::continuation::{Bifurcation, Continuation};
use fmu_harness::dynamics::orbit::{Orbit, ReturnMap};
use fmu_harness::dynamics::poincare::PoincareMap;
use fmu_harness::dynamics::portrait::Plan;
use fmu_harness::dynamics::response::Response;
use fmu_harness::dynamics::{Flow, Machine};
use fmu_harness::scenes::Scenario;
use slidercrank::scene::JointModel;
use slidercrank::scene::parameter::Parameter;
use slidercrank::scene::read::SceneFile;
use std::f64::consts::TAU;

const SPEED: &str = "crank.speed_start";

/// The rod of `seed` between ideal joints, with one bending mode, a short crank and a heavy slider.
fn slender() -> SceneFile {
    let mut file = Scenario::find("seed").expect("a shipped scene").file;
    let scene = &mut file.scene;
    (scene.joint.b.model, scene.joint.c.model, scene.joint.t.model) =
        (JointModel::Ideal, JointModel::Ideal, JointModel::Ideal);
    (scene.rod.flexible.bending_modes, scene.rod.flexible.axial_modes) = (1, 0);
    (scene.crank.length, scene.slider.mass) = (8e-3, 0.6);
    file
}

#[test]
fn going_up_and_down_the_response_jumps_at_the_folds_of_the_branch_and_lies_on_it_elsewhere() {
    let file = slender();
    let map = PoincareMap::new(&file, Parameter::named(SPEED).expect("a parameter"), 0.0).expect("a map");
    let plan = Plan { transient: 150, turns: 6, section: 0.0, per_turn: 1, tangent_turns: 0 };
    let start = plan.periodic(&map, 601.0).expect("a periodic motion");
    let continuation = Continuation { map: &map, from: 601.0, to: 619.0, doublings: 0 };
    let branch = continuation.follow(start, |_| {}).expect("branches").swap_remove(0);
    let found: Vec<_> = branch.found.iter().map(|found| (found.kind, found.orbit.value)).collect();
    assert!(found.len() == 2 && found.iter().all(|(kind, _)| *kind == Bifurcation::Fold), "{found:?}");
    let [upper, lower] = [found[0].1, found[1].1];
    assert!((615.0..617.0).contains(&upper) && (605.0..607.0).contains(&lower), "{lower} {upper}");
    // The branch before the first fold and behind the second one is stable, that between them is not.
    let parts: Vec<&[Orbit]> = branch.orbits.chunk_by(|a, b| a.is_stable() == b.is_stable()).collect();
    assert_eq!(parts.len(), 3);
    let [low, between, high] = [parts[0], parts[1], parts[2]];
    assert!(low[0].is_stable() && !between[0].is_stable());

    let mut range = Range::new(SPEED, 601.0, 619.0, 10, false).expect("a range");
    range.response = Some("rod.deflection:range".parse().expect("a response"));
    let response = range.response.as_ref().expect("a response");
    let [up, down] = range.up_and_down(&file, &plan, || {}).expect("two sweeps");
    let assert_on = |simulated: &Simulated, part: &[Orbit]| {
        let distance = |orbit: &&Orbit| (orbit.value - simulated.value).abs();
        let near = part.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a motion");
        let orbit = map.solve(simulated.value, &near.phase, 1).expect("a periodic motion").orbit;
        let (followed, simulated_is) =
            (map.response(&orbit, response).expect("a run"), simulated.response.expect("a run"));
        let apart = (followed / simulated_is - 1.0).abs();
        assert!(apart < 1e-4, "{}: {followed} m followed, {simulated_is} m simulated", simulated.value);
    };
    for simulated in &up {
        assert_on(simulated, if simulated.value < upper { low } else { high });
    }
    for simulated in &down {
        assert_on(simulated, if simulated.value > lower { high } else { low });
    }
}

#[test]
fn the_largest_force_of_blows_between_samples_counts() {
    let mut file = Scenario::find("wornpin").expect("a shipped scene").file;
    // Blows of 50 us, where the evenly spaced samples are 240 us apart.
    (file.scene.crank.speed_start, file.scene.joint.c.peak.audit) = (52.36, true);
    let response: Response = "joint.C.force:peak".parse().expect("a response");
    let mut machine = Machine::start(&file).expect("a machine");
    let found = response.of(&mut machine, 2).expect("a run");
    let mut audited = Machine::start(&file).expect("a machine");
    let mut largest = 0.0_f64;
    for part in 1..=100 {
        audited.advance_turned(TAU * f64::from(part) / 50.0).expect("a motion");
        largest = largest.max(audited.outputs().joint_c.interval.force_peak);
    }
    assert!((found / largest - 1.0).abs() < 5e-3, "{found} N, {largest} N");
}

#[test]
fn means_of_a_response_are_those_over_time() {
    let file = light_crank();
    let [mut machine, mut timed] = [0, 1].map(|_| {
        let mut machine = Machine::start(&file).expect("a machine");
        machine.advance_turned(20.0 * TAU).expect("a motion");
        machine
    });
    let response: Response = "crank.speed:mean".parse().expect("a response");
    let found = response.of(&mut machine, 3).expect("a run");
    let begin = timed.time();
    timed.advance_turned(23.0 * TAU).expect("a motion");
    let known = 3.0 * TAU / (timed.time() - begin);
    assert!((found / known - 1.0).abs() < 1e-4, "{found} rad/s, {known} rad/s");
}
