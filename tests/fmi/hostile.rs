//! Null, misaligned, too long, not a number, unknown: refused with one line, and nothing changed.

use crate::host::{Slave, vr};
use slidercrank::fmi::Status;
use std::ptr::{null, null_mut};

const HUGE: [usize; 3] = [usize::MAX, usize::MAX / 8, 1 << 40];

/// The call was refused with one line that has these words.
fn refused(slave: &Slave, status: Status, words: &[&str]) {
    let line = slave.log.only();
    assert_eq!((status, line.status), (Status::Error, 3), "{line:?}");
    assert_eq!(line.category, "logStatusError");
    for word in words {
        assert!(line.text.contains(word), "'{word}' in {line:?}");
    }
}

#[test]
fn null_arrays_are_refused_and_empty_ones_are_not_looked_at() {
    let slave = Slave::running();
    let (api, c, x, mut value) = (slave.api, slave.c, vr("slider.x"), 0.0);
    // SAFETY: live component; NULL and misaligned pointers are refused before anybody follows them.
    unsafe {
        refused(&slave, (api.GetReal)(c, null(), 1, &mut value), &["fmi2GetReal", "'vr'", "NULL"]);
        refused(&slave, (api.GetReal)(c, &x, 1, null_mut()), &["'value'", "NULL"]);
        refused(&slave, (api.SetReal)(c, &vr("slider.load"), 1, null()), &["'value'", "NULL"]);
        refused(&slave, (api.SetInteger)(c, null(), 3, &1), &["'vr'", "NULL"]);
        refused(&slave, (api.GetFMUstate)(c, null_mut()), &["FMUstate", "NULL"]);
        refused(&slave, (api.SetFMUstate)(c, null_mut()), &["FMUstate", "NULL"]);
        refused(&slave, (api.DeSerializeFMUstate)(c, null(), 9, &mut null_mut()), &["NULL"]);
        refused(&slave, (api.GetStatus)(c, 0, null_mut()), &["value", "NULL"]);
        refused(&slave, (api.SetDebugLogging)(c, 1, 1, null()), &["categories", "NULL"]);
        refused(&slave, (api.SetDebugLogging)(c, 1, 1, &null()), &["categories", "NULL"]);
        refused(&slave, (api.SetRealInputDerivatives)(c, &x, 1, null(), &1.0), &["order", "NULL"]);
        let odd = (&raw mut value).cast::<u8>().wrapping_add(1).cast::<f64>();
        refused(&slave, (api.GetReal)(c, &x, 1, odd), &["'value'", "aligned"]);
        assert_eq!((api.GetReal)(c, null(), 0, null_mut()), Status::Ok);
        assert_eq!((api.SetReal)(c, null(), 0, null()), Status::Ok);
        assert_eq!((api.GetString)(c, null(), 0, null_mut()), Status::Ok);
        assert_eq!((api.SetString)(c, null(), 0, null()), Status::Ok);
        assert_eq!((api.FreeFMUstate)(c, null_mut()), Status::Ok);
        assert_eq!((api.FreeFMUstate)(c, &mut null_mut()), Status::Ok);
    }
    assert_eq!(slave.log.take(), []);
}

#[test]
fn lengths_that_no_call_has_are_refused() {
    let slave = Slave::running();
    let (api, c, x, mut value) = (slave.api, slave.c, vr("slider.x"), 0.0);
    for length in HUGE {
        // SAFETY: live component; the length is refused before anybody goes so far.
        unsafe {
            refused(&slave, (api.GetReal)(c, &x, length, &mut value), &["elements"]);
            refused(&slave, (api.SetReal)(c, &x, length, &value), &["elements"]);
            refused(&slave, (api.SetDebugLogging)(c, 1, length, &null()), &["elements"]);
            let bytes = [0_u8];
            let read = (api.DeSerializeFMUstate)(c, bytes.as_ptr().cast(), length, &mut null_mut());
            refused(&slave, read, &["elements"]);
        }
    }
}

#[test]
fn unknown_references_and_other_types_are_named() {
    let slave = Slave::running();
    let (api, c) = (slave.api, slave.c);
    let (mut real, mut integer) = (0.0, 0);
    for reference in [u32::MAX, 100_000] {
        // SAFETY: live component, arrays of one entry.
        let get = unsafe { (api.GetReal)(c, &reference, 1, &mut real) };
        refused(&slave, get, &["fmi2GetReal", &reference.to_string()]);
        refused(&slave, slave.set_all(&[reference], &[1.0]), &[&reference.to_string()]);
    }
    // SAFETY: live component, arrays of one entry.
    unsafe {
        refused(&slave, (api.GetInteger)(c, &vr("slider.x"), 1, &mut integer), &["slider.x", "Real"]);
        refused(&slave, (api.GetReal)(c, &vr("solver.steps"), 1, &mut real), &["solver.steps", "Integer"]);
        refused(&slave, (api.GetReal)(c, &vr("joint.C.contact"), 1, &mut real), &["joint.C.contact", "Boolean"]);
        refused(&slave, (api.GetBoolean)(c, &vr("drive.mode"), 1, &mut integer), &["drive.mode"]);
        refused(&slave, (api.SetBoolean)(c, &vr("slider.load"), 1, &1), &["slider.load", "Real"]);
        refused(&slave, (api.GetString)(c, &vr("slider.x"), 1, &mut null()), &["slider.x", "String"]);
        refused(&slave, (api.SetString)(c, &vr("slider.x"), 1, &null()), &["slider.x", "String"]);
        refused(&slave, (api.SetString)(c, &9999, 1, &null()), &["9999"]);
    }
}

#[test]
fn what_is_not_a_number_is_refused_everywhere() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let slave = Slave::new();
        refused(&slave, slave.set("slider.load", value), &["slider.load", "finite"]);
        refused(&slave, slave.set("rod.length", value), &["rod.length", "finite"]);
        refused(&slave, slave.setup_raw(1, value, 0.0, 0, 0.0), &["tolerance"]);
        refused(&slave, slave.setup_raw(0, 0.0, value, 0, 0.0), &["startTime"]);
        refused(&slave, slave.setup_raw(0, 0.0, 0.0, 1, value), &["stopTime"]);
        assert_eq!(slave.setup_raw(0, value, 0.0, 0, value), Status::Ok);
        assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
        refused(&slave, slave.set("crank.torque", value), &["crank.torque", "finite"]);
        refused(&slave, slave.set_rate("crank.torque", 1, value), &["crank.torque", "finite"]);
        refused(&slave, slave.step(0.0, value), &["communicationStepSize"]);
        refused(&slave, slave.step(value, 1e-3), &["currentCommunicationPoint"]);
        assert_eq!(slave.sensitivity("slider.a", "slider.load", value), Err(Status::Error));
        refused(&slave, Status::Error, &["slider.load", "finite"]);
        assert_eq!(slave.step(0.0, 1e-3), Status::Ok);
    }
}

#[test]
fn made_up_states_are_refused() {
    let (slave, other) = (Slave::running(), Slave::running());
    let (mut mine, theirs) = (slave.save(), other.save());
    let stale = mine;
    assert_eq!(slave.free(&mut mine), Status::Ok);
    assert!(mine.is_null());
    for mut state in [theirs, stale, std::ptr::without_provenance_mut(0x1234)] {
        refused(&slave, slave.set_state(state), &["FMUstate"]);
        refused(&slave, slave.free(&mut state), &["FMUstate"]);
        refused(&slave, slave.save_into(&mut state), &["FMUstate"]);
    }
    assert_eq!(other.set_state(theirs), Status::Ok);
}

#[test]
fn a_number_that_is_no_status_kind_is_refused() {
    let slave = Slave::running();
    for kind in [-1, 4, i32::MAX] {
        // SAFETY: live component, one place.
        let status = unsafe { (slave.api.GetRealStatus)(slave.c, kind, &mut 0.0) };
        refused(&slave, status, &["fmi2StatusKind"]);
    }
}
