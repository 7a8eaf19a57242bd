//! Which call is allowed in which state: the state machines of FMI 3.0 for model exchange (3.2.1) and co-simulation
//! (4.2.1) as one table, one row a call.
//!
//! Configuration mode and reconfiguration mode are left out: without structural parameters no call leads there.
//! Step mode is told apart by whether an event is to be handled first, since the importer has to enter event mode then.
//!
//! Two deviations, both towards the importer. A refused call leaves the instance where it was, where the standard
//! terminates it. Reading inputs and parameters works from instantiation on, reading outputs from initialization mode on.
//! Where inputs may be set in model exchange, `fmi3SetFloat64` sets continuous states, too, as the standard has it.

use crate::fmi::call_table::{permissions, table};
use crate::fmi::slave::{Interface, Permission};
use serde::{Deserialize, Serialize};
use std::fmt;

/// State of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum State {
    /// No instance yet, or no longer.
    StartAndEnd,
    /// Start values may be set.
    Instantiated,
    /// Start values may be set and outputs follow them.
    InitializationMode,
    /// While an event is handled or inputs jump.
    EventMode,
    /// The importer integrates (model exchange).
    ContinuousTimeMode,
    /// At a communication point.
    StepMode,
    /// At a communication point where a contact has closed or opened; event mode has to follow.
    EventPending,
    /// Within a step, while the importer's callback runs.
    IntermediateUpdateMode,
    /// After `fmi3Terminate` or a step that failed.
    Terminated,
    /// A fault of ours; only the end can follow.
    Fatal,
}

impl State {
    /// All states, in the order of the table's columns.
    pub const ALL: [Self; 10] = [
        Self::StartAndEnd,
        Self::Instantiated,
        Self::InitializationMode,
        Self::EventMode,
        Self::ContinuousTimeMode,
        Self::StepMode,
        Self::EventPending,
        Self::IntermediateUpdateMode,
        Self::Terminated,
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
            Self::StepMode => "step mode",
            Self::EventPending => "step mode, event to be handled",
            Self::IntermediateUpdateMode => "intermediate update mode",
            Self::Terminated => "terminated",
            Self::Fatal => "fatal",
        }
    }

    /// The kind of interface of instances in this state, if only one kind comes there.
    pub fn interface(self) -> Option<Interface> {
        match self {
            Self::ContinuousTimeMode => Some(Interface::ModelExchange),
            Self::StepMode | Self::EventPending | Self::IntermediateUpdateMode => Some(Interface::CoSimulation),
            _ => None,
        }
    }
}

permissions!();

table! {
    /// A function of the standard.
    Call, "fmi3";
    //                                start     initialization step mode intermediate update
    //                                |    instantiated   continuous time     terminated
    //                                |    |    |    event mode     event pending  fatal
    //                                |    |    |    |    |    |    |    |    |    |
    GetVersion                       "x    x    x    x    x    x    x    x    x    ."
    SetDebugLogging                  ".    x    x    x    x    x    x    .    x    ."
    InstantiateModelExchange         "x    .    .    .    .    .    .    .    .    ."
    InstantiateCoSimulation          "x    .    .    .    .    .    .    .    .    ."
    FreeInstance                     ".    x    x    x    x    x    x    .    x    x"
    EnterInitializationMode          ".    x    .    .    .    .    .    .    .    ."
    ExitInitializationMode           ".    .    x    .    .    .    .    .    .    ."
    EnterEventMode                   ".    .    .    .    x    x    x    .    .    ."
    UpdateDiscreteStates             ".    .    .    x    .    .    .    .    .    ."
    Terminate                        ".    .    .    x    x    x    x    .    .    ."
    Reset                            ".    x    x    x    x    x    x    .    x    ."
    GetFloat32                       ".    x    x    x    x    x    x    x    x    ."
    GetFloat64                       ".    x    x    x    x    x    x    x    x    ."
    GetInt8                          ".    x    x    x    x    x    x    x    x    ."
    GetUInt8                         ".    x    x    x    x    x    x    x    x    ."
    GetInt16                         ".    x    x    x    x    x    x    x    x    ."
    GetUInt16                        ".    x    x    x    x    x    x    x    x    ."
    GetInt32                         ".    x    x    x    x    x    x    x    x    ."
    GetUInt32                        ".    x    x    x    x    x    x    x    x    ."
    GetInt64                         ".    x    x    x    x    x    x    x    x    ."
    GetUInt64                        ".    x    x    x    x    x    x    x    x    ."
    GetBoolean                       ".    x    x    x    x    x    x    x    x    ."
    GetString                        ".    x    x    x    x    x    x    x    x    ."
    GetBinary                        ".    x    x    x    x    x    x    x    x    ."
    SetFloat32                       ".    x    x    x    x    x    x    x    .    ."
    SetFloat64                       ".    x    x    x    x    x    x    x    .    ."
    SetInt8                          ".    x    x    x    .    x    x    x    .    ."
    SetUInt8                         ".    x    x    x    .    x    x    x    .    ."
    SetInt16                         ".    x    x    x    .    x    x    x    .    ."
    SetUInt16                        ".    x    x    x    .    x    x    x    .    ."
    SetInt32                         ".    x    x    x    .    x    x    x    .    ."
    SetUInt32                        ".    x    x    x    .    x    x    x    .    ."
    SetInt64                         ".    x    x    x    .    x    x    x    .    ."
    SetUInt64                        ".    x    x    x    .    x    x    x    .    ."
    SetBoolean                       ".    x    x    x    .    x    x    x    .    ."
    SetString                        ".    x    x    x    .    x    x    x    .    ."
    SetBinary                        ".    x    x    x    .    x    x    x    .    ."
    GetClock                         ".    .    x    x    .    .    .    .    .    ."
    GetFMUState                      ".    x    x    x    x    x    x    .    x    ."
    SetFMUState                      ".    x    x    x    x    x    x    .    x    ."
    FreeFMUState                     ".    x    x    x    x    x    x    .    x    ."
    SerializedFMUStateSize           ".    x    x    x    x    x    x    .    x    ."
    SerializeFMUState                ".    x    x    x    x    x    x    .    x    ."
    DeserializeFMUState              ".    x    x    x    x    x    x    .    x    ."
    GetDirectionalDerivative         ".    .    x    x    x    x    x    .    x    ."
    GetAdjointDerivative             ".    .    x    x    x    x    x    .    x    ."
    // Co-simulation.
    EnterStepMode                    ".    .    .    x    .    .    .    .    .    ."
    DoStep                           ".    .    .    .    .    x    .    .    .    ."
    GetOutputDerivatives             ".    .    .    .    .    x    x    x    x    ."
    // Model exchange.
    EnterContinuousTimeMode          ".    .    .    x    .    .    .    .    .    ."
    CompletedIntegratorStep          ".    .    .    .    x    .    .    .    .    ."
    SetTime                          ".    .    .    .    x    .    .    .    .    ."
    SetContinuousStates              ".    .    .    .    x    .    .    .    .    ."
    GetContinuousStateDerivatives    ".    .    x    x    x    .    .    .    x    ."
    GetEventIndicators               ".    .    x    x    x    .    .    .    x    ."
    GetContinuousStates              ".    .    x    x    x    .    .    .    x    ."
    GetNominalsOfContinuousStates    ".    .    x    x    x    .    .    .    x    ."
    GetNumberOfEventIndicators       ".    x    x    x    x    .    .    .    x    ."
    GetNumberOfContinuousStates      ".    x    x    x    x    .    .    .    x    ."
    // Scheduled execution.
    InstantiateScheduledExecution    ".    .    .    .    .    .    .    .    .    ."
    ActivateModelPartition           ".    .    .    .    .    .    .    .    .    ."
    // Structural parameters, of which there are none.
    EnterConfigurationMode           ".    .    .    .    .    .    .    .    .    ."
    ExitConfigurationMode            ".    .    .    .    .    .    .    .    .    ."
    // Input clocks, of which there are none.
    SetClock                         ".    .    .    .    .    .    .    .    .    ."
    GetIntervalDecimal               ".    .    .    .    .    .    .    .    .    ."
    GetIntervalFraction              ".    .    .    .    .    .    .    .    .    ."
    GetShiftDecimal                  ".    .    .    .    .    .    .    .    .    ."
    GetShiftFraction                 ".    .    .    .    .    .    .    .    .    ."
    SetIntervalDecimal               ".    .    .    .    .    .    .    .    .    ."
    SetIntervalFraction              ".    .    .    .    .    .    .    .    .    ."
    SetShiftDecimal                  ".    .    .    .    .    .    .    .    .    ."
    SetShiftFraction                 ".    .    .    .    .    .    .    .    .    ."
    // What the description says that the FMU does not provide.
    EvaluateDiscreteStates           ".    .    .    .    .    .    .    .    .    ."
    GetNumberOfVariableDependencies  ".    .    .    .    .    .    .    .    .    ."
    GetVariableDependencies          ".    .    .    .    .    .    .    .    .    ."
}

table! {
    /// What a call does to one variable.
    Touch, "";
    GetOutput                        ".    .    x    x    x    x    x    x    x    ."
    GetInput                         ".    x    x    x    x    x    x    x    x    ."
    GetParameter                     ".    x    x    x    x    x    x    x    x    ."
    SetOutput                        ".    .    .    .    .    .    .    .    .    ."
    SetInput                         ".    x    x    x    x    x    x    x    .    ."
    SetParameter                     ".    x    x    .    .    .    .    .    .    ."
}

impl Call {
    /// The kind of interface that the function belongs to, if not to both.
    pub fn interface(self) -> Option<Interface> {
        let within = |first: Self, last: Self| (first as usize..=last as usize).contains(&(self as usize));
        if within(Self::EnterStepMode, Self::GetOutputDerivatives) {
            Some(Interface::CoSimulation)
        } else if within(Self::EnterContinuousTimeMode, Self::GetNumberOfContinuousStates) {
            Some(Interface::ModelExchange)
        } else {
            None
        }
    }

    /// Why the function is refused in every state, if it is.
    pub fn not_provided(self) -> Option<&'static str> {
        let of = |first: Self| self as usize >= first as usize;
        [
            (Self::EvaluateDiscreteStates, "not provided, as the model description says"),
            (Self::SetClock, "the FMU has no input clocks"),
            (Self::EnterConfigurationMode, "the FMU has no structural parameters"),
            (Self::InstantiateScheduledExecution, "of scheduled execution, which this FMU does not offer"),
        ]
        .into_iter()
        .find_map(|(first, reason)| of(first).then_some(reason))
    }
}
