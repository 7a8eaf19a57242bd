//! Any function of FMI 3.0 with any arguments.

use crate::invoke::{Function, Word};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::lifecycle::Call;

macro_rules! invoke {
    ($call:ident($words:ident); $($arguments:tt: $($name:ident = $function:ident)+;)+) => {
        match $call {
            // SAFETY: the caller's.
            $($(Call::$name => unsafe { Function::call($function as unsafe extern "C" fn $arguments -> _, $words) },)+)+
            // There is no instance yet.
            Call::InstantiateCoSimulation | Call::InstantiateModelExchange | Call::InstantiateScheduledExecution => None,
        }
    };
}

/// Calls a function with these words; its status, if it has one.
///
/// # Safety
/// As the function's.
pub unsafe fn invoke(call: Call, words: &[Word]) -> Option<Status> {
    invoke! {
        call(words);
        (): GetVersion = fmi3GetVersion;
        (_): FreeInstance = fmi3FreeInstance ExitInitializationMode = fmi3ExitInitializationMode
            EnterEventMode = fmi3EnterEventMode EnterStepMode = fmi3EnterStepMode Terminate = fmi3Terminate
            Reset = fmi3Reset EnterContinuousTimeMode = fmi3EnterContinuousTimeMode
            EnterConfigurationMode = fmi3EnterConfigurationMode ExitConfigurationMode = fmi3ExitConfigurationMode
            EvaluateDiscreteStates = fmi3EvaluateDiscreteStates;
        (_, _): GetFMUState = fmi3GetFMUState SetFMUState = fmi3SetFMUState FreeFMUState = fmi3FreeFMUState
            SetTime = fmi3SetTime GetNumberOfEventIndicators = fmi3GetNumberOfEventIndicators
            GetNumberOfContinuousStates = fmi3GetNumberOfContinuousStates;
        (_, _, _): SerializedFMUStateSize = fmi3SerializedFMUStateSize SetContinuousStates = fmi3SetContinuousStates
            GetContinuousStateDerivatives = fmi3GetContinuousStateDerivatives
            GetEventIndicators = fmi3GetEventIndicators GetContinuousStates = fmi3GetContinuousStates
            GetNominalsOfContinuousStates = fmi3GetNominalsOfContinuousStates
            ActivateModelPartition = fmi3ActivateModelPartition
            GetNumberOfVariableDependencies = fmi3GetNumberOfVariableDependencies;
        (_, _, _, _): SetDebugLogging = fmi3SetDebugLogging GetClock = fmi3GetClock
            SerializeFMUState = fmi3SerializeFMUState DeserializeFMUState = fmi3DeserializeFMUState
            CompletedIntegratorStep = fmi3CompletedIntegratorStep SetClock = fmi3SetClock
            GetShiftDecimal = fmi3GetShiftDecimal SetIntervalDecimal = fmi3SetIntervalDecimal
            SetShiftDecimal = fmi3SetShiftDecimal;
        (_, _, _, _, _): GetFloat32 = fmi3GetFloat32 GetFloat64 = fmi3GetFloat64 GetInt8 = fmi3GetInt8
            GetUInt8 = fmi3GetUInt8 GetInt16 = fmi3GetInt16 GetUInt16 = fmi3GetUInt16 GetInt32 = fmi3GetInt32
            GetUInt32 = fmi3GetUInt32 GetInt64 = fmi3GetInt64 GetUInt64 = fmi3GetUInt64 GetBoolean = fmi3GetBoolean
            GetString = fmi3GetString SetFloat32 = fmi3SetFloat32 SetFloat64 = fmi3SetFloat64 SetInt8 = fmi3SetInt8
            SetUInt8 = fmi3SetUInt8 SetInt16 = fmi3SetInt16 SetUInt16 = fmi3SetUInt16 SetInt32 = fmi3SetInt32
            SetUInt32 = fmi3SetUInt32 SetInt64 = fmi3SetInt64 SetUInt64 = fmi3SetUInt64 SetBoolean = fmi3SetBoolean
            SetString = fmi3SetString GetIntervalDecimal = fmi3GetIntervalDecimal GetShiftFraction = fmi3GetShiftFraction
            SetIntervalFraction = fmi3SetIntervalFraction SetShiftFraction = fmi3SetShiftFraction;
        (_, _, _, _, _, _): EnterInitializationMode = fmi3EnterInitializationMode GetBinary = fmi3GetBinary
            SetBinary = fmi3SetBinary GetOutputDerivatives = fmi3GetOutputDerivatives
            GetIntervalFraction = fmi3GetIntervalFraction;
        (_, _, _, _, _, _, _): UpdateDiscreteStates = fmi3UpdateDiscreteStates
            GetVariableDependencies = fmi3GetVariableDependencies;
        (_, _, _, _, _, _, _, _): DoStep = fmi3DoStep;
        (_, _, _, _, _, _, _, _, _): GetDirectionalDerivative = fmi3GetDirectionalDerivative
            GetAdjointDerivative = fmi3GetAdjointDerivative;
    }
}
