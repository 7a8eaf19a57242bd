//! The C types of `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h`.
#![allow(non_camel_case_types, reason = "the names are the standard's")]

use std::ffi::{c_char, c_int, c_uint, c_void};

/// An instance of ours, opaque to the importer.
pub type fmi3Instance = *mut c_void;
/// The importer's own datum, opaque to us.
pub type fmi3InstanceEnvironment = *mut c_void;
/// A saved state of ours, opaque to the importer.
pub type fmi3FMUState = *mut c_void;
/// Number of a variable.
pub type fmi3ValueReference = c_uint;
/// A real number.
pub type fmi3Float64 = f64;
/// A shorter real number; no variable is one.
pub type fmi3Float32 = f32;
/// C's `bool`, taken as the byte that it is, since anything may come: 0 is false, everything else true.
pub type fmi3Boolean = u8;
/// UTF-8, ended by a zero byte.
pub type fmi3String = *const c_char;
/// Bytes; no variable has such.
pub type fmi3Binary = *const u8;
/// A byte of a serialized state.
pub type fmi3Byte = u8;
/// C's `bool`: whether a clock is active.
pub type fmi3Clock = u8;
/// What a call answers.
pub type fmi3Status = crate::fmi::status::Status;
/// Never answered.
pub type fmi3DependencyKind = c_int;
/// Never answered.
pub type fmi3IntervalQualifier = c_int;

/// Takes a message to the user.
pub type fmi3LogMessageCallback = unsafe extern "C" fn(
    instance_environment: fmi3InstanceEnvironment,
    status: c_int,
    category: fmi3String,
    message: fmi3String,
);
/// Called within a step.
pub type fmi3IntermediateUpdateCallback = unsafe extern "C" fn(
    instance_environment: fmi3InstanceEnvironment,
    intermediate_update_time: fmi3Float64,
    intermediate_variable_set_requested: fmi3Boolean,
    intermediate_variable_get_allowed: fmi3Boolean,
    intermediate_step_finished: fmi3Boolean,
    can_return_early: fmi3Boolean,
    early_return_requested: *mut fmi3Boolean,
    early_return_time: *mut fmi3Float64,
);
/// Of scheduled execution; never called.
pub type fmi3ClockUpdateCallback = unsafe extern "C" fn(instance_environment: fmi3InstanceEnvironment);
/// Of scheduled execution; never called.
pub type fmi3LockPreemptionCallback = unsafe extern "C" fn();
/// Of scheduled execution; never called.
pub type fmi3UnlockPreemptionCallback = unsafe extern "C" fn();
