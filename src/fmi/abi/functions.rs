//! `fmi2*`: borrow, call, status. One function of the standard each.
//!
//! # Safety
//! Of all of them: a component is NULL or was made by `fmi2Instantiate` and not freed since; a
//! non-NULL pointer points to as many entries as the standard says, and a string ends in a zero byte.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]
#![allow(non_snake_case, reason = "the names are the standard's")]

pub mod co_simulation;
pub mod model_exchange;
pub mod states;
pub mod variables;

use super::super::error::{ArgumentError, Error};
use super::super::instance::{Instance, Request};
use super::super::lifecycle::Call;
use super::super::logger::Logger;
use super::super::status::Status;
use super::borrow::{slice, structure, text};
use super::call::{call, guarded};
use super::component::{give, take_back};
use super::host_logger::HostLogger;
use super::types::*;
use std::ffi::CString;
use std::ptr::null_mut;

/// "default": the types are those of the standard's header.
pub extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
    c"default".as_ptr()
}

/// Version of the standard.
pub extern "C" fn fmi2GetVersion() -> fmi2String {
    c"2.0".as_ptr()
}

/// Makes an instance; NULL, and one line in the log, if that cannot be.
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: fmi2String,
    fmu_type: fmi2Type,
    guid: fmi2String,
    resource_location: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    logging_on: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: the importer vouches for a non-null structure.
    let Ok(functions) = (unsafe { structure("functions", functions) }) else {
        // Not even a logger to complain to.
        return null_mut();
    };
    // SAFETY: the importer vouches for its logger and its strings.
    let request = unsafe {
        Request {
            name: text(instance_name),
            fmu_type,
            guid: text(guid),
            resource_location: text(resource_location),
            host: HostLogger::new(functions),
            logging_on: logging_on != FMI2_FALSE,
        }
    };
    guarded(|| instantiate(&request)).unwrap_or(null_mut())
}

fn instantiate(request: &Request<'_>) -> fmi2Component {
    let outcome = guarded(|| Instance::instantiate(request)).unwrap_or_else(|fault| Err(Error::Panic(fault)));
    match outcome {
        Ok(instance) => give(instance),
        Err(error) => {
            // Nobody is left to ask why, so this is said whether logging is on or not.
            let name = request.name.map(CString::from).unwrap_or_default();
            Logger::new(request.host, name, true).say(error.status(), Call::Instantiate, &error);
            null_mut()
        }
    }
}

/// Frees an instance with all that belongs to it; NULL is allowed.
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    // SAFETY: the importer vouches for `c` and gives it up.
    let instance = unsafe { take_back(c) };
    // What a panic in a destructor leaves behind is a leak at worst.
    let _ = guarded(|| drop(instance));
}

/// Chooses the log categories that the importer hears.
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    logging_on: fmi2Boolean,
    n_categories: usize,
    categories: *const fmi2String,
) -> Status {
    let set = |instance: &mut Instance| {
        // SAFETY: the importer vouches for the array and its strings.
        let names: Option<Vec<_>> = unsafe {
            let pointers = slice("categories", categories, n_categories)?;
            pointers.iter().map(|&pointer| text(pointer)).collect()
        };
        instance
            .set_debug_logging(logging_on != FMI2_FALSE, &names.ok_or(ArgumentError::Null("an entry of categories"))?)
    };
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetDebugLogging, set) }
}

/// Tells tolerance and times of the experiment.
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    tolerance_defined: fmi2Boolean,
    tolerance: fmi2Real,
    start_time: fmi2Real,
    stop_time_defined: fmi2Boolean,
    stop_time: fmi2Real,
) -> Status {
    let tolerance = (tolerance_defined != FMI2_FALSE).then_some(tolerance);
    let stop_time = (stop_time_defined != FMI2_FALSE).then_some(stop_time);
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::SetupExperiment, |instance| instance.setup_experiment(tolerance, start_time, stop_time)) }
}

/// From now on outputs follow start values.
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: fmi2Component) -> Status {
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::EnterInitializationMode, Instance::enter_initialization_mode) }
}

/// Fixes the parameters; the first step can follow.
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: fmi2Component) -> Status {
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::ExitInitializationMode, Instance::exit_initialization_mode) }
}

/// Ends the run; values can still be read.
pub unsafe extern "C" fn fmi2Terminate(c: fmi2Component) -> Status {
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::Terminate, Instance::terminate) }
}

/// Back to the state after instantiation.
pub unsafe extern "C" fn fmi2Reset(c: fmi2Component) -> Status {
    // SAFETY: the importer vouches for `c`.
    unsafe { call(c, Call::Reset, Instance::reset) }
}
