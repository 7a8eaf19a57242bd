//! C interface to the equations of motion of a scene, for integrators written elsewhere. The
//! declarations are in `equations.h`; the lengths of all arrays are what `equations_states` and
//! `equations_guards` return.
//!
//! The only unsafe code of the peers. A panic ends the process: nothing here is part of the FMU.
#![allow(unsafe_code)]

use slidercrank::model::signals::Inputs;
use slidercrank::scene::parameter::Parameter;
use slidercrank::scene::read::read;
use slidercrank::simulation::System;
use std::ffi::{CStr, c_char};
use std::fs;

/// Opens the scene in `file`, its inputs held at what they are at the start; null, and why on standard
/// error, if it cannot be used.
///
/// # Safety
/// `file` is a string that ends in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_open(file: *const c_char) -> *mut System {
    // SAFETY: the caller vouches for the string.
    let file = unsafe { CStr::from_ptr(file) }.to_string_lossy();
    match open(&file) {
        Ok(system) => Box::into_raw(Box::new(system)),
        Err(why) => {
            eprintln!("{file}: {why}");
            std::ptr::null_mut()
        }
    }
}

fn open(file: &str) -> Result<System, String> {
    let text = fs::read_to_string(file).map_err(|error| error.to_string())?;
    let scene = read(&text, file).map_err(|error| error.to_string())?;
    System::start(&scene.scene, Inputs::at_start(&scene)).map_err(|error| error.to_string())
}

/// Closes what `equations_open` returned.
///
/// # Safety
/// `system` is from `equations_open`, not null, and not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_close(system: *mut System) {
    // SAFETY: made by Box::into_raw in `equations_open`, and closed once.
    drop(unsafe { Box::from_raw(system) });
}

/// Number of positions.
///
/// # Safety
/// `system` is from `equations_open` and open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_positions(system: *const System) -> usize {
    // SAFETY: an open system; the caller uses it in one thread.
    unsafe { &*system }.size().degrees_of_freedom
}

/// Number of states.
///
/// # Safety
/// `system` is from `equations_open` and open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_states(system: *const System) -> usize {
    // SAFETY: an open system; the caller uses it in one thread.
    unsafe { &*system }.size().states
}

/// Number of event functions.
///
/// # Safety
/// `system` is from `equations_open` and open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_guards(system: *const System) -> usize {
    // SAFETY: an open system; the caller uses it in one thread.
    unsafe { &*system }.size().event_functions
}

/// [s] No step of our own is longer.
///
/// # Safety
/// `system` is from `equations_open` and open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_longest_step(system: *const System) -> f64 {
    // SAFETY: an open system; the caller uses it in one thread.
    unsafe { &*system }.longest_step()
}

/// Writes the start state, and takes the contacts of the start.
///
/// # Safety
/// `system` is from `equations_open` and open; `y` has room for the states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_start(system: *mut System, y: *mut f64) {
    // SAFETY: an open system that the caller uses in one thread; `y` has room.
    let (system, y) = unsafe { (&mut *system, states_mut(system, y)) };
    system.restart();
    system.write_start(y);
}

/// Writes the absolute weights of the error norm over the tolerance.
///
/// # Safety
/// `system` is from `equations_open` and open; `scales` has room for the states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_scales(system: *const System, scales: *mut f64) {
    // SAFETY: an open system that the caller uses in one thread; `scales` has room.
    let (system, scales) = unsafe { (&*system, states_mut(system, scales)) };
    system.write_scales(scales);
}

/// Writes the rates of the state `y` at `t` [s].
///
/// # Safety
/// `system` is from `equations_open` and open; `y` holds the states and `rates` has room for them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_rates(system: *const System, t: f64, y: *const f64, rates: *mut f64) {
    // SAFETY: an open system that the caller uses in one thread; `y` and `rates` are two arrays of the states.
    let (system, y, rates) = unsafe { (&*system, states(system, y), states_mut(system, rates)) };
    system.write_rates(t, y, rates);
}

/// Writes the event functions of the state `y` at `t` [s]. An event happens when one falls through zero.
///
/// # Safety
/// `system` is from `equations_open` and open; `y` holds the states and `functions` has room for the event
/// functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_event_functions(system: *const System, t: f64, y: *const f64, functions: *mut f64) {
    // SAFETY: an open system that the caller uses in one thread; `y` holds the states.
    let (system, y) = unsafe { (&*system, states(system, y)) };
    let count = system.size().event_functions;
    // SAFETY: `functions` has room for so many.
    system.write_event_functions(t, y, unsafe { std::slice::from_raw_parts_mut(functions, count) });
}

/// Opens or closes contacts: those whose `crossed` is not 0, and all others at or below zero and falling.
///
/// # Safety
/// `system` is from `equations_open` and open; `y` holds the states, `crossed` a number for each event
/// function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_cross(system: *mut System, t: f64, y: *mut f64, crossed: *const i32) {
    // SAFETY: an open system that the caller uses in one thread; `y` holds the states.
    let (system, y) = unsafe { (&mut *system, states_mut(system, y)) };
    let count = system.size().event_functions;
    // SAFETY: `crossed` holds so many.
    let crossed = unsafe { std::slice::from_raw_parts(crossed, count) };
    let mut flags = [false; slidercrank::integrator::MAX_EVENTS];
    for (flag, crossed) in flags.iter_mut().zip(crossed) {
        *flag = *crossed != 0;
    }
    system.cross(t, y, &flags);
}

/// Value of the parameter `name` of the scene in `file`, in SI units; not a number if there is none.
///
/// # Safety
/// `file` and `name` are strings that end in a null byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn equations_parameter(file: *const c_char, name: *const c_char) -> f64 {
    // SAFETY: the caller vouches for the strings.
    let [file, name] = unsafe { [CStr::from_ptr(file), CStr::from_ptr(name)] }.map(CStr::to_string_lossy);
    let scene = fs::read_to_string(&*file).ok().and_then(|text| read(&text, &file).ok());
    scene.zip(Parameter::named(&name)).map_or(f64::NAN, |(file, parameter)| parameter.value(&file.scene))
}

/// # Safety
/// `system` is open, and `y` holds its states for as long as the slice is used.
unsafe fn states<'a>(system: *const System, y: *const f64) -> &'a [f64] {
    // SAFETY: as said above.
    unsafe { std::slice::from_raw_parts(y, (*system).size().states) }
}

/// # Safety
/// `system` is open, and `y` has room for its states for as long as the slice is used, by nobody else.
unsafe fn states_mut<'a>(system: *const System, y: *mut f64) -> &'a mut [f64] {
    // SAFETY: as said above.
    unsafe { std::slice::from_raw_parts_mut(y, (*system).size().states) }
}
