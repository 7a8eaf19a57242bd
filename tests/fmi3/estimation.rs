//! The functions for estimators do what they do in FMI 2.0, whose tests look at what that is.

use crate::importer::{Callback, Handle, Options, Slave, vr};
use slidercrank::fmi::v2::abi::estimation::bodies as v2;
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::estimation::bodies::*;
use std::cell::RefCell;
use std::ffi::c_void;
use std::ptr::{null, null_mut};
use std::rc::Rc;

/// [s] 0.03 crank turns.
const STEP: f64 = 1.0 / 4096.0;
const STEPS: usize = 12;
const PARAMETERS: [&str; 2] = ["joint.C.clearance", "crank.torque"];
const OUTPUTS: [&str; 2] = ["slider.x", "slider.v"];
/// What no call writes.
const UNTOUCHED: f64 = -7.0;

/// `step_jacobian` of either version: their types are the same but for the names.
type StepJacobian = unsafe extern "C" fn(
    *mut c_void,
    f64,
    *const u32,
    usize,
    *const u32,
    usize,
    *mut usize,
    *mut f64,
    *mut f64,
    *mut f64,
    *mut f64,
    *mut f64,
    *mut f64,
    *mut f64,
) -> Status;

/// The number of a phase's numbers, then all arrays of a call.
fn mapped(step_jacobian: StepJacobian, instance: *mut c_void) -> Result<Vec<Vec<f64>>, Status> {
    let (parameters, outputs) = (PARAMETERS.map(vr), OUTPUTS.map(vr));
    let mut count = 0;
    let call = |count: &mut usize, arrays: [*mut f64; 7]| {
        let [phase, next, values, by_phase, by_others, values_by_phase, values_by_others] = arrays;
        // SAFETY: live instance, arrays of the lengths said or NULL for the phase, which asks for their number alone.
        let status = unsafe {
            step_jacobian(
                instance,
                STEP,
                parameters.as_ptr(),
                parameters.len(),
                outputs.as_ptr(),
                outputs.len(),
                count,
                phase,
                next,
                values,
                by_phase,
                by_others,
                values_by_phase,
                values_by_others,
            )
        };
        if status == Status::Ok { Ok(()) } else { Err(status) }
    };
    call(&mut count, [null_mut(); 7])?;
    let (by, of) = (parameters.len(), outputs.len());
    let lengths = [count, count, of, count * count, count * by, of * count, of * by];
    let mut arrays = lengths.map(|length| vec![UNTOUCHED; length]);
    call(&mut count, arrays.each_mut().map(|array| array.as_mut_ptr()))?;
    Ok(arrays.into())
}

fn names(instance: *mut c_void) -> String {
    let mut size = 0;
    // SAFETY: live instance, one place.
    assert_eq!(unsafe { slidercrank_fmi3_phase_names(instance, null_mut(), &raw mut size) }, Status::Ok);
    let mut bytes = vec![1_u8; size];
    // SAFETY: live instance, a buffer of the length said.
    assert_eq!(unsafe { slidercrank_fmi3_phase_names(instance, bytes.as_mut_ptr().cast(), &raw mut size) }, Status::Ok);
    assert_eq!(bytes.pop(), Some(0));
    String::from_utf8(bytes).expect("text")
}

#[test]
fn a_step_has_the_map_and_the_jacobian_that_it_has_in_fmi_2() {
    let other = host::Slave::running();
    other.steps(0.0, STEP, STEPS);
    let wanted = mapped(v2::slidercrank_step_jacobian, other.c).expect("a Jacobian");
    assert!(wanted.iter().flatten().all(|value| value.is_finite() && *value != UNTOUCHED));
    for options in [Options::default(), Options::EVENTS] {
        let slave = Slave::running(options);
        slave.run(0.0, STEP, STEP * STEPS as f64);
        let before = slave.picture();
        let found = mapped(slidercrank_fmi3_step_jacobian, slave.0).expect("a Jacobian");
        assert_eq!(found, wanted);
        assert_eq!(slave.picture(), before);
        assert_eq!(names(slave.0).lines().count(), found[0].len());
    }
}

#[test]
fn a_phase_that_is_set_leads_where_it_leads_in_fmi_2() {
    let (other, slave) = (host::Slave::running(), Slave::running(Options::EVENTS));
    other.steps(0.0, STEP, STEPS);
    let point = STEP * STEPS as f64;
    slave.run(0.0, STEP, point);
    let mut phase = mapped(slidercrank_fmi3_step_jacobian, slave.0).expect("a Jacobian").swap_remove(0);
    phase.iter_mut().for_each(|number| *number *= 1.0 + 1e-6);
    let (clearance, wider) = (vr("joint.C.clearance"), 1.001 * slave.get("joint.C.clearance"));
    // SAFETY: live instances, arrays of the lengths said.
    let set = unsafe {
        [
            v2::slidercrank_set_phase(other.c, phase.as_ptr(), phase.len(), &clearance, 1, &wider),
            slidercrank_fmi3_set_phase(slave.0, phase.as_ptr(), phase.len(), &clearance, 1, &wider),
        ]
    };
    assert_eq!(set, [Status::Ok; 2]);
    let wanted = mapped(v2::slidercrank_step_jacobian, other.c).expect("a Jacobian");
    assert_eq!(wanted[0], phase);
    assert_eq!(mapped(slidercrank_fmi3_step_jacobian, slave.0).expect("a Jacobian"), wanted);
    other.steps(point, STEP, 1);
    slave.run(point, STEP, point + STEP);
    assert_eq!(OUTPUTS.map(|name| slave.get(name)), OUTPUTS.map(|name| other.get(name)));
    assert_eq!(OUTPUTS.map(|name| slave.get(name)), wanted[2][..]);
}

/// All three calls are refused, and the log names them.
fn assert_refused(instance: *mut c_void, lines: impl Fn() -> Vec<String>, word: &str) {
    let mut size = 7;
    // SAFETY: live instance, one place, empty arrays.
    let status = unsafe {
        [
            slidercrank_fmi3_phase_names(instance, null_mut(), &raw mut size),
            slidercrank_fmi3_set_phase(instance, null(), 0, null(), 0, null()),
            mapped(slidercrank_fmi3_step_jacobian, instance).err().unwrap_or(Status::Ok),
        ]
    };
    assert_eq!((status, size), ([Status::Error; 3], 7));
    let (lines, names) = (lines(), ["phase_names", "set_phase", "step_jacobian"]);
    assert_eq!(lines.len(), names.len(), "{lines:?}");
    for (line, name) in lines.iter().zip(names) {
        assert!(line.starts_with(&format!("slidercrank_fmi3_{name}")) && line.contains(word), "{line}");
    }
}

#[test]
fn they_are_refused_where_steps_are() {
    let told = |slave: &Slave| slave.lines().into_iter().map(|line| line.text).collect();
    let slave = Slave::worn_pin(Options::EVENTS);
    assert_refused(slave.0, || told(&slave), "initialization mode");
    assert_eq!(slave.exit(), Status::Ok);
    assert_refused(slave.0, || told(&slave), "event mode");
    slave.handle_event();
    let mut point = 0.0;
    while !slave.step(point, STEP).event {
        point += STEP;
    }
    slave.lines();
    assert_refused(slave.0, || told(&slave), "event");
    let model = Slave::exchanging();
    assert_refused(model.0, || told(&model), "co-simulation");
    // SAFETY: NULL is refused.
    assert_eq!(unsafe { slidercrank_fmi3_set_phase(null_mut(), null(), 0, null(), 0, null()) }, Status::Error);
}

#[test]
fn they_are_refused_within_an_intermediate_update() {
    let statuses = Rc::new(RefCell::new(vec![]));
    let seen = Rc::clone(&statuses);
    let update: Callback = Box::new(move |slave: &Handle, _, _| {
        seen.borrow_mut().push(mapped(slidercrank_fmi3_step_jacobian, slave.0));
        None
    });
    let slave = Slave::running(Options { update: Some(update), ..Options::default() });
    slave.run(0.0, STEP, STEP);
    let statuses = statuses.take();
    assert!(!statuses.is_empty() && statuses.iter().all(|status| *status == Err(Status::Error)), "{statuses:?}");
}
