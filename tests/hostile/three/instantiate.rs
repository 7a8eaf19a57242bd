//! Every combination of what the functions that make an instance can be given.

use crate::importer::Handle;
use host::{guid, vr};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::abi::types::*;
use std::cell::RefCell;
use std::ffi::{CStr, c_int, c_void};
use std::ptr::{null, null_mut};

/// A text and what is wrong with it.
type Text<'a> = (Option<&'a CStr>, Option<&'a str>);

const NAMES: [Text<'_>; 5] = [
    (Some(c"x"), None),
    (Some(c"\xff%s#n#"), None),
    (None, Some("instanceName")),
    (Some(c""), Some("instanceName")),
    (Some(c" \t"), Some("instanceName")),
];
const FLAGS: [u8; 3] = [0, 1, 255];

/// Lines of the log.
type Lines = RefCell<Vec<String>>;

unsafe extern "C" fn log(environment: *mut c_void, status: c_int, category: fmi3String, message: fmi3String) {
    // SAFETY: `try_with` passes lines as the environment, and the library passes strings.
    let (lines, texts) =
        unsafe { (&*environment.cast::<Lines>(), [category, message].map(|text| CStr::from_ptr(text))) };
    assert_eq!((status, texts[0]), (Status::Error as i32, c"logStatusError"));
    lines.borrow_mut().push(texts[1].to_str().expect("UTF-8").to_owned());
}

#[allow(clippy::too_many_arguments, reason = "the standard's")]
unsafe extern "C" fn update(_: *mut c_void, _: f64, _: u8, _: u8, _: u8, _: u8, _: *mut u8, _: *mut f64) {}

/// An array of references, its length, and what is wrong with it.
type References<'a> = (*const u32, usize, Option<&'a str>);

/// Whether there is an instance; if not, one line names one of the causes.
fn judge(instance: fmi3Instance, causes: &[Option<&str>], all: &Lines, function: &str, heard: bool) -> usize {
    let (causes, lines): (Vec<&str>, _) = (causes.iter().flatten().copied().collect(), all.take());
    assert_eq!(instance.is_null(), !causes.is_empty(), "{causes:?} {lines:?}");
    assert_eq!(lines.len(), usize::from(instance.is_null() && heard), "{causes:?} {lines:?}");
    for line in lines {
        assert!(line.starts_with(&format!("{function}: ")), "{line}");
        assert!(causes.iter().any(|cause| line.contains(cause)), "{line} for {causes:?}");
    }
    if instance.is_null() {
        return 0;
    }
    assert_eq!(Handle(instance).exit(), Status::Error);
    assert_eq!(all.take().len(), usize::from(heard));
    // SAFETY: live, and not used again.
    unsafe { fmi3FreeInstance(instance) };
    1
}

#[test]
fn there_is_an_instance_or_one_line_that_tells_why_not() {
    let (lines, right) = (Lines::default(), guid());
    let environment = (&raw const lines).cast_mut().cast::<c_void>();
    let tokens: [Text<'_>; 4] = [
        (Some(&right), None),
        (None, Some("instantiationToken is NULL")),
        (Some(c""), Some("instantiationToken ''")),
        (Some(c"\xfe\n%d"), Some("instantiationToken '")),
    ];
    let (sound, mass, unknown) = ([vr("slider.x"), vr("slider.load")], [vr("slider.mass")], [u32::MAX]);
    let odd = sound.as_ptr().cast::<u8>().wrapping_add(1).cast();
    let required: [References<'_>; 9] = [
        (null(), 0, None),
        (sound.as_ptr(), 2, None),
        (odd, 0, None),
        (null(), 5, Some("'requiredIntermediateVariables' is NULL")),
        (odd, 1, Some("'requiredIntermediateVariables' is not aligned")),
        (sound.as_ptr(), usize::MAX, Some("elements")),
        (sound.as_ptr(), 1 << 25, Some("elements")),
        (mass.as_ptr(), 1, Some("requiredIntermediateVariables is neither")),
        (unknown.as_ptr(), 1, Some("requiredIntermediateVariables is neither")),
    ];
    let pointer = |text: Option<&CStr>| text.map_or(null(), CStr::as_ptr);
    let callbacks = [Some(update as fmi3IntermediateUpdateCallback), None];
    let loggers = [Some(log as fmi3LogMessageCallback), None];
    let (mut made, mut exchanging) = (0, 0);
    for (name, no_name) in NAMES {
        for (token, no_token) in tokens {
            for (logger, logging, events) in loggers
                .iter()
                .flat_map(|logger| FLAGS.map(|logging| (*logger, logging, FLAGS[2 - usize::from(logging.min(2))])))
            {
                let (name, token) = (pointer(name), pointer(token));
                for (references, count, no_references) in required {
                    for callback in callbacks {
                        let no_callback = (count > 0 && callback.is_none()).then_some("intermediateUpdate is NULL");
                        // SAFETY: strings and callbacks are valid or NULL, arrays as long as told or refused.
                        let instance = unsafe {
                            fmi3InstantiateCoSimulation(
                                name,
                                token,
                                name,
                                1,
                                logging,
                                events,
                                logging,
                                references,
                                count,
                                environment,
                                logger,
                                callback,
                            )
                        };
                        let causes = [no_name, no_token, no_references, no_callback];
                        made += judge(instance, &causes, &lines, "fmi3InstantiateCoSimulation", logger.is_some());
                    }
                }
                // SAFETY: strings and callback are valid or NULL.
                let instance =
                    unsafe { fmi3InstantiateModelExchange(name, token, name, 255, logging, environment, logger) };
                exchanging +=
                    judge(instance, &[no_name, no_token], &lines, "fmi3InstantiateModelExchange", logger.is_some());
                // SAFETY: as above.
                let instance = unsafe {
                    fmi3InstantiateScheduledExecution(
                        name,
                        token,
                        name,
                        1,
                        logging,
                        environment,
                        logger,
                        None,
                        None,
                        None,
                    )
                };
                let cause = [Some("scheduled execution")];
                judge(instance, &cause, &lines, "fmi3InstantiateScheduledExecution", logger.is_some());
            }
        }
    }
    // Two names that are right, one token, two loggers, three flags; three lists, of which one needs a callback.
    assert_eq!((made, exchanging), (2 * 2 * 3 * 5, 2 * 2 * 3));
    // SAFETY: NULL is allowed.
    unsafe { fmi3FreeInstance(null_mut()) };
}
