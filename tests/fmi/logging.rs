//! The log: one line for trouble, to every importer; remarks to those who asked; silence otherwise.

use host::Slave;
use host::api::Api;
use host::log::variadic;
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
fn trouble_is_told_whatever_the_importer_chose() {
    let slave = Slave::of(Api::linked(), "quiet", false);
    // As hosts do that look at no status: the start value stays, and the user must hear of it.
    assert_eq!(slave.set("joint.C.clearance", 0.0), Status::Error);
    let line = slave.log.only();
    assert_eq!((line.instance.as_str(), line.status, line.category.as_str()), ("quiet", 3, "logStatusError"));
    assert!(line.text.contains("joint.C.clearance = 0 is out of range"), "{line:?}");
    for (on, names) in [(0, &[][..]), (0, &["logStatusError"]), (1, &["logStatusFatal"]), (1, &["logRemark"]), (1, &[])]
    {
        assert_eq!(choose(&slave, on, names), Status::Ok);
        trouble(&slave);
        assert_eq!(slave.log.only().category, "logStatusError", "{on} {names:?}");
    }
    // A warning, and a step that is discarded, in an instance without debug logging.
    assert_eq!(choose(&slave, 0, &[]), Status::Ok);
    assert_eq!(slave.setup_raw(1, 1e-30, 0.0, 0, 0.0), Status::Warning);
    assert_eq!(slave.log.only().category, "logStatusWarning");
    slave.wear();
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    assert_eq!(slave.set("slider.load", 1e308), Status::Ok);
    assert_eq!(slave.step(0.0, 1e-3), Status::Discard);
    assert_eq!(slave.log.only().category, "logStatusDiscard");
}

/// Lines of a call that has something to remark on, under a choice of categories.
fn remarks(on: i32, names: &[&str]) -> usize {
    let slave = Slave::new();
    choose(&slave, on, names);
    slave.log.take();
    assert_eq!(slave.set("solver.tolerance", 1e-7), Status::Ok);
    assert_eq!(slave.setup_raw(1, 1e-4, 0.0, 0, 0.0), Status::Ok);
    assert_eq!((slave.enter(), slave.exit()), (Status::Ok, Status::Ok));
    let lines = slave.log.take();
    assert!(lines.iter().all(|line| (line.status, line.category.as_str()) == (0, "logRemark")), "{lines:?}");
    let wanted = "fmi2ExitInitializationMode: the experiment's tolerance 0.0001 is left aside, since solver.tolerance = 1e-7 was set";
    assert!(lines.iter().all(|line| line.text == wanted), "{lines:?}");
    lines.len()
}

#[test]
fn remarks_are_for_those_who_asked() {
    for (on, names, lines) in [
        (1, &[][..], 1),
        (1, &["logRemark"], 1),
        (1, &["logAll"], 1),
        (1, &["logStatusError", "logRemark"], 1),
        (1, &["logStatusError"], 0),
        (1, &["nonsense"], 0),
        (1, &["nonsense", "logRemark"], 1),
        (0, &[], 0),
        (0, &["logRemark"], 0),
    ] {
        assert_eq!(remarks(on, names), lines, "{on} {names:?}");
    }
}

#[test]
fn every_declared_category_is_known_and_others_are_ignored_with_a_warning() {
    let slave = Slave::new();
    for category in LogCategory::ALL {
        assert_eq!(choose(&slave, 1, &[category.name()]), Status::Ok);
    }
    assert_eq!(slave.log.take(), []);
    for on in [0, 1] {
        assert_eq!(choose(&slave, on, &["logAll", "nonsense", "more", "still more"]), Status::Warning);
        let line = slave.log.only();
        assert_eq!((line.status, line.category.as_str()), (1, "logStatusWarning"));
        let wanted = "fmi2SetDebugLogging: log category 'nonsense' is not declared and is ignored, as are 2 others";
        assert_eq!(line.text, wanted);
    }
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
    let (api, guid) = (Api::linked(), host::guid());
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
