//! The log: one line for trouble, silence otherwise, and only to those who asked.

use crate::host::Slave;
use crate::host::api::Api;
use crate::host::log::variadic;
use slidercrank::fmi::slave::variables::LogCategory;
use slidercrank::fmi::v2::Status;
use std::ffi::CString;

fn choose(slave: &Slave, on: i32, names: &[&str]) -> Status {
    let names: Vec<_> = names.iter().map(|name| CString::new(*name).expect("no zero")).collect();
    let pointers: Vec<_> = names.iter().map(|name| name.as_ptr()).collect();
    // SAFETY: live component, array of the length said.
    unsafe { (slave.api.SetDebugLogging)(slave.c, on, pointers.len(), pointers.as_ptr()) }
}

/// A call that is refused.
fn trouble(slave: &Slave) {
    assert_eq!(slave.set("slider.x", 1.0), Status::Error);
}

#[test]
fn a_run_without_trouble_is_silent_with_logging_on() {
    let slave = Slave::running();
    slave.steps(0.0, 1e-3, 100);
    slave.picture();
    assert_eq!((slave.terminate(), slave.reset()), (Status::Ok, Status::Ok));
    assert_eq!(slave.log.take(), []);
}

#[test]
fn without_logging_nothing_is_said() {
    let slave = Slave::of(Api::linked(), "quiet", false);
    trouble(&slave);
    assert_eq!(slave.log.take(), []);
    assert_eq!(choose(&slave, 1, &[]), Status::Ok);
    trouble(&slave);
    assert_eq!(slave.log.only().instance, "quiet");
}

#[test]
fn only_chosen_categories_are_heard() {
    let slave = Slave::new();
    let heard = |slave: &Slave| {
        trouble(slave);
        slave.log.take().len()
    };
    for (on, names, lines) in [
        (1, &["logStatusWarning", "logStatusDiscard"][..], 0),
        (1, &["logStatusError"], 1),
        (1, &["logStatusFatal"], 0),
        (1, &["logAll"], 1),
        (0, &["logStatusError"], 0),
        (1, &[], 1),
        (0, &[], 0),
    ] {
        assert_eq!(choose(&slave, on, names), Status::Ok);
        assert_eq!(heard(&slave), lines, "{on} {names:?}");
    }
}

#[test]
fn every_declared_category_is_known_and_no_other() {
    let slave = Slave::new();
    for category in LogCategory::ALL {
        assert_eq!(choose(&slave, 1, &[category.name()]), Status::Ok);
    }
    assert_eq!(choose(&slave, 1, &["logStatusError"]), Status::Ok);
    assert_eq!(choose(&slave, 1, &["logAll", "nonsense"]), Status::Error);
    assert!(slave.log.only().text.contains("nonsense"));
    trouble(&slave);
    slave.log.only();
}

#[test]
fn a_line_names_call_variable_and_cause() {
    let slave = Slave::new();
    assert_eq!(slave.set("rod.length", -1.0), Status::Error);
    let line = slave.log.only();
    assert_eq!((line.instance.as_str(), line.status), ("slave", 3));
    assert_eq!(line.category, "logStatusError");
    assert!(line.text.starts_with("fmi2SetReal: rod.length = -1 is out of range; allowed: "), "{line:?}");
}

#[test]
fn a_logger_that_calls_back_is_refused() {
    use slidercrank::fmi::v2::abi::types::*;
    use std::ffi::{c_int, c_void};
    use std::sync::atomic::{AtomicPtr, Ordering};
    unsafe extern "C" fn call_back(e: *mut c_void, _: fmi2String, _: c_int, _: fmi2String, _: fmi2String) {
        // SAFETY: the environment is the atomic below.
        let component = unsafe { &*e.cast::<AtomicPtr<c_void>>() }.swap(std::ptr::null_mut(), Ordering::Relaxed);
        // SAFETY: NULL or a live component, which is not freed while a call is under way.
        unsafe {
            (Api::linked().FreeInstance)(component);
            assert_eq!((Api::linked().Reset)(component), Status::Error);
        }
    }
    let component = AtomicPtr::new(std::ptr::null_mut());
    let callbacks = fmi2CallbackFunctions {
        logger: Some(variadic(call_back)),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: (&raw const component).cast_mut().cast(),
    };
    let (api, guid) = (Api::linked(), crate::host::guid());
    // SAFETY: valid strings and callbacks, which outlive the instance.
    unsafe {
        let c = (api.Instantiate)(c"x".as_ptr(), 1, guid.as_ptr(), std::ptr::null(), &raw const callbacks, 0, 1);
        component.store(c, Ordering::Relaxed);
        assert_eq!((api.DoStep)(c, 0.0, 1.0, 1), Status::Error);
        assert!(component.load(Ordering::Relaxed).is_null(), "the logger was called");
        assert_eq!((api.EnterInitializationMode)(c), Status::Ok);
        (api.FreeInstance)(c);
    }
}
