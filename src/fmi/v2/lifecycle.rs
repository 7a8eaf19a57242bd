//! The life cycle: one table of the calls that are allowed in each state, from FMI 2.0 §3.2.3 and §4.2.4, with one row
//! for each call.
//!
//! There are three deviations, all in favour of the importer. `fmi2FreeInstance` works in the fatal state, too, since
//! freeing memory does no harm. Reading inputs and parameters back works from instantiation on, as hosts do; so the
//! rows of `fmi2Get…` are open there, and the rows of [`Touch`] say which variables they reach. And where inputs may be
//! set in model exchange, `fmi2SetReal` sets continuous states as `fmi2SetContinuousStates` does, which CasADi takes
//! for granted.

use crate::fmi::call_table::{permissions, table};
use crate::fmi::slave::{Interface, Permission};
use serde::{Deserialize, Serialize};
use std::fmt;

/// State of an instance. A call never meets `StepInProgress` or `StepCanceled`, since a step is
/// over when its call returns; they are here because the standard's table has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum State {
    /// There is no instance.
    StartAndEnd,
    /// Start values may be set.
    Instantiated,
    /// Start values may be set and outputs follow them.
    InitializationMode,
    /// At an event, or right after initialization (model exchange).
    EventMode,
    /// The importer integrates (model exchange).
    ContinuousTimeMode,
    /// At a communication point.
    StepComplete,
    /// Inside an asynchronous step.
    StepInProgress,
    /// The last step ended before its communication point.
    StepFailed,
    /// The last step was cancelled.
    StepCanceled,
    /// After `fmi2Terminate`.
    Terminated,
    /// Only restoring a saved state, resetting and freeing are possible.
    Error,
    /// After an internal error; only freeing is possible.
    Fatal,
}

impl State {
    /// All states, in the order of the table's columns.
    pub const ALL: [Self; 12] = [
        Self::StartAndEnd,
        Self::Instantiated,
        Self::InitializationMode,
        Self::EventMode,
        Self::ContinuousTimeMode,
        Self::StepComplete,
        Self::StepInProgress,
        Self::StepFailed,
        Self::StepCanceled,
        Self::Terminated,
        Self::Error,
        Self::Fatal,
    ];

    /// Name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::StartAndEnd => "not instantiated",
            Self::Instantiated => "instantiated",
            Self::InitializationMode => "initialization mode",
            Self::EventMode => "event mode",
            Self::ContinuousTimeMode => "continuous-time mode",
            Self::StepComplete => "step complete",
            Self::StepInProgress => "step in progress",
            Self::StepFailed => "step failed",
            Self::StepCanceled => "step canceled",
            Self::Terminated => "terminated",
            Self::Error => "error",
            Self::Fatal => "fatal",
        }
    }

    /// The kind of interface of instances in this state, if only one kind can be in it.
    pub fn interface(self) -> Option<Interface> {
        match self {
            Self::EventMode | Self::ContinuousTimeMode => Some(Interface::ModelExchange),
            Self::StepComplete | Self::StepInProgress | Self::StepFailed | Self::StepCanceled => {
                Some(Interface::CoSimulation)
            }
            _ => None,
        }
    }
}

permissions!();

table! {
    /// A function of the standard.
    Call, "fmi2";
    //                         start   initialization   continuous    progress    canceled  error
    //                         |  instantiated   event mode  |  complete  |  failed  |  terminated  fatal
    //                         |    |    |    |    |    |    |    |    |    |    |    |
    GetTypesPlatform          "x    x    x    x    x    x    x    x    x    x    x    ."
    GetVersion                "x    x    x    x    x    x    x    x    x    x    x    ."
    SetDebugLogging           ".    x    x    x    x    x    x    x    x    x    x    ."
    Instantiate               "x    .    .    .    .    .    .    .    .    .    .    ."
    FreeInstance              ".    x    x    x    x    x    .    x    x    x    x    x"
    SetupExperiment           ".    x    .    .    .    .    .    .    .    .    .    ."
    EnterInitializationMode   ".    x    .    .    .    .    .    .    .    .    .    ."
    ExitInitializationMode    ".    .    x    .    .    .    .    .    .    .    .    ."
    Terminate                 ".    .    .    x    x    x    .    x    .    .    .    ."
    Reset                     ".    x    x    x    x    x    .    x    x    x    x    ."
    GetReal                   ".    x    x    x    x    x    .    x    x    x    x    ."
    GetInteger                ".    x    x    x    x    x    .    x    x    x    x    ."
    GetBoolean                ".    x    x    x    x    x    .    x    x    x    x    ."
    GetString                 ".    x    x    x    x    x    .    x    x    x    x    ."
    SetReal                   ".    x    x    x    x    x    .    .    .    .    .    ."
    SetInteger                ".    x    x    x    .    x    .    .    .    .    .    ."
    SetBoolean                ".    x    x    x    .    x    .    .    .    .    .    ."
    SetString                 ".    x    x    x    .    x    .    .    .    .    .    ."
    GetFMUstate               ".    x    x    x    x    x    .    x    x    x    x    ."
    SetFMUstate               ".    x    x    x    x    x    .    x    x    x    x    ."
    FreeFMUstate              ".    x    x    x    x    x    .    x    x    x    x    ."
    SerializedFMUstateSize    ".    x    x    x    x    x    .    x    x    x    x    ."
    SerializeFMUstate         ".    x    x    x    x    x    .    x    x    x    x    ."
    DeSerializeFMUstate       ".    x    x    x    x    x    .    x    x    x    x    ."
    GetDirectionalDerivative  ".    .    x    x    x    x    .    x    x    x    x    ."
    SetRealInputDerivatives   ".    x    x    .    .    x    .    .    .    .    .    ."
    GetRealOutputDerivatives  ".    .    .    .    .    x    .    x    x    x    x    ."
    DoStep                    ".    .    .    .    .    x    .    .    .    .    .    ."
    CancelStep                ".    .    .    .    .    .    x    .    .    .    .    ."
    GetStatus                 ".    .    .    .    .    x    x    x    .    x    .    ."
    GetRealStatus             ".    .    .    .    .    x    x    x    .    x    .    ."
    GetIntegerStatus          ".    .    .    .    .    x    x    x    .    x    .    ."
    GetBooleanStatus          ".    .    .    .    .    x    x    x    .    x    .    ."
    GetStringStatus           ".    .    .    .    .    x    x    x    .    x    .    ."
    // Model exchange.
    EnterEventMode            ".    .    .    x    x    .    .    .    .    .    .    ."
    NewDiscreteStates         ".    .    .    x    .    .    .    .    .    .    .    ."
    EnterContinuousTimeMode   ".    .    .    x    .    .    .    .    .    .    .    ."
    CompletedIntegratorStep   ".    .    .    .    x    .    .    .    .    .    .    ."
    SetTime                   ".    .    .    x    x    .    .    .    .    .    .    ."
    SetContinuousStates       ".    .    .    .    x    .    .    .    .    .    .    ."
    GetDerivatives            ".    .    .    x    x    .    .    .    .    x    x    ."
    GetEventIndicators        ".    .    x    x    x    .    .    .    .    x    x    ."
    GetContinuousStates       ".    .    x    x    x    .    .    .    .    x    x    ."
    GetNominalsOfContinuousStates ". x   .    x    x    .    .    .    .    x    x    ."
}

table! {
    /// The access of a call to one variable, from the footnotes of the standard's table.
    Touch, "";
    GetOutput                 ".    .    x    x    x    x    .    x    x    x    x    ."
    GetInput                  ".    x    x    x    x    x    .    x    x    x    x    ."
    GetParameter              ".    x    x    x    x    x    .    x    x    x    x    ."
    SetOutput                 ".    .    .    .    .    .    .    .    .    .    .    ."
    SetInput                  ".    x    x    x    x    x    .    .    .    .    .    ."
    SetParameter              ".    x    x    .    .    .    .    .    .    .    .    ."
}

impl Call {
    /// The kind of interface to which the function belongs, unless it belongs to both.
    pub fn interface(self) -> Option<Interface> {
        let place = self as usize;
        if place >= Self::EnterEventMode as usize {
            Some(Interface::ModelExchange)
        } else if place >= Self::SetRealInputDerivatives as usize {
            Some(Interface::CoSimulation)
        } else {
            None
        }
    }
}
