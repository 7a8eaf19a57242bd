//! Values by type, the log, and steps that fail.

use crate::importer::{Options, Slave, vr};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::model_description::arrays::PENETRATIONS;

fn logging() -> Options<'static> {
    Options { logging: true, ..Options::default() }
}

#[test]
fn an_enumeration_is_an_int64_and_nothing_else() {
    let slave = Slave::new(logging());
    assert_eq!(slave.enumeration("joint.C.law"), 5);
    assert_eq!(slave.set_enumeration("joint.C.law", 8), Status::Ok);
    assert_eq!(slave.enumeration("joint.C.law"), 8);
    for value in [0, -1, 99, i64::MAX, i64::MIN] {
        assert_eq!(slave.set_enumeration("joint.C.law", value), Status::Error, "{value}");
        assert!(slave.line().text.contains("joint.C.law"));
    }
    assert_eq!(slave.set_integer("joint.C.law", 5), Status::Error);
    assert!(slave.line().text.contains("Int64 (Enumeration), not Int32"));
    assert_eq!(slave.set_enumeration("rod.flexible.axial_modes", 1), Status::Error);
    assert!(slave.line().text.contains("Int32, not Int64"));
    assert_eq!(slave.enumeration("joint.C.law"), 8);
}

#[test]
fn any_nonzero_byte_is_true() {
    let slave = Slave::new(logging());
    for (byte, truth) in [(1, true), (0, false), (255, true)] {
        // SAFETY: live instance, arrays of one entry.
        assert_eq!(unsafe { fmi3SetBoolean(slave.0, &vr("energy.audit"), 1, &byte, 1) }, Status::Ok);
        assert_eq!(slave.boolean("energy.audit"), truth);
    }
}

#[test]
fn arrays_have_one_value_for_each_reference() {
    let slave = Slave::new(logging());
    let (references, mut values) = ([vr("slider.mass"), vr("crank.mass")], [f64::NAN; 3]);
    for count in [0, 1, 3] {
        // SAFETY: live instance, arrays at least as long as said.
        let status = unsafe { fmi3GetFloat64(slave.0, references.as_ptr(), 2, values.as_mut_ptr(), count) };
        assert_eq!(status, Status::Error);
        assert!(slave.line().text.contains("2 are needed"));
        assert!(values.iter().all(|value| value.is_nan()));
    }
}

#[test]
fn errors_are_told_even_to_those_who_do_not_log() {
    let slave = Slave::new(Options::default());
    assert_eq!(slave.set("crank.mass", -1.0), Status::Error);
    let line = slave.line();
    assert!(line.category == "logStatusError" && line.status == Status::Error as i32, "{line:?}");
    // Warnings are, too.
    assert_eq!(slave.enter_with(Some(0.5), 0.0, None), Status::Warning);
    assert_eq!(slave.line().category, "logStatusWarning");
}

#[test]
fn categories_are_switched_one_by_one() {
    // A tolerance of the importer's own makes the experiment's a remark.
    let remarks = |switches: &[(bool, &[&std::ffi::CStr], Status)], logging: bool| {
        let slave = Slave::new(Options { logging, ..Options::default() });
        for (on, categories, wanted) in switches {
            let pointers: Vec<_> = categories.iter().map(|name| name.as_ptr()).collect();
            // SAFETY: live instance, strings that end in zero.
            let status = unsafe { fmi3SetDebugLogging(slave.0, (*on).into(), pointers.len(), pointers.as_ptr()) };
            assert_eq!(status, *wanted);
            // An unknown category is a warning; the others of the call count.
            assert_eq!(slave.lines().len(), usize::from(*wanted == Status::Warning));
        }
        assert_eq!(slave.set("solver.tolerance", 1e-9), Status::Ok);
        assert_eq!(slave.enter_with(Some(1e-4), 0.0, None), Status::Ok);
        assert_eq!(slave.exit(), Status::Ok);
        slave.lines().len()
    };
    let (remark, discard, ok) = (c"logRemark", c"logStatusDiscard", Status::Ok);
    assert_eq!(remarks(&[], true), 1);
    assert_eq!(remarks(&[(false, &[], ok)], true), 0);
    assert_eq!(remarks(&[(true, &[], ok)], false), 1);
    assert_eq!(remarks(&[(false, &[discard], ok)], true), 1);
    assert_eq!(remarks(&[(false, &[remark], ok)], true), 0);
    assert_eq!(remarks(&[(false, &[], ok), (true, &[remark], ok)], true), 1);
    assert_eq!(remarks(&[(true, &[discard], ok)], false), 0);
    assert_eq!(remarks(&[(true, &[c"nothing", remark], Status::Warning)], false), 1);
}

#[test]
fn a_step_that_breaks_off_terminates_and_tells_when() {
    let slave = Slave::worn_pin(logging());
    assert_eq!(slave.set_integer("solver.max_evaluations", 2000), Status::Ok);
    slave.ready(false);
    let state = slave.save();
    assert_eq!(slave.try_step(0.0, 10.0), Err(Status::Error));
    let text = slave.line().text;
    assert!(text.contains("at t = 0.") && text.contains("max_evaluations"), "{text}");
    assert!(slave.get("slider.x").is_finite() && slave.time() >= 0.0);
    assert_eq!(slave.try_step(slave.time(), 1e-3), Err(Status::Error));
    assert!(slave.line().text.contains("'terminated'"));
    assert_eq!(slave.set_state(state), Status::Ok);
    slave.step(0.0, 1e-5);
}

#[test]
fn wrong_tokens_and_names_are_told() {
    let lines = Slave::try_new(Options::default(), c"{other}").err().expect("refused");
    assert!(lines.len() == 1 && lines[0].text.contains("{other}"), "{lines:?}");
}

#[test]
fn a_defined_stop_time_bounds_the_last_step() {
    let slave = Slave::new(logging());
    assert_eq!(slave.enter_with(None, 0.0, Some(1.0)), Status::Ok);
    assert_eq!(slave.exit(), Status::Ok);
    assert_eq!(slave.try_step(0.0, 1.5), Err(Status::Error));
    assert!(slave.line().text.contains("stopTime"));
    assert_eq!(slave.step(0.0, 1.0).time, 1.0);
}

#[test]
fn an_array_lies_among_scalars_with_all_its_values() {
    let slave = Slave::running(logging());
    let (references, mut values) = ([vr("slider.mass"), PENETRATIONS, vr("slider.x")], [f64::NAN; 6]);
    // SAFETY: live instance, arrays of the lengths said.
    let status = unsafe { fmi3GetFloat64(slave.0, references.as_ptr(), 3, values.as_mut_ptr(), 6) };
    assert_eq!(status, Status::Ok);
    // An ideal guide.
    assert_eq!(values, [0.14, 0.0, 0.0, 0.0, 0.0, slave.get("slider.x")]);
}
