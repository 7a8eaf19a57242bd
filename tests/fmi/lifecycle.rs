//! Every call in every state, against the standard's table told the other way round: by state.

use crate::host::{Slave, vr};
use slidercrank::fmi::Status;
use slidercrank::fmi::abi::types::{fmi2EventInfo, fmi2FMUstate, fmi2String};
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

/// Makes a call with sound arguments; `None` if it has no status.
fn perform(call: Call, slave: &Slave, saved: fmi2FMUstate) -> Option<Status> {
    let (api, c) = (slave.api, slave.c);
    let (mut real, mut integer, mut size, mut string): (f64, i32, usize, fmi2String) = (0.0, 0, 0, null());
    let (mut flag, mut bytes, mut state) = (0, slave_bytes(slave, saved), saved);
    let mut info = fmi2EventInfo {
        new_discrete_states_needed: 0,
        terminate_simulation: 0,
        nominals_of_continuous_states_changed: 0,
        values_of_continuous_states_changed: 0,
        next_event_time_defined: 0,
        next_event_time: 0.0,
    };
    let (input, output, gravity, model) = (vr("slider.load"), vr("slider.x"), vr("gravity"), vr("joint.C.model"));
    let one = 1;
    // SAFETY: live component, arrays and places of the lengths said.
    Some(unsafe {
        match call {
            GetTypesPlatform | GetVersion | Instantiate | FreeInstance => return None,
            SetDebugLogging => (api.SetDebugLogging)(c, 1, 0, null()),
            SetupExperiment => (api.SetupExperiment)(c, 0, 0.0, 0.0, 0, 0.0),
            EnterInitializationMode => (api.EnterInitializationMode)(c),
            ExitInitializationMode => (api.ExitInitializationMode)(c),
            Terminate => (api.Terminate)(c),
            Reset => (api.Reset)(c),
            GetReal => (api.GetReal)(c, &gravity, 1, &mut real),
            GetInteger => (api.GetInteger)(c, &model, 1, &mut integer),
            GetBoolean => (api.GetBoolean)(c, null(), 0, &mut flag),
            GetString => (api.GetString)(c, null(), 0, &mut string),
            SetReal => (api.SetReal)(c, &input, 1, &real),
            SetInteger => (api.SetInteger)(c, null(), 0, &integer),
            SetBoolean => (api.SetBoolean)(c, null(), 0, &flag),
            SetString => (api.SetString)(c, null(), 0, &string),
            GetFMUstate => (api.GetFMUstate)(c, &mut state),
            SetFMUstate => (api.SetFMUstate)(c, state),
            FreeFMUstate => (api.FreeFMUstate)(c, &mut state),
            SerializedFMUstateSize => (api.SerializedFMUstateSize)(c, state, &mut size),
            SerializeFMUstate => (api.SerializeFMUstate)(c, state, bytes.as_mut_ptr().cast(), bytes.len()),
            DeSerializeFMUstate => (api.DeSerializeFMUstate)(c, bytes.as_ptr().cast(), bytes.len(), &mut state),
            GetDirectionalDerivative => (api.GetDirectionalDerivative)(c, &output, 1, &input, 1, &1.0, &mut real),
            SetRealInputDerivatives => (api.SetRealInputDerivatives)(c, &input, 1, &one, &real),
            GetRealOutputDerivatives => (api.GetRealOutputDerivatives)(c, &output, 1, &one, &mut real),
            DoStep => (api.DoStep)(c, 0.0, 1e-3, 1),
            CancelStep => (api.CancelStep)(c),
            GetStatus => (api.GetStatus)(c, 0, &mut integer),
            GetRealStatus => (api.GetRealStatus)(c, 2, &mut real),
            GetIntegerStatus => (api.GetIntegerStatus)(c, 0, &mut integer),
            GetBooleanStatus => (api.GetBooleanStatus)(c, 3, &mut flag),
            GetStringStatus => (api.GetStringStatus)(c, 1, &mut string),
            EnterEventMode => (api.EnterEventMode)(c),
            NewDiscreteStates => (api.NewDiscreteStates)(c, &mut info),
            EnterContinuousTimeMode => (api.EnterContinuousTimeMode)(c),
            CompletedIntegratorStep => (api.CompletedIntegratorStep)(c, 1, &mut flag, &mut integer),
            SetTime => (api.SetTime)(c, 0.0),
            SetContinuousStates => (api.SetContinuousStates)(c, &real, 1),
            GetDerivatives => (api.GetDerivatives)(c, &mut real, 1),
            GetEventIndicators => (api.GetEventIndicators)(c, &mut real, 1),
            GetContinuousStates => (api.GetContinuousStates)(c, &mut real, 1),
            GetNominalsOfContinuousStates => (api.GetNominalsOfContinuousStates)(c, &mut real, 1),
        }
    })
}

fn slave_bytes(slave: &Slave, saved: fmi2FMUstate) -> Vec<u8> {
    slave.bytes_of(saved)
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
    let (slave, saved) = reach(State::StepComplete);
    let bytes_source = slave.bytes_of(saved);
    assert!(!bytes_source.is_empty());
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
