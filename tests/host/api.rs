//! All functions of the standard, linked or loaded: one list of names and types.
#![allow(non_snake_case, reason = "the names are the standard's")]

use slidercrank::fmi::Status;
use slidercrank::fmi::abi::functions::{self, co_simulation, model_exchange, states, variables};
use slidercrank::fmi::abi::types::*;
use std::ffi::c_char;

pub type C = fmi2Component;
pub type S = fmi2FMUstate;

/// The list, for the macro `$of` to make something of.
macro_rules! functions {
    ($of:ident) => {
        $of! {
            GetTypesPlatform = functions::fmi2GetTypesPlatform: fn() -> fmi2String;
            GetVersion = functions::fmi2GetVersion: fn() -> fmi2String;
            SetDebugLogging = functions::fmi2SetDebugLogging: fn(C, fmi2Boolean, usize, *const fmi2String) -> Status;
            Instantiate = functions::fmi2Instantiate: fn(fmi2String, fmi2Type, fmi2String, fmi2String, *const fmi2CallbackFunctions, fmi2Boolean, fmi2Boolean) -> C;
            FreeInstance = functions::fmi2FreeInstance: fn(C) -> ();
            SetupExperiment = functions::fmi2SetupExperiment: fn(C, fmi2Boolean, f64, f64, fmi2Boolean, f64) -> Status;
            EnterInitializationMode = functions::fmi2EnterInitializationMode: fn(C) -> Status;
            ExitInitializationMode = functions::fmi2ExitInitializationMode: fn(C) -> Status;
            Terminate = functions::fmi2Terminate: fn(C) -> Status;
            Reset = functions::fmi2Reset: fn(C) -> Status;
            GetReal = variables::fmi2GetReal: fn(C, *const u32, usize, *mut f64) -> Status;
            SetReal = variables::fmi2SetReal: fn(C, *const u32, usize, *const f64) -> Status;
            GetInteger = variables::fmi2GetInteger: fn(C, *const u32, usize, *mut i32) -> Status;
            SetInteger = variables::fmi2SetInteger: fn(C, *const u32, usize, *const i32) -> Status;
            GetBoolean = variables::fmi2GetBoolean: fn(C, *const u32, usize, *mut i32) -> Status;
            SetBoolean = variables::fmi2SetBoolean: fn(C, *const u32, usize, *const i32) -> Status;
            GetString = variables::fmi2GetString: fn(C, *const u32, usize, *mut fmi2String) -> Status;
            SetString = variables::fmi2SetString: fn(C, *const u32, usize, *const fmi2String) -> Status;
            GetFMUstate = states::fmi2GetFMUstate: fn(C, *mut S) -> Status;
            SetFMUstate = states::fmi2SetFMUstate: fn(C, S) -> Status;
            FreeFMUstate = states::fmi2FreeFMUstate: fn(C, *mut S) -> Status;
            SerializedFMUstateSize = states::fmi2SerializedFMUstateSize: fn(C, S, *mut usize) -> Status;
            SerializeFMUstate = states::fmi2SerializeFMUstate: fn(C, S, *mut c_char, usize) -> Status;
            DeSerializeFMUstate = states::fmi2DeSerializeFMUstate: fn(C, *const c_char, usize, *mut S) -> Status;
            GetDirectionalDerivative = variables::fmi2GetDirectionalDerivative: fn(C, *const u32, usize, *const u32, usize, *const f64, *mut f64) -> Status;
            SetRealInputDerivatives = variables::fmi2SetRealInputDerivatives: fn(C, *const u32, usize, *const i32, *const f64) -> Status;
            GetRealOutputDerivatives = variables::fmi2GetRealOutputDerivatives: fn(C, *const u32, usize, *const i32, *mut f64) -> Status;
            DoStep = co_simulation::fmi2DoStep: fn(C, f64, f64, fmi2Boolean) -> Status;
            CancelStep = co_simulation::fmi2CancelStep: fn(C) -> Status;
            GetStatus = co_simulation::fmi2GetStatus: fn(C, fmi2StatusKind, *mut i32) -> Status;
            GetRealStatus = co_simulation::fmi2GetRealStatus: fn(C, fmi2StatusKind, *mut f64) -> Status;
            GetIntegerStatus = co_simulation::fmi2GetIntegerStatus: fn(C, fmi2StatusKind, *mut i32) -> Status;
            GetBooleanStatus = co_simulation::fmi2GetBooleanStatus: fn(C, fmi2StatusKind, *mut i32) -> Status;
            GetStringStatus = co_simulation::fmi2GetStringStatus: fn(C, fmi2StatusKind, *mut fmi2String) -> Status;
            EnterEventMode = model_exchange::fmi2EnterEventMode: fn(C) -> Status;
            NewDiscreteStates = model_exchange::fmi2NewDiscreteStates: fn(C, *mut fmi2EventInfo) -> Status;
            EnterContinuousTimeMode = model_exchange::fmi2EnterContinuousTimeMode: fn(C) -> Status;
            CompletedIntegratorStep = model_exchange::fmi2CompletedIntegratorStep: fn(C, fmi2Boolean, *mut fmi2Boolean, *mut fmi2Boolean) -> Status;
            SetTime = model_exchange::fmi2SetTime: fn(C, f64) -> Status;
            SetContinuousStates = model_exchange::fmi2SetContinuousStates: fn(C, *const f64, usize) -> Status;
            GetDerivatives = model_exchange::fmi2GetDerivatives: fn(C, *mut f64, usize) -> Status;
            GetEventIndicators = model_exchange::fmi2GetEventIndicators: fn(C, *mut f64, usize) -> Status;
            GetContinuousStates = model_exchange::fmi2GetContinuousStates: fn(C, *mut f64, usize) -> Status;
            GetNominalsOfContinuousStates = model_exchange::fmi2GetNominalsOfContinuousStates: fn(C, *mut f64, usize) -> Status;
        }
    };
}

macro_rules! api {
    ($($name:ident = $place:path: fn($($argument:ty),*) -> $answer:ty;)+) => {
        /// The functions of the standard.
        #[derive(Clone, Copy)]
        pub struct Api {
            $(pub $name: unsafe extern "C" fn($($argument),*) -> $answer,)+
        }

        impl Api {
            /// Every name.
            pub const NAMES: &[&str] = &[$(concat!("fmi2", stringify!($name))),+];

            /// As linked into this test.
            pub fn linked() -> Self {
                Self { $($name: $place,)+ }
            }

            /// As found in a shared library, by name alone.
            pub fn loaded(library: &libloading::Library) -> Result<Self, libloading::Error> {
                $(
                    // SAFETY: the standard gives the function of this name this type.
                    let $name = unsafe {
                        *library.get::<unsafe extern "C" fn($($argument),*) -> $answer>(
                            concat!("fmi2", stringify!($name)).as_bytes(),
                        )?
                    };
                )+
                Ok(Self { $($name,)+ })
            }
        }
    };
}

functions!(api);
