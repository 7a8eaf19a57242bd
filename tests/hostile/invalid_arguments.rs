//! Numbers that are legal and beyond all measure: carried or told, soon, and never handed out as NaN or infinity.

use crate::brief;
use crate::host::{Slave, vr};
use crate::scenes::{MECHANISMS, Mechanism};
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::fmi::v2::Status;

/// [s]
const H: f64 = 1e-3;
/// The most evaluations of one step that these hosts allow; the last attempts may go beyond by some.
const WORK: i32 = 100_000;

/// Mechanisms whose hundred thousand evaluations take no time.
fn quick() -> &'static [Mechanism] {
    &MECHANISMS[..if brief() { 1 } else { 4 }]
}

/// Every output is a number or is not told.
pub fn look(slave: &Slave, what: &str) {
    for variable in VARIABLES.iter().filter(|variable| matches!(variable.access, Access::RealOutput(_))) {
        match slave.try_get(variable.name) {
            Ok(value) => assert!(value.is_finite(), "{what}: {} = {value}", variable.name),
            Err(status) => {
                assert_eq!(status, Status::Discard, "{what}: {:?}", slave.log.take());
                let line = slave.log.only();
                assert!(line.text.contains(variable.name) && line.text.contains("is not a finite number"), "{line:?}");
            }
        }
    }
}

#[test]
fn inputs_beyond_all_measure_are_carried_or_told_and_can_be_taken_back() {
    for mechanism in quick() {
        let Mechanism { name, .. } = mechanism;
        let bounded = || {
            let slave = mechanism.initializing();
            assert_eq!(slave.set_integer("solver.max_evaluations", WORK), Status::Ok);
            assert_eq!(slave.exit(), Status::Ok);
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
                    let (before, work) = (slave.save(), slave.get_integer("solver.evaluations"));
                    let set = if slope { slave.set_rate(input, 1, value) } else { slave.set(input, value) };
                    assert_eq!(set, Status::Ok, "{what}");
                    look(&slave, &what);
                    let status = slave.step(point, H);
                    let lines = slave.log.take();
                    assert!(matches!(status, Status::Ok | Status::Discard), "{what}: {lines:?}");
                    assert_eq!(lines.len(), usize::from(status == Status::Discard), "{what}: {lines:?}");
                    assert!(slave.get_integer("solver.evaluations") - work <= WORK + WORK / 100, "{what}");
                    look(&slave, &what);
                    assert_eq!(slave.set_state(before), Status::Ok, "{what}");
                    slave.steps(point, H, 2);
                    assert_eq!(slave.picture(), undisturbed.picture(), "{what}");
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

#[test]
fn steps_and_times_beyond_all_measure_are_told_soon() {
    for mechanism in quick() {
        for size in [1e10, 1e300, f64::MAX] {
            let slave = mechanism.running();
            assert_eq!(slave.step(0.0, size), Status::Discard, "{}, {size:e}", mechanism.name);
            assert!(slave.log.only().text.contains("solver.max_evaluations"));
            assert_eq!(slave.get_integer("solver.steps"), 0);
        }
        // From 10¹⁵ s, whose rounding is an eighth of a second, motion is as it is from 0.
        for start in [1e15, -1e15] {
            let slave = mechanism.running_from(start);
            assert_eq!(slave.step(start, H), Status::Ok, "a step below rounding is one");
            assert_eq!(slave.step(start, 0.125), Status::Ok, "{}, {start:e}", mechanism.name);
            assert_eq!(slave.last_time(), start + 0.125);
        }
        for start in [1e300, f64::MIN] {
            let slave = mechanism.running_from(start);
            assert_eq!(slave.step(start, H), Status::Ok, "a step below rounding is one");
            assert_eq!(slave.step(start, start.abs() / 8.0), Status::Discard, "{}, {start:e}", mechanism.name);
            assert!(slave.log.only().text.contains("solver.max_evaluations"));
            assert_eq!(slave.last_time(), start);
        }
    }
}

#[test]
fn seeds_beyond_all_measure_give_numbers_or_are_told() {
    let slave = Slave::running();
    for unknown in ["slider.a", "joint.A.force.x", "drive.torque", "slider.x"] {
        for seed in [f64::MAX, f64::MIN, 1e300, 5e-324] {
            // Named twice, it counts twice.
            let (known, seeds) = ([vr("slider.load"); 2], [seed; 2]);
            let mut answer = 0.0;
            // SAFETY: live component, arrays of the lengths said.
            let status = unsafe {
                let (known, seeds) = (known.as_ptr(), seeds.as_ptr());
                (slave.api.GetDirectionalDerivative)(slave.c, &vr(unknown), 1, known, 2, seeds, &mut answer)
            };
            let lines = slave.log.take();
            assert!(
                answer.is_finite() && matches!(status, Status::Ok | Status::Discard),
                "{unknown}: {answer} {lines:?}"
            );
            assert_eq!(lines.len(), usize::from(status == Status::Discard));
        }
    }
}
