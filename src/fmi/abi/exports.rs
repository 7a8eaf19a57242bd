//! What the library exports: the functions of the standard, and nothing else. Each is that of this library or, where the
//! processor and the package have better, that of the [`newer`] one, the same for all calls of a process.
//!
//! # Safety
//! Of all of them: as of the [`functions`] of the same names.
#![allow(clippy::missing_safety_doc, reason = "said above, once")]

use super::super::status::Status;
use super::call::guarded;
use super::functions::{self, co_simulation, model_exchange, states, variables};
use super::newer;
use super::types::*;
use std::mem::transmute;
use std::sync::OnceLock;

/// The functions in use. They are chosen once, when the first of them is called, and never again.
static FACE: OnceLock<Face> = OnceLock::new();

/// Declares a table of functions, that of this library, and exports that call the one in use.
macro_rules! face {
    ($($module:ident::$name:ident($($argument:ident: $type:ty),*) -> $result:ty;)+) => {
        /// All functions of the standard by their names.
        #[allow(non_snake_case, reason = "the names are the standard's")]
        struct Face {
            $($name: unsafe extern "C" fn($($type),*) -> $result,)+
        }

        impl Face {
            /// Of this library.
            const OWN: Self = Self { $($name: $module::$name,)+ };

            /// Of another build of it, if it has them all.
            fn of(library: &newer::Library) -> Option<Self> {
                Some(Self {
                    $($name: {
                        let found = library.find(stringify!($name))?;
                        // SAFETY: built from the same sources, it has a function of this type under this name.
                        unsafe { transmute::<*const (), unsafe extern "C" fn($($type),*) -> $result>(found) }
                    },)+
                })
            }
        }

        $(
            #[doc = concat!("`", stringify!($name), "`, as chosen.")]
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name($($argument: $type),*) -> $result {
                // SAFETY: passed on; every component was made by the same library.
                unsafe { (face().$name)($($argument),*) }
            }
        )+
    };
}

fn face() -> &'static Face {
    let choose = || newer::open().and_then(|library| Face::of(&library));
    FACE.get_or_init(|| guarded(choose).ok().flatten().unwrap_or(Face::OWN))
}

face! {
    functions::fmi2GetTypesPlatform() -> fmi2String;
    functions::fmi2GetVersion() -> fmi2String;
    functions::fmi2Instantiate(instance_name: fmi2String, fmu_type: fmi2Type, guid: fmi2String, resource_location: fmi2String, functions: *const fmi2CallbackFunctions, visible: fmi2Boolean, logging_on: fmi2Boolean) -> fmi2Component;
    functions::fmi2FreeInstance(c: fmi2Component) -> ();
    functions::fmi2SetDebugLogging(c: fmi2Component, logging_on: fmi2Boolean, n_categories: usize, categories: *const fmi2String) -> Status;
    functions::fmi2SetupExperiment(c: fmi2Component, tolerance_defined: fmi2Boolean, tolerance: fmi2Real, start_time: fmi2Real, stop_time_defined: fmi2Boolean, stop_time: fmi2Real) -> Status;
    functions::fmi2EnterInitializationMode(c: fmi2Component) -> Status;
    functions::fmi2ExitInitializationMode(c: fmi2Component) -> Status;
    functions::fmi2Terminate(c: fmi2Component) -> Status;
    functions::fmi2Reset(c: fmi2Component) -> Status;
    co_simulation::fmi2DoStep(c: fmi2Component, current_communication_point: fmi2Real, communication_step_size: fmi2Real, no_set_fmu_state_prior_to_current_point: fmi2Boolean) -> Status;
    co_simulation::fmi2CancelStep(c: fmi2Component) -> Status;
    co_simulation::fmi2GetStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut i32) -> Status;
    co_simulation::fmi2GetRealStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Real) -> Status;
    co_simulation::fmi2GetIntegerStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Integer) -> Status;
    co_simulation::fmi2GetBooleanStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Boolean) -> Status;
    co_simulation::fmi2GetStringStatus(c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2String) -> Status;
    variables::fmi2GetReal(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Real) -> Status;
    variables::fmi2SetReal(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Real) -> Status;
    variables::fmi2GetInteger(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Integer) -> Status;
    variables::fmi2SetInteger(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Integer) -> Status;
    variables::fmi2GetBoolean(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2Boolean) -> Status;
    variables::fmi2SetBoolean(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2Boolean) -> Status;
    variables::fmi2GetString(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut fmi2String) -> Status;
    variables::fmi2SetString(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const fmi2String) -> Status;
    variables::fmi2GetDirectionalDerivative(c: fmi2Component, unknown: *const fmi2ValueReference, n_unknown: usize, known: *const fmi2ValueReference, n_known: usize, dv_known: *const fmi2Real, dv_unknown: *mut fmi2Real) -> Status;
    variables::fmi2SetRealInputDerivatives(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer, value: *const fmi2Real) -> Status;
    variables::fmi2GetRealOutputDerivatives(c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, order: *const fmi2Integer, value: *mut fmi2Real) -> Status;
    model_exchange::fmi2EnterEventMode(c: fmi2Component) -> Status;
    model_exchange::fmi2NewDiscreteStates(c: fmi2Component, event_info: *mut fmi2EventInfo) -> Status;
    model_exchange::fmi2EnterContinuousTimeMode(c: fmi2Component) -> Status;
    model_exchange::fmi2CompletedIntegratorStep(c: fmi2Component, no_set_fmu_state_prior_to_current_point: fmi2Boolean, enter_event_mode: *mut fmi2Boolean, terminate_simulation: *mut fmi2Boolean) -> Status;
    model_exchange::fmi2SetTime(c: fmi2Component, time: fmi2Real) -> Status;
    model_exchange::fmi2SetContinuousStates(c: fmi2Component, x: *const fmi2Real, nx: usize) -> Status;
    model_exchange::fmi2GetDerivatives(c: fmi2Component, derivatives: *mut fmi2Real, nx: usize) -> Status;
    model_exchange::fmi2GetEventIndicators(c: fmi2Component, event_indicators: *mut fmi2Real, ni: usize) -> Status;
    model_exchange::fmi2GetContinuousStates(c: fmi2Component, x: *mut fmi2Real, nx: usize) -> Status;
    model_exchange::fmi2GetNominalsOfContinuousStates(c: fmi2Component, x_nominal: *mut fmi2Real, nx: usize) -> Status;
    states::fmi2GetFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> Status;
    states::fmi2SetFMUstate(c: fmi2Component, state: fmi2FMUstate) -> Status;
    states::fmi2FreeFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> Status;
    states::fmi2SerializedFMUstateSize(c: fmi2Component, state: fmi2FMUstate, size: *mut usize) -> Status;
    states::fmi2SerializeFMUstate(c: fmi2Component, state: fmi2FMUstate, bytes: *mut fmi2Byte, size: usize) -> Status;
    states::fmi2DeSerializeFMUstate(c: fmi2Component, bytes: *const fmi2Byte, size: usize, state: *mut fmi2FMUstate) -> Status;
}
