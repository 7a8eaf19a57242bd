//! Start values, inputs and outputs.

use host::{Slave, vr};
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::fmi::v2::Status;
use slidercrank::scene::parameter::{Kind, Parameter};

#[test]
fn inputs_and_parameters_read_back_in_every_state() {
    let slave = Slave::new();
    let read_back = |slave: &Slave| {
        for variable in VARIABLES {
            match &variable.access {
                Access::Input { start, .. } => assert_eq!(slave.get(variable.name), *start),
                Access::Parameter(Parameter { kind: Kind::Real { start, .. }, .. }) => {
                    assert_eq!(slave.get(variable.name), *start);
                }
                Access::Parameter(Parameter {
                    kind: Kind::Enumeration { start, .. } | Kind::Integer { start, .. },
                    ..
                }) => {
                    assert_eq!(slave.get_integer(variable.name), *start);
                }
                Access::Parameter(Parameter { kind: Kind::Boolean { start, .. }, .. }) => {
                    assert_eq!(slave.get_boolean(variable.name), i32::from(*start));
                }
                _ => {}
            }
        }
    };
    read_back(&slave);
    assert_eq!(slave.enter(), Status::Ok);
    read_back(&slave);
    assert_eq!(slave.exit(), Status::Ok);
    read_back(&slave);
    assert_eq!(slave.terminate(), Status::Ok);
    read_back(&slave);
}

#[test]
fn outputs_follow_start_values_in_initialization_mode() {
    let slave = Slave::initializing();
    let (r, l) = (0.05, 0.12);
    assert!((slave.get("slider.x") - (r + l)).abs() < 1e-15);
    assert_eq!(slave.set("crank.length", 0.06), Status::Ok);
    assert!((slave.get("slider.x") - (0.06 + l)).abs() < 1e-15);
    assert_eq!(slave.set("crank.angle_start", 1.0), Status::Ok);
    assert_eq!(slave.get("crank.angle"), 1.0);
    // F = m·a of the slider and what it drags along: the load shows in the acceleration.
    let before = slave.get("slider.a");
    assert_eq!(slave.set("slider.load", 100.0), Status::Ok);
    assert!(slave.get("slider.a") > before);
    assert_eq!(slave.exit(), Status::Ok);
    assert_eq!(slave.get("crank.angle"), 1.0);
}

#[test]
fn a_start_value_may_be_set_before_the_experiment_and_without_one() {
    let slave = Slave::new();
    assert_eq!(slave.set("crank.speed_start", 10.0), Status::Ok);
    assert_eq!(slave.set("crank.torque", 3.0), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    assert_eq!(slave.get("crank.speed"), 10.0);
    assert_eq!(slave.get("drive.torque"), 3.0);
    assert_eq!(slave.step(0.0, 1e-3), Status::Ok);
}

#[test]
fn an_input_shows_at_once_and_without_a_step() {
    let slave = Slave::running();
    let point = slave.steps(0.0, 1e-3, 3);
    assert_eq!(slave.set("crank.torque", 7.0), Status::Ok);
    assert_eq!((slave.get("crank.torque"), slave.get("drive.torque")), (7.0, 7.0));
    assert_eq!(slave.set("crank.torque", 8.0), Status::Ok);
    assert_eq!(slave.get("drive.torque"), 8.0);
    slave.steps(point, 1e-3, 1);
    assert_eq!((slave.get("crank.torque"), slave.get("drive.torque")), (8.0, 8.0));
}

#[test]
fn looking_at_outputs_does_not_change_the_run() {
    let (watched, alone) = (Slave::running(), Slave::running());
    let (mut watched_point, mut alone_point) = (0.0, 0.0);
    for i in 0..20 {
        let torque = f64::from(i);
        for slave in [&watched, &alone] {
            assert_eq!(slave.set("crank.torque", torque), Status::Ok);
        }
        watched.picture();
        watched_point = watched.steps(watched_point, 1e-4, 1);
        watched.picture();
        alone_point = alone.steps(alone_point, 1e-4, 1);
    }
    assert_eq!(watched.picture(), alone.picture());
}

#[test]
fn every_parameter_refuses_what_is_outside_its_range_and_says_the_range() {
    let slave = Slave::new();
    let refused = |name: &str, status: Status| {
        let line = slave.log.only();
        assert_eq!(status, Status::Error, "{line:?}");
        assert!(line.text.contains(name) && line.text.contains("allowed"), "{line:?}");
    };
    for variable in VARIABLES {
        let Access::Parameter(parameter) = variable.access else {
            continue;
        };
        match parameter.kind {
            Kind::Real { min, max, .. } => {
                let before = slave.get(variable.name);
                for limit in [min, max].into_iter().filter(|limit| limit.abs() < f64::MAX) {
                    assert_eq!(slave.set(variable.name, limit), Status::Ok);
                }
                for beyond in [min - min.abs().max(1.0) * 1e-9, max + max.abs().max(1.0) * 1e-9] {
                    if beyond.is_finite() && beyond.abs() < 1e300 {
                        refused(variable.name, slave.set(variable.name, beyond));
                    }
                }
                assert_eq!(slave.set(variable.name, before), Status::Ok);
            }
            Kind::Integer { min, max, .. } => {
                for limit in [min, max] {
                    assert_eq!(slave.set_integer(variable.name, limit), Status::Ok);
                    assert_eq!(slave.get_integer(variable.name), limit);
                }
                for beyond in [min - 1, max + 1, i32::MAX, i32::MIN] {
                    refused(variable.name, slave.set_integer(variable.name, beyond));
                }
                assert_eq!(slave.get_integer(variable.name), max);
            }
            Kind::Boolean { start, .. } => {
                // Every number is a Boolean: C's.
                for value in [i32::from(!start), i32::from(start)] {
                    assert_eq!(slave.set_boolean(variable.name, value), Status::Ok);
                    assert_eq!(slave.get_boolean(variable.name), value);
                }
            }
            Kind::Enumeration { items, .. } => {
                for value in [0, -1, items.len() as i32 + 1, i32::MAX, i32::MIN] {
                    refused(variable.name, slave.set_integer(variable.name, value));
                }
            }
        }
    }
}

#[test]
fn integers_and_booleans_are_fixed_parameters_of_their_own_types() {
    let slave = Slave::new();
    assert_eq!(slave.set_integer("rod.flexible.bending_modes", 9), Status::Error);
    let text = slave.log.only().text;
    assert!(text.ends_with("rod.flexible.bending_modes = 9 is out of range; allowed: an integer, 0 to 8"), "{text}");
    assert_eq!(slave.set("rod.flexible.axial_modes", 1.0), Status::Error);
    assert!(slave.log.only().text.contains("rod.flexible.axial_modes is of type Integer, not Real"));
    assert_eq!(slave.set_integer("energy.audit", 1), Status::Error);
    assert!(slave.log.only().text.contains("energy.audit is of type Boolean, not Integer"));
    assert_eq!(slave.set_boolean("rod.flexible.bending_modes", 1), Status::Error);
    assert!(slave.log.only().text.contains("rod.flexible.bending_modes is of type Integer, not Boolean"));
    assert_eq!(slave.set_boolean("energy.audit", 1), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    for status in [slave.set_integer("rod.flexible.bending_modes", 1), slave.set_boolean("energy.audit", 0)] {
        assert_eq!(status, Status::Error);
    }
    assert!(slave.log.take().iter().all(|line| line.text.contains("(fixed parameter) cannot be set")));
    assert_eq!((slave.get_boolean("energy.audit"), slave.get_integer("rod.flexible.bending_modes")), (1, 0));
    assert_eq!(slave.reset(), Status::Ok);
    assert_eq!(slave.get_boolean("energy.audit"), 0);
}

#[test]
fn values_set_together_are_applied_all_or_none() {
    let slave = Slave::initializing();
    let references = [vr("rod.length"), vr("crank.torque"), vr("crank.length")];
    let before = [0.12, 0.0, 0.05];
    for (values, culprit) in [([0.2, 5.0, -1.0], "crank.length"), ([0.2, f64::NAN, 0.06], "crank.torque")] {
        assert_eq!(slave.set_all(&references, &values), Status::Error);
        assert!(slave.log.only().text.contains(culprit));
        let names = ["rod.length", "crank.torque", "crank.length"];
        assert_eq!(names.map(|name| slave.get(name)), before);
    }
    assert_eq!(slave.set_all(&references, &[0.2, 5.0, 0.06]), Status::Ok);
    assert_eq!(slave.get("crank.length"), 0.06);
}

#[test]
fn a_scene_that_contradicts_itself_can_be_corrected() {
    let slave = Slave::initializing();
    assert_eq!(slave.set("guide.offset", 0.3), Status::Ok);
    assert_eq!(slave.exit(), Status::Error);
    assert!(slave.log.only().text.contains("rod.length"));
    assert_eq!(slave.try_get("slider.x"), Err(Status::Error));
    slave.log.take();
    assert_eq!(slave.set("guide.offset", 0.03), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    assert_eq!(slave.get("slider.y"), 0.03);
}

#[test]
fn reset_brings_every_start_value_back_and_can_be_repeated() {
    let slave = Slave::running();
    slave.steps(0.0, 1e-4, 50);
    let first = slave.picture();
    for _ in 0..3 {
        assert_eq!(slave.set("crank.torque", 4.0), Status::Ok);
        assert_eq!(slave.reset(), Status::Ok);
        assert_eq!((slave.get("crank.torque"), slave.get("crank.speed_start")), (0.0, 0.0));
        assert_eq!(slave.get_integer("joint.C.model"), 1);
        assert_eq!(slave.setup_raw(0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(slave.enter(), Status::Ok);
        slave.wear();
        assert_eq!(slave.exit(), Status::Ok);
        assert_eq!(slave.last_time(), 0.0);
        slave.steps(0.0, 1e-4, 50);
        assert_eq!(slave.picture(), first);
    }
}
