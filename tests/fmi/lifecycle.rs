//! Every call in every state, against the standard's table told the other way round: by state.

mod perform;

use crate::host::Slave;
use perform::perform;
use slidercrank::fmi::Status;
use slidercrank::fmi::abi::types::fmi2FMUstate;
use slidercrank::fmi::lifecycle::{Call, State, Touch};
use std::ptr::null;

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

/// States that an importer can bring about.
const REACHABLE: [State; 5] =
    [State::Instantiated, State::InitializationMode, State::StepComplete, State::StepFailed, State::Terminated];

/// A slave in this state, with a state saved when it was young.
fn reach(state: State) -> (Slave, fmi2FMUstate) {
    let slave = Slave::new();
    // Away from the dead centre, where no load could turn the crank.
    assert_eq!(slave.set("crank.angle_start", 1.0), Status::Ok);
    let saved = slave.save();
    if state == State::Instantiated {
        return (slave, saved);
    }
    assert_eq!(slave.enter(), Status::Ok);
    if state == State::InitializationMode {
        return (slave, saved);
    }
    assert_eq!(slave.exit(), Status::Ok);
    match state {
        State::StepFailed => {
            // More than a floating-point number can hold once it is divided by a mass.
            assert_eq!(slave.set("slider.load", 1e308), Status::Ok);
            assert_eq!(slave.step(0.0, 0.01), Status::Discard);
        }
        State::Terminated => assert_eq!(slave.terminate(), Status::Ok),
        _ => {}
    }
    slave.log.take();
    (slave, saved)
}

#[test]
fn every_call_in_every_reachable_state_answers_as_the_table_says() {
    for state in REACHABLE {
        let allowed = allowed(state).concat();
        for &call in Call::ALL {
            let (slave, saved) = reach(state);
            let Some(answer) = perform(call, &slave, saved) else {
                continue;
            };
            let expected = match call {
                // There is no such status at all.
                GetIntegerStatus | GetStringStatus if allowed.contains(&call) => Status::Discard,
                _ if allowed.contains(&call) => Status::Ok,
                _ => Status::Error,
            };
            let lines = slave.log.take();
            assert_eq!(answer, expected, "{} in {state}: {lines:?}", call.name());
            assert_eq!(lines.len(), usize::from(expected != Status::Ok), "{} in {state}", call.name());
            if expected == Status::Error {
                assert!(lines[0].text.starts_with(call.name()), "{lines:?}");
                assert!(lines[0].text.contains(&state.to_string()) || call.is_model_exchange(), "{lines:?}");
            }
        }
    }
}

#[test]
fn a_refused_call_leaves_the_run_alone() {
    let (slave, reference) = (Slave::running(), Slave::running());
    let saved = slave.save();
    let point = slave.steps(0.0, 1e-4, 5);
    let refused = Call::ALL.iter().filter(|call| !call.allowed(State::StepComplete));
    for &call in refused {
        assert_ne!(perform(call, &slave, saved), Some(Status::Ok), "{}", call.name());
    }
    slave.steps(point, 1e-4, 5);
    reference.steps(0.0, 1e-4, 10);
    assert_eq!(slave.picture(), reference.picture());
}

#[test]
fn null_is_no_component() {
    let (slave, _) = reach(State::StepComplete);
    for &call in Call::ALL {
        // SAFETY: NULL is an allowed argument.
        let status = unsafe {
            let (api, c) = (slave.api, std::ptr::null_mut());
            match call {
                FreeInstance => {
                    (api.FreeInstance)(c);
                    continue;
                }
                Reset => (api.Reset)(c),
                DoStep => (api.DoStep)(c, 0.0, 1.0, 1),
                GetReal => (api.GetReal)(c, null(), 0, std::ptr::null_mut()),
                GetFMUstate => (api.GetFMUstate)(c, std::ptr::null_mut()),
                GetStatus => (api.GetStatus)(c, 0, std::ptr::null_mut()),
                SetTime => (api.SetTime)(c, 0.0),
                _ => continue,
            }
        };
        assert_eq!(status, Status::Error, "{}", call.name());
    }
}
