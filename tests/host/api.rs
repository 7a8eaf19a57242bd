//! All functions of the standard, linked or loaded: one list of names and types.
#![allow(non_snake_case, reason = "the names are the standard's")]

use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::functions::bodies;
use slidercrank::fmi::v2::abi::types::*;
use std::ffi::c_char;

pub type C = fmi2Component;
pub type S = fmi2FMUstate;

/// The list, for the macro `$of` to make something of.
#[macro_export]
macro_rules! functions {
    ($of:ident) => {
        $of! {
            GetTypesPlatform = bodies::fmi2GetTypesPlatform: fn() -> fmi2String;
            GetVersion = bodies::fmi2GetVersion: fn() -> fmi2String;
            SetDebugLogging = bodies::fmi2SetDebugLogging: fn(C, fmi2Boolean, usize, *const fmi2String) -> Status;
            Instantiate = bodies::fmi2Instantiate: fn(fmi2String, fmi2Type, fmi2String, fmi2String, *const fmi2CallbackFunctions, fmi2Boolean, fmi2Boolean) -> C;
            FreeInstance = bodies::fmi2FreeInstance: fn(C) -> ();
            SetupExperiment = bodies::fmi2SetupExperiment: fn(C, fmi2Boolean, f64, f64, fmi2Boolean, f64) -> Status;
            EnterInitializationMode = bodies::fmi2EnterInitializationMode: fn(C) -> Status;
            ExitInitializationMode = bodies::fmi2ExitInitializationMode: fn(C) -> Status;
            Terminate = bodies::fmi2Terminate: fn(C) -> Status;
            Reset = bodies::fmi2Reset: fn(C) -> Status;
            GetReal = bodies::fmi2GetReal: fn(C, *const u32, usize, *mut f64) -> Status;
            SetReal = bodies::fmi2SetReal: fn(C, *const u32, usize, *const f64) -> Status;
            GetInteger = bodies::fmi2GetInteger: fn(C, *const u32, usize, *mut i32) -> Status;
            SetInteger = bodies::fmi2SetInteger: fn(C, *const u32, usize, *const i32) -> Status;
            GetBoolean = bodies::fmi2GetBoolean: fn(C, *const u32, usize, *mut i32) -> Status;
            SetBoolean = bodies::fmi2SetBoolean: fn(C, *const u32, usize, *const i32) -> Status;
            GetString = bodies::fmi2GetString: fn(C, *const u32, usize, *mut fmi2String) -> Status;
            SetString = bodies::fmi2SetString: fn(C, *const u32, usize, *const fmi2String) -> Status;
            GetFMUstate = bodies::fmi2GetFMUstate: fn(C, *mut S) -> Status;
            SetFMUstate = bodies::fmi2SetFMUstate: fn(C, S) -> Status;
            FreeFMUstate = bodies::fmi2FreeFMUstate: fn(C, *mut S) -> Status;
            SerializedFMUstateSize = bodies::fmi2SerializedFMUstateSize: fn(C, S, *mut usize) -> Status;
            SerializeFMUstate = bodies::fmi2SerializeFMUstate: fn(C, S, *mut c_char, usize) -> Status;
            DeSerializeFMUstate = bodies::fmi2DeSerializeFMUstate: fn(C, *const c_char, usize, *mut S) -> Status;
            GetDirectionalDerivative = bodies::fmi2GetDirectionalDerivative: fn(C, *const u32, usize, *const u32, usize, *const f64, *mut f64) -> Status;
            SetRealInputDerivatives = bodies::fmi2SetRealInputDerivatives: fn(C, *const u32, usize, *const i32, *const f64) -> Status;
            GetRealOutputDerivatives = bodies::fmi2GetRealOutputDerivatives: fn(C, *const u32, usize, *const i32, *mut f64) -> Status;
            DoStep = bodies::fmi2DoStep: fn(C, f64, f64, fmi2Boolean) -> Status;
            CancelStep = bodies::fmi2CancelStep: fn(C) -> Status;
            GetStatus = bodies::fmi2GetStatus: fn(C, fmi2StatusKind, *mut i32) -> Status;
            GetRealStatus = bodies::fmi2GetRealStatus: fn(C, fmi2StatusKind, *mut f64) -> Status;
            GetIntegerStatus = bodies::fmi2GetIntegerStatus: fn(C, fmi2StatusKind, *mut i32) -> Status;
            GetBooleanStatus = bodies::fmi2GetBooleanStatus: fn(C, fmi2StatusKind, *mut i32) -> Status;
            GetStringStatus = bodies::fmi2GetStringStatus: fn(C, fmi2StatusKind, *mut fmi2String) -> Status;
            EnterEventMode = bodies::fmi2EnterEventMode: fn(C) -> Status;
            NewDiscreteStates = bodies::fmi2NewDiscreteStates: fn(C, *mut fmi2EventInfo) -> Status;
            EnterContinuousTimeMode = bodies::fmi2EnterContinuousTimeMode: fn(C) -> Status;
            CompletedIntegratorStep = bodies::fmi2CompletedIntegratorStep: fn(C, fmi2Boolean, *mut fmi2Boolean, *mut fmi2Boolean) -> Status;
            SetTime = bodies::fmi2SetTime: fn(C, f64) -> Status;
            SetContinuousStates = bodies::fmi2SetContinuousStates: fn(C, *const f64, usize) -> Status;
            GetDerivatives = bodies::fmi2GetDerivatives: fn(C, *mut f64, usize) -> Status;
            GetEventIndicators = bodies::fmi2GetEventIndicators: fn(C, *mut f64, usize) -> Status;
            GetContinuousStates = bodies::fmi2GetContinuousStates: fn(C, *mut f64, usize) -> Status;
            GetNominalsOfContinuousStates = bodies::fmi2GetNominalsOfContinuousStates: fn(C, *mut f64, usize) -> Status;
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
