//! The table of calls and states, against the standard's told the other way round: by state.

use slidercrank::fmi::v3::abi::functions::NAMES;
use slidercrank::fmi::v3::lifecycle::{Call, State, Touch};

use Call::*;

const SAVING: &[Call] =
    &[GetFMUState, SetFMUState, FreeFMUState, SerializedFMUStateSize, SerializeFMUState, DeserializeFMUState];
const READING: &[Call] = &[
    GetFloat32, GetFloat64, GetInt8, GetUInt8, GetInt16, GetUInt16, GetInt32, GetUInt32, GetInt64, GetUInt64,
    GetBoolean, GetString, GetBinary,
];
const WRITING_CONTINUOUS: &[Call] = &[SetFloat32, SetFloat64];
const WRITING: &[Call] = &[
    SetFloat32, SetFloat64, SetInt8, SetUInt8, SetInt16, SetUInt16, SetInt32, SetUInt32, SetInt64, SetUInt64,
    SetBoolean, SetString, SetBinary,
];
const DERIVING: &[Call] = &[GetDirectionalDerivative, GetAdjointDerivative];
const SETTABLE: &[Call] = &[GetVersion, SetDebugLogging, FreeInstance, Reset];

const WATCHING: &[Call] =
    &[GetContinuousStates, GetContinuousStateDerivatives, GetNominalsOfContinuousStates, GetEventIndicators];
const COUNTING: &[Call] = &[GetNumberOfContinuousStates, GetNumberOfEventIndicators];

/// FMI 3.0, 2.3.1 to 2.3.8, 3.2.1 and 4.2.1, a state at a time.
fn allowed(state: State) -> Vec<&'static [Call]> {
    match state {
        State::StartAndEnd => vec![&[GetVersion, InstantiateCoSimulation, InstantiateModelExchange]],
        State::Instantiated => vec![SETTABLE, SAVING, READING, WRITING, COUNTING, &[EnterInitializationMode]],
        State::InitializationMode => {
            let own: &[Call] = &[ExitInitializationMode, GetClock];
            vec![SETTABLE, SAVING, READING, WRITING, DERIVING, COUNTING, WATCHING, own]
        }
        State::EventMode => {
            let own: &[Call] = &[UpdateDiscreteStates, EnterStepMode, EnterContinuousTimeMode, Terminate, GetClock];
            vec![SETTABLE, SAVING, READING, WRITING, DERIVING, COUNTING, WATCHING, own]
        }
        State::ContinuousTimeMode => {
            let own: &[Call] = &[SetTime, SetContinuousStates, CompletedIntegratorStep, EnterEventMode, Terminate];
            vec![SETTABLE, SAVING, READING, WRITING_CONTINUOUS, DERIVING, COUNTING, WATCHING, own]
        }
        State::StepMode => vec![
            SETTABLE,
            SAVING,
            READING,
            WRITING,
            DERIVING,
            &[DoStep, EnterEventMode, Terminate, GetOutputDerivatives],
        ],
        State::EventPending => {
            vec![SETTABLE, SAVING, READING, WRITING, DERIVING, &[EnterEventMode, Terminate, GetOutputDerivatives]]
        }
        State::IntermediateUpdateMode => vec![READING, WRITING, &[GetVersion, GetOutputDerivatives]],
        State::Terminated => {
            vec![SETTABLE, SAVING, READING, DERIVING, COUNTING, WATCHING, &[GetOutputDerivatives]]
        }
        State::Fatal => vec![&[FreeInstance]],
    }
}

#[test]
fn the_table_is_the_standards() {
    for state in State::ALL {
        let allowed = allowed(state).concat();
        for &call in Call::ALL {
            assert_eq!(call.allowed(state), allowed.contains(&call), "{} in {state}", call.name());
        }
    }
}

#[test]
fn what_is_allowed_nowhere_has_a_reason() {
    for &call in Call::ALL {
        let nowhere = State::ALL.iter().all(|state| !call.allowed(*state));
        assert_eq!(call.not_provided().is_some(), nowhere, "{}", call.name());
    }
}

#[test]
fn variables_are_touched_as_their_causality_says() {
    let setting = [State::Instantiated, State::InitializationMode];
    for state in State::ALL {
        let of = |call: Call| allowed(state).concat().contains(&call);
        assert_eq!(Touch::GetInput.allowed(state), of(GetFloat64));
        assert_eq!(Touch::GetParameter.allowed(state), of(GetFloat64));
        assert_eq!(Touch::GetOutput.allowed(state), of(GetFloat64) && state != State::Instantiated);
        assert_eq!(Touch::SetParameter.allowed(state), setting.contains(&state));
        assert_eq!(Touch::SetInput.allowed(state), of(SetFloat64));
        assert!(!Touch::SetOutput.allowed(state));
    }
}

#[test]
fn the_table_and_the_list_have_the_same_functions() {
    let mut calls: Vec<_> = Call::ALL.iter().map(|call| call.name()).collect();
    let mut functions = NAMES.to_vec();
    calls.sort_unstable();
    functions.sort_unstable();
    assert_eq!(calls, functions);
    // `fmi3Functions.h` of FMI 3.0.
    assert_eq!(calls.len(), 75);
}
