//! The table of calls and states, against the standard's told the other way round: by state.

use slidercrank::fmi::v2::lifecycle::{Call, State, Touch};

use Call::*;

const QUERIES: &[Call] = &[GetStatus, GetRealStatus, GetIntegerStatus, GetBooleanStatus, GetStringStatus];
const SAVING: &[Call] =
    &[GetFMUstate, SetFMUstate, FreeFMUstate, SerializedFMUstateSize, SerializeFMUstate, DeSerializeFMUstate];
const READING: &[Call] = &[GetReal, GetInteger, GetBoolean, GetString];
const WRITING: &[Call] = &[SetReal, SetInteger, SetBoolean, SetString];
const ANY_TIME: &[Call] = &[GetTypesPlatform, GetVersion];
const ALIVE: &[Call] = &[GetTypesPlatform, GetVersion, SetDebugLogging, FreeInstance, Reset];

/// FMI 2.0.4, table in 4.2.4, a column at a time. Reading while instantiated is our addition, for
/// inputs and parameters.
fn allowed(state: State) -> Vec<&'static [Call]> {
    match state {
        State::StartAndEnd => vec![ANY_TIME, &[Instantiate]],
        State::Instantiated => {
            vec![ALIVE, SAVING, WRITING, READING, &[SetupExperiment, EnterInitializationMode, SetRealInputDerivatives]]
        }
        State::InitializationMode => vec![
            ALIVE,
            SAVING,
            WRITING,
            READING,
            &[ExitInitializationMode, GetDirectionalDerivative, SetRealInputDerivatives],
        ],
        State::StepComplete => vec![
            ALIVE,
            SAVING,
            WRITING,
            READING,
            QUERIES,
            &[Terminate, DoStep],
            &[GetDirectionalDerivative, SetRealInputDerivatives, GetRealOutputDerivatives],
        ],
        State::StepInProgress => vec![ANY_TIME, QUERIES, &[SetDebugLogging, CancelStep]],
        State::StepFailed => {
            vec![ALIVE, SAVING, READING, QUERIES, &[Terminate, GetDirectionalDerivative, GetRealOutputDerivatives]]
        }
        State::StepCanceled | State::Error => {
            vec![ALIVE, SAVING, READING, &[GetDirectionalDerivative, GetRealOutputDerivatives]]
        }
        State::Terminated => {
            vec![ALIVE, SAVING, READING, QUERIES, &[GetDirectionalDerivative, GetRealOutputDerivatives]]
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
fn variables_are_touched_as_the_footnotes_say() {
    let setting = [State::Instantiated, State::InitializationMode];
    for state in State::ALL {
        let reading = allowed(state).concat().contains(&GetReal);
        assert_eq!(Touch::GetInput.allowed(state), reading);
        assert_eq!(Touch::GetParameter.allowed(state), reading);
        assert_eq!(Touch::GetOutput.allowed(state), reading && state != State::Instantiated);
        assert_eq!(Touch::SetParameter.allowed(state), setting.contains(&state));
        let inputs = setting.contains(&state) || state == State::StepComplete;
        assert_eq!(Touch::SetInput.allowed(state), inputs);
        assert!(!Touch::SetOutput.allowed(state));
    }
}
