//! The C types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`, platform "default".
#![allow(non_camel_case_types, reason = "the names are the standard's")]

use crate::fmi::abi::borrow::AnyBits;
use crate::simulation::Update;
use std::ffi::{c_char, c_int, c_uint, c_void};

/// An instance, opaque to the importer.
pub type fmi2Component = *mut c_void;
/// A pointer of the importer, opaque to this library.
pub type fmi2ComponentEnvironment = *mut c_void;
/// A saved state, opaque to the importer.
pub type fmi2FMUstate = *mut c_void;
/// Value reference of a variable.
pub type fmi2ValueReference = c_uint;
/// A real number.
pub type fmi2Real = f64;
/// An integer or the value of an enumeration.
pub type fmi2Integer = c_int;
/// 0 is false, everything else true.
pub type fmi2Boolean = c_int;
/// A null-terminated UTF-8 string.
pub type fmi2String = *const c_char;
/// A byte of a serialized state.
pub type fmi2Byte = c_char;
/// Status of a call.
pub type fmi2Status = crate::fmi::status::Status;
/// `fmi2ModelExchange` = 0, `fmi2CoSimulation` = 1. An integer, since the importer may pass any value.
pub type fmi2Type = c_int;
/// Kind of status. An integer, since the importer may pass any value.
pub type fmi2StatusKind = c_int;

/// `fmi2True`.
pub const FMI2_TRUE: fmi2Boolean = 1;
/// `fmi2False`.
pub const FMI2_FALSE: fmi2Boolean = 0;
/// `fmi2ModelExchange`.
pub const FMI2_MODEL_EXCHANGE: fmi2Type = super::super::instance::MODEL_EXCHANGE;
/// `fmi2CoSimulation`.
pub const FMI2_CO_SIMULATION: fmi2Type = super::super::instance::CO_SIMULATION;

/// Receives a message.
pub type fmi2CallbackLogger = unsafe extern "C" fn(
    component_environment: fmi2ComponentEnvironment,
    instance_name: fmi2String,
    status: c_int,
    category: fmi2String,
    message: fmi2String,
    ...
);
/// The importer's `calloc`, which this library does not use.
pub type fmi2CallbackAllocateMemory = unsafe extern "C" fn(count: usize, size: usize) -> *mut c_void;
/// The importer's `free`, which this library does not use.
pub type fmi2CallbackFreeMemory = unsafe extern "C" fn(memory: *mut c_void);
/// Called at the end of an asynchronous step, which this library does not have.
pub type fmi2StepFinished = unsafe extern "C" fn(environment: fmi2ComponentEnvironment, status: c_int);

/// The importer's callbacks. Every function may be NULL.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct fmi2CallbackFunctions {
    /// Receives messages.
    pub logger: Option<fmi2CallbackLogger>,
    /// Unused.
    pub allocate_memory: Option<fmi2CallbackAllocateMemory>,
    /// Unused.
    pub free_memory: Option<fmi2CallbackFreeMemory>,
    /// Unused.
    pub step_finished: Option<fmi2StepFinished>,
    /// Passed to the logger.
    pub component_environment: fmi2ComponentEnvironment,
}

/// Results of an event.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the names are the standard's")]
pub struct fmi2EventInfo {
    pub new_discrete_states_needed: fmi2Boolean,
    pub terminate_simulation: fmi2Boolean,
    pub nominals_of_continuous_states_changed: fmi2Boolean,
    pub values_of_continuous_states_changed: fmi2Boolean,
    pub next_event_time_defined: fmi2Boolean,
    pub next_event_time: fmi2Real,
}

/// One iteration is enough, nominal values stay, and no event is known in advance.
impl From<Update> for fmi2EventInfo {
    fn from(Update { states_changed, dead_end }: Update) -> Self {
        Self {
            new_discrete_states_needed: FMI2_FALSE,
            terminate_simulation: dead_end.into(),
            nominals_of_continuous_states_changed: FMI2_FALSE,
            values_of_continuous_states_changed: states_changed.into(),
            next_event_time_defined: FMI2_FALSE,
            next_event_time: 0.0,
        }
    }
}

// SAFETY: integers and a floating-point number.
unsafe impl AnyBits for fmi2EventInfo {}
