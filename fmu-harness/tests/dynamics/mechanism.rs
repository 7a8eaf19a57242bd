//! The crank drive itself: what is known of it, and that a failing value stops no other.

use super::light_crank;
use fmu_harness::dynamics::bifurcation::{From, Range};
use fmu_harness::dynamics::portrait::Plan;
use fmu_harness::dynamics::section::stroboscope;
use fmu_harness::dynamics::verdict::Verdict;
use fmu_harness::dynamics::{Flow, Machine};
use fmu_harness::scenes::Scenario;
use fmu_harness::sensitivity::Experiment;
use slidercrank::scene::profile::Profile;
use slidercrank::scene::read::{SceneFile, read};
use slidercrank::scene::{FrictionLaw, JointModel};
use std::f64::consts::{FRAC_PI_2, TAU};

const PLAN: Plan = Plan { transient: 30, turns: 60, section: 0.0, per_turn: 25, tangent_turns: 0 };

fn wornpin(clearance: f64) -> SceneFile {
    let mut file = Scenario::find("wornpin").expect("a shipped scene").file;
    file.scene.joint.c.clearance = clearance;
    file
}

#[test]
fn a_small_clearance_is_periodic_and_a_large_one_chaotic() {
    let small = PLAN.portrait(&wornpin(0.02e-3), || {}).expect("a portrait");
    assert_eq!(small.evidence.verdict, Verdict::Periodic(1), "{:?}", small.evidence);
    assert_eq!(small.impacts, [], "the journal never leaves its bearing");
    // A lasting contact keeps its approach speed for ever. Neighbours begin with the same, so that the motion alone counts,
    // which is stable: the tangent's largest exponent is compared in `tangent`.
    assert!(small.evidence.exponent + 4.0 * small.evidence.error < 0.0, "{:?}", small.evidence);
    let large = PLAN.portrait(&wornpin(0.5e-3), || {}).expect("a portrait");
    assert_eq!(large.evidence.verdict, Verdict::Chaotic, "{:?}", large.evidence);
    // Neighbours part by about e^5 a turn.
    let per_turn = large.evidence.exponent * large.turn;
    assert!((3.5..6.5).contains(&per_turn), "{per_turn}");
    assert!(large.impacts.iter().all(|impact| impact.joint == 'C' && impact.speed > 0.0));
}

#[test]
fn a_section_is_once_a_turn_at_its_angle_under_both_drives() {
    for scene in ["allplay", "wornpin"] {
        let file = Scenario::find(scene).expect("a shipped scene").file;
        let mut machine = Machine::start(&file).expect("a machine");
        let visits = stroboscope(&mut machine, 1.0, 3, || {}).expect("visits");
        for (turn, visit) in visits.iter().enumerate() {
            let turned = (visit.outputs.crank.angle - file.scene.crank.angle_start).abs();
            assert!((turned - 1.0 - TAU * turn as f64).abs() < 1e-8, "{scene}, visit {turn}: {turned} rad");
        }
    }
}

#[test]
fn a_machine_goes_on_from_where_it_was_placed() {
    let file = wornpin(0.5e-3);
    let mut machine = Machine::start(&file).expect("a machine");
    machine.advance(0.02).expect("it runs");
    let point = machine.point();
    machine.advance(0.021).expect("it runs");
    let first = machine.point();
    machine.place(&point);
    machine.advance(0.021).expect("it runs");
    // The step sequence is another: the same motion up to the tolerance.
    assert!(machine.point().distance(&first) < 1e-2, "{}", machine.point().distance(&first));
}

/// A free crank whose slider is loaded near a crank angle of 0 alone.
const KICKED: &str = r#"
[run]
step = "200 us"
[drive]
mode = "torque"
[crank]
angle_start = "90 deg"
speed_start = "100 rad/s"
torque = "20 N.m"
inertia = 5
[joint.A]
damping = 0.2
[slider]
load = { against = "crank.angle", points = [["0 deg", "-10 kN"], ["5 deg", 0], ["355 deg", 0]] }
"#;

#[test]
fn a_machine_that_was_placed_has_the_inputs_of_that_place() {
    let file = read(KICKED, "kicked").expect("a scene");
    let mut machine = Machine::start(&file).expect("a machine");
    machine.advance_turned(0.5).expect("it runs");
    let (point, force) = (machine.point(), machine.outputs().joint_t.force);
    machine.advance_turned(0.75 * TAU).expect("it runs");
    machine.place(&point);
    let again = machine.outputs().joint_t.force;
    assert!((again[1] - force[1]).abs() < 1e-6 * force[1].abs(), "{again:?} N for {force:?} N");
}

/// A torque turns a free crank against its start speed.
fn turned_back() -> SceneFile {
    let mut file = light_crank();
    (file.scene.crank.angle_start, file.scene.crank.speed_start) = (FRAC_PI_2, 20.0);
    file.inputs.crank_torque = Profile::Constant(-20.0);
    file
}

#[test]
fn a_crank_that_is_turned_back_does_not_turn_on() {
    let mut file = turned_back();
    let mut machine = Machine::start(&file).expect("a machine");
    let error = machine.advance_turned(TAU).expect_err("it turns back");
    assert!(error.to_string().contains("does not turn on"), "{error}");
    assert!((-1.1..-1.0).contains(&(machine.turned() / TAU)), "it ends after a turn back: {}", machine.turned() / TAU);
    let accuracy = fmu_harness::accuracy::Plan { transient: 0, turns: 1 }.measure(&file);
    assert!(accuracy.is_err(), "{accuracy:?}");
    let experiment = Experiment { file: &file, turns: 1.0, transient: 0.0, counted: false };
    let wanted = ["slider.v@bdc".parse().expect("a quantity")];
    assert!(experiment.values(&wanted).is_err(), "the crank passes no bottom dead centre on its way on");
    // The same torque turns on a crank that starts its way.
    file.scene.crank.speed_start = -20.0;
    let mut machine = Machine::start(&file).expect("a machine");
    machine.advance_turned(2.0).expect("it turns on");
    assert!((machine.turned() - 2.0).abs() < 1e-6 && machine.outputs().crank.angle < 0.0);
}

#[test]
fn a_crank_that_still_speeds_up_is_not_periodic_and_one_that_no_longer_does_is() {
    let mut file = read(KICKED, "kicked").expect("a scene");
    file.scene.crank.speed_start = 60.0;
    let plan = Plan { turns: 6, per_turn: 5, ..PLAN };
    // Of the way to its last speed exp(−d·t/J) is left: 4e-14 after the longer transient.
    for (transient, verdict) in [(4, Verdict::Irregular), (12_000, Verdict::Periodic(1))] {
        let portrait = Plan { transient, ..plan }.portrait(&file, || {}).expect("a portrait");
        assert_eq!(portrait.evidence.verdict, verdict, "after {transient} turns: {:?}", portrait.evidence);
    }
}

#[test]
fn a_crank_that_runs_far_faster_than_at_its_start_is_met_at_each_angle_and_its_turns_have_their_own_time() {
    let mut file = turned_back();
    (file.scene.crank.speed_start, file.scene.joint.c.model) = (-0.1, JointModel::Clearance);
    let mut machine = Machine::start(&file).expect("a machine");
    for turn in [0.1, 0.2, 1.0, 1.5, 10.0] {
        machine.advance_turned(TAU * turn).expect("it turns on");
        assert!((machine.turned() - TAU * turn).abs() < 1e-8, "{} of {turn} turns", machine.turned() / TAU);
    }
    let plan = Plan { transient: 20, turns: 6, per_turn: 2, ..PLAN };
    let portrait = plan.portrait(&file, || {}).expect("a portrait");
    let last = portrait.visits[5].time - portrait.visits[0].time;
    assert!((portrait.turn / (last / 5.0) - 1.0).abs() < 1e-12 && portrait.turn < 0.1, "{} s", portrait.turn);
}

/// Between neighbours that differ in LuGre's bristles alone: δż = −σ0·|v|/g(v)·δz, and far above the Stribeck speed g is
/// the kinetic coefficient. In a small clearance the journal slides at the bearing's radius times the rod's speed.
#[test]
fn a_bristle_belongs_to_the_point_and_forgets_at_the_rate_of_its_law() {
    const SIGMA0: f64 = 1e4;
    let frictionless = wornpin(0.02e-3);
    let mut file = frictionless.clone();
    let friction = &mut file.scene.joint.c.contact.friction;
    (friction.law, friction.sigma0, friction.sigma1) = (FrictionLaw::Lugre, SIGMA0, 0.0);
    let (kinetic, radius) = (friction.coefficient, file.scene.joint.c.radius);
    let [mut machine, mut without] = [&file, &frictionless].map(|file| Machine::start(file).expect("a machine"));
    let turn = machine.turn();
    for machine in [&mut machine, &mut without] {
        machine.advance(2.1 * turn).expect("it runs");
    }
    let point = machine.point();
    assert_eq!((point.modes.iter().filter(|closed| **closed).count(), point.coordinates.len()), (1, 6));
    assert_eq!(without.point().coordinates.len(), 5, "positions, their rates, one approach speed");
    let bristle = 4;
    let rate = SIGMA0 * radius * machine.outputs().rod.speed.abs() / kinetic;
    let mut near = point.clone();
    near.coordinates[bristle] += 0.1;
    let mut neighbour = Machine::start(&file).expect("a machine");
    let left = [(&mut machine, &point), (&mut neighbour, &near)].map(|(machine, start)| {
        machine.place(start);
        assert_eq!(machine.point(), *start);
        machine.advance(start.time + 1.0 / rate).expect("it runs");
        machine.point().coordinates[bristle]
    });
    let share = (left[1] - left[0]) / 0.1;
    assert!((share * std::f64::consts::E - 1.0).abs() < 0.05, "{share} after one time constant of {:e} s", 1.0 / rate);
}

#[test]
fn a_branch_is_followed_or_started_anew_and_a_bad_value_is_refused_by_name() {
    let plan = Plan { transient: 20, turns: 12, ..PLAN };
    let range = Range::new("joint.C.clearance", 1e-5, 2e-5, 3, false).expect("a range");
    for from in [From::Fresh, From::Before] {
        let branches = range.branches(&wornpin(1e-5), &plan, from, || {}).expect("branches");
        let values: Vec<f64> = branches.iter().map(|branch| branch.value).collect();
        let apart = values.iter().zip([1e-5, 1.5e-5, 2e-5]).map(|(found, wanted)| (found - wanted).abs());
        assert!(values.len() == 3 && apart.fold(0.0, f64::max) < 1e-18, "{values:?}");
        for branch in &branches {
            let (visits, evidence) = branch.outcome.as_ref().expect("it runs");
            assert_eq!((visits.len(), evidence.verdict), (12, Verdict::Periodic(1)), "{}", branch.value);
        }
    }
    for (name, from, to, word) in [
        ("joint.C.clearanse", 1e-5, 2e-5, "joint.C.clearanse"),
        ("joint.C.clearance", 1e-5, 2.0, "1e-9 to 0.1 m"),
        ("solver.method", 1.0, 2.0, "real number"),
    ] {
        let error = Range::new(name, from, to, 3, false).expect_err(name);
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn a_crank_that_stands_has_no_turns() {
    let mut file = wornpin(1e-4);
    file.scene.crank.speed_start = 0.0;
    let error = Machine::start(&file).err().expect("nothing to section");
    assert!(error.to_string().contains("crank.speed_start"), "{error}");
}
