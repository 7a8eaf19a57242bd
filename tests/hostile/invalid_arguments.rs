//! Numbers that are legal and beyond all measure: carried or told, soon, and never handed out as NaN or infinity.

use crate::face::Face;
use crate::scenes::{MECHANISMS, Mechanism, hosted};
use crate::{three, two};
use host::{Slave, vr};
use slidercrank::fmi::v2::Status;

/// [s]
const H: f64 = 1e-3;
/// The most evaluations of one step that these hosts allow; the last attempts may go beyond by some.
const WORK: i32 = 100_000;

/// Mechanisms whose hundred thousand evaluations take no time.
fn quick<F: Face>() -> impl Iterator<Item = &'static Mechanism> {
    hosted::<F>().into_iter().take(4).map(|mechanism| &MECHANISMS[mechanism])
}

fn inputs_beyond_all_measure_are_carried_or_told_and_can_be_taken_back<F: Face>() {
    for mechanism in quick::<F>() {
        let Mechanism { name, .. } = mechanism;
        let bounded = || -> F {
            let slave = mechanism.initializing::<F>();
            assert_eq!(slave.set("solver.max_evaluations", f64::from(WORK)), Status::Ok);
            assert_eq!(slave.begin(), Status::Ok);
            slave
        };
        let undisturbed = bounded();
        undisturbed.steps(0.0, H, 3);
        for input in ["slider.load", "crank.torque"] {
            for slope in [false, true] {
                for value in [1e25, -1e45, 1e300, f64::MAX, f64::MIN] {
                    let what = format!("{name}, {input} = {value:e}, slope {slope}");
                    let slave = bounded();
                    let point = slave.steps(0.0, H, 1);
                    let (before, work) = (slave.save(), slave.get("solver.evaluations"));
                    let set = if slope { slave.set_slope(input, value) } else { Some(slave.set(input, value)) };
                    assert_eq!(set.unwrap_or(Status::Ok), Status::Ok, "{what}");
                    slave.look(&what);
                    let status = slave.step(point, H * F::pace());
                    let lines = slave.lines();
                    assert!([Status::Ok, Status::Discard, F::FAILED].contains(&status), "{what}: {lines:?}");
                    // A host that loses patience with events has no line.
                    let told = lines.len() == 1 || F::EVENTS && status == Status::Discard && lines.is_empty();
                    assert!(if status == Status::Ok { lines.is_empty() } else { told }, "{what}: {lines:?}");
                    assert!(slave.get("solver.evaluations") - work <= f64::from(WORK + WORK / 100), "{what}");
                    slave.look(&what);
                    assert_eq!(slave.restore(before), Status::Ok, "{what}");
                    slave.steps(point, H, 2);
                    assert_eq!(slave.everything(), undisturbed.everything(), "{what}");
                }
            }
        }
    }
}

#[test]
fn a_slope_that_leads_beyond_all_numbers_is_refused_by_name_and_can_be_corrected() {
    let slave = Slave::running();
    let long = 2.0;
    assert_eq!(slave.set_rate("crank.torque", 1, f64::MAX), Status::Ok);
    assert_eq!(slave.step(0.0, long), Status::Error);
    assert_eq!(slave.log.only().text, "fmi2DoStep: crank.torque = inf is not a finite number");
    assert_eq!(slave.set_rate("crank.torque", 1, 0.0), Status::Ok);
    assert_eq!(slave.step(0.0, H), Status::Ok);
}

#[test]
fn a_load_beyond_all_measure_leaves_no_trace_once_it_is_gone() {
    for load in [1e20, 1e38, f64::MAX] {
        let slave = Slave::new();
        assert_eq!(slave.setup_raw(0, 0.0, 1.0, 0, 0.0), Status::Ok);
        slave.wear();
        assert_eq!((slave.set("crank.angle_start", 1.0), slave.set("slider.load", load)), (Status::Ok, Status::Ok));
        assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
        assert_eq!(slave.set("slider.load", 0.0), Status::Ok);
        assert_eq!(slave.step(1.0, H), Status::Ok, "{load:e}: {:?}", slave.log.take());
        // It starts with the shortest of steps; then it is the motion that never had the load.
        let never = Slave::new();
        assert_eq!(never.setup_raw(0, 0.0, 1.0, 0, 0.0), Status::Ok);
        never.wear();
        assert_eq!(never.set("crank.angle_start", 1.0), Status::Ok);
        assert_eq!((never.enter(), never.exit()), (Status::Ok, Status::Ok));
        never.steps(1.0, H, 1);
        let apart = (slave.get("slider.x") - never.get("slider.x")).abs();
        // The tolerance is 1e-6 of 1 µm a step; measured 1e-12.
        assert!(apart < 1e-9, "{load:e}: {apart:e}");
    }
}

/// In hosts that leave events to the slave: others may stop at any number of them.
fn steps_and_times_beyond_all_measure_are_told_soon<F: Face>() {
    let refused = |slave: &F, point: f64, size: f64, name: &str| {
        assert_eq!(slave.step(point, size), F::FAILED, "{name}, {point:e}, {size:e}");
        assert!(slave.only().text.contains("solver.max_evaluations"));
        assert_eq!(slave.time(), Ok(point));
    };
    for mechanism in quick::<F>() {
        let name = mechanism.name;
        for size in [1e10, 1e300, f64::MAX] {
            let slave = mechanism.running();
            refused(&slave, 0.0, size, name);
            assert_eq!(slave.get("solver.steps"), 0.0);
        }
        // From 10¹⁵ s, whose rounding is an eighth of a second, motion is as it is from 0.
        for start in [1e15, -1e15] {
            let slave: F = mechanism.running_from(start);
            assert_eq!(slave.step(start, H), Status::Ok, "a step below rounding is one");
            assert_eq!(slave.step(start, 0.125), Status::Ok, "{name}, {start:e}");
            assert_eq!(slave.time(), Ok(start + 0.125));
        }
        for start in [1e300, f64::MIN] {
            let slave: F = mechanism.running_from(start);
            assert_eq!(slave.step(start, H), Status::Ok, "a step below rounding is one");
            refused(&slave, start, start.abs() / 8.0, name);
        }
    }
}

#[test]
fn steps_and_times_beyond_all_measure_are_told_soon_in_each_version() {
    steps_and_times_beyond_all_measure_are_told_soon::<two::Stepping>();
    steps_and_times_beyond_all_measure_are_told_soon::<three::Stepping>();
}

fn seeds_beyond_all_measure_give_numbers_or_are_told<F: Face>() {
    let slave: F = MECHANISMS[hosted::<F>()[0]].running();
    for unknown in ["slider.a", "joint.A.force.x", "drive.torque", "slider.x"] {
        for seed in [f64::MAX, f64::MIN, 1e300, 5e-324] {
            // Named twice, it counts twice.
            let answer = slave.sensitivity(vr(unknown), &[vr("slider.load"); 2], &[seed; 2]);
            let lines = slave.lines();
            let told = answer.is_ok_and(f64::is_finite) || answer == Err(Status::Discard);
            assert!(told, "{unknown}: {answer:?} {lines:?}");
            assert_eq!(lines.len(), usize::from(answer.is_err()));
        }
    }
}

on_each_face! {
    inputs_beyond_all_measure_are_carried_or_told_and_can_be_taken_back
    seeds_beyond_all_measure_give_numbers_or_are_told
}
