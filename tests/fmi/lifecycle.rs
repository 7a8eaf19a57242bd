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

const ENDED: &[Call] =
    &[GetDirectionalDerivative, GetRealOutputDerivatives, GetDerivatives, GetNominalsOfContinuousStates];
const LOOKING: &[Call] = &[GetContinuousStates, GetEventIndicators];

/// FMI 2.0.4, tables in 3.2.3 and 4.2.4, a column at a time. Reading while instantiated is our addition, for
/// inputs and parameters.
fn allowed(state: State) -> Vec<&'static [Call]> {
    match state {
        State::StartAndEnd => vec![ANY_TIME, &[Instantiate]],
        State::Instantiated => {
            vec![
                ALIVE,
                SAVING,
                WRITING,
                READING,
                &[SetupExperiment, EnterInitializationMode, SetRealInputDerivatives, GetNominalsOfContinuousStates],
            ]
        }
        State::InitializationMode => vec![
            ALIVE,
            SAVING,
            WRITING,
            READING,
            LOOKING,
            &[ExitInitializationMode, GetDirectionalDerivative, SetRealInputDerivatives],
        ],
        State::EventMode => vec![
            ALIVE,
            SAVING,
            WRITING,
            READING,
            LOOKING,
            &[Terminate, EnterEventMode, NewDiscreteStates, EnterContinuousTimeMode, SetTime],
            &[GetDerivatives, GetNominalsOfContinuousStates, GetDirectionalDerivative],
        ],
        State::ContinuousTimeMode => vec![
            ALIVE,
            SAVING,
            READING,
            LOOKING,
            &[Terminate, EnterEventMode, CompletedIntegratorStep, SetTime, SetContinuousStates, SetReal],
            &[GetDerivatives, GetNominalsOfContinuousStates, GetDirectionalDerivative],
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
        State::StepCanceled => {
            vec![ALIVE, SAVING, READING, &[GetDirectionalDerivative, GetRealOutputDerivatives]]
        }
        State::Error => vec![ALIVE, SAVING, READING, LOOKING, ENDED],
        State::Terminated => vec![ALIVE, SAVING, READING, QUERIES, LOOKING, ENDED],
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
        let running = [State::EventMode, State::ContinuousTimeMode, State::StepComplete];
        let inputs = setting.contains(&state) || running.contains(&state);
        assert_eq!(Touch::SetInput.allowed(state), inputs);
        assert!(!Touch::SetOutput.allowed(state));
    }
}
