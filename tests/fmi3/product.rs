//! Every function in every state with NULL, with odd arguments, and out of order: what is not possible is refused, told
//! in one line, and changes nothing.

use crate::importer::{Callback, Handle, Options, Slave, vr};
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;
use slidercrank::fmi::v3::abi::types::*;
use slidercrank::fmi::v3::lifecycle::{Call, State};
use slidercrank::fmi::v3::variables::time_reference;
use slidercrank::model_description::arrays::{CONTACTS, PENETRATIONS};
use slidercrank::model_description::clocks::FIRST_CLOCK;
use slidercrank::model_description::exchange::FIRST_INDICATOR;
use std::cell::RefCell;
use std::ptr::{null, null_mut, without_provenance, without_provenance_mut};
use std::rc::Rc;

/// A call on an instance, or on NULL.
type Attempt = (Call, Box<dyn Fn(fmi3Instance) -> Status>);

/// Kinds of instances, and states that an importer can bring them to, between two calls.
const STATES: [(Interface, State); 10] = [
    (Interface::CoSimulation, State::Instantiated),
    (Interface::CoSimulation, State::InitializationMode),
    (Interface::CoSimulation, State::EventMode),
    (Interface::CoSimulation, State::StepMode),
    (Interface::CoSimulation, State::EventPending),
    (Interface::CoSimulation, State::Terminated),
    (Interface::ModelExchange, State::InitializationMode),
    (Interface::ModelExchange, State::EventMode),
    (Interface::ModelExchange, State::ContinuousTimeMode),
    (Interface::ModelExchange, State::Terminated),
];

fn in_state((interface, state): (Interface, State)) -> Slave {
    let exchanging = interface == Interface::ModelExchange;
    let slave = if exchanging { Slave::exchanging() } else { Slave::new(Options::EVENTS) };
    if state == State::Instantiated {
        return slave;
    }
    assert_eq!(slave.enter(), Status::Ok);
    if !exchanging {
        assert_eq!(slave.set_enumeration("joint.C.model", 2), Status::Ok);
    }
    assert_eq!(slave.set("crank.speed_start", 500.0), Status::Ok);
    if state == State::InitializationMode {
        return slave;
    }
    assert_eq!(slave.exit(), Status::Ok);
    if state == State::EventMode {
        return slave;
    }
    if exchanging {
        assert_eq!(slave.update_discrete_states(), Status::Ok);
        assert_eq!(slave.enter_continuous_time_mode(), Status::Ok);
    } else {
        slave.handle_event();
    }
    if state == State::EventPending {
        assert!(slave.step(0.0, 0.01).event);
    }
    if state == State::Terminated {
        assert_eq!(slave.terminate(), Status::Ok);
    }
    slave
}

/// Whether instances of this kind may make the call in this state.
fn possible(call: Call, (interface, state): (Interface, State)) -> bool {
    call.allowed(state) && call.interface().is_none_or(|of_call| of_call == interface)
}

/// `(Call, |instance| fmi3Call(instance, …))`
macro_rules! attempts {
    ($($call:ident = $function:ident($($argument:expr),*);)+) => {
        // SAFETY: arguments that the standard forbids and that no function may follow, or places that outlive the call.
        vec![$((Call::$call, Box::new(|instance| unsafe { $function(instance $(, $argument)*) }) as Box<_>)),+]
    };
}

/// Calls that no state allows.
fn impossible() -> Vec<Attempt> {
    attempts! {
        // NULL where data are needed.
        SetDebugLogging = fmi3SetDebugLogging(1, 1, null());
        SetDebugLogging = fmi3SetDebugLogging(1, 1, &null());
        UpdateDiscreteStates =
            fmi3UpdateDiscreteStates(null_mut(), null_mut(), null_mut(), null_mut(), null_mut(), null_mut());
        UpdateDiscreteStates = fmi3UpdateDiscreteStates(&mut 7, &mut 7, &mut 7, &mut 7, &mut 7, null_mut());
        DoStep = fmi3DoStep(0.0, 1e-3, 1, null_mut(), null_mut(), null_mut(), null_mut());
        DoStep = fmi3DoStep(0.0, 1e-3, 1, &mut 7, &mut 7, &mut 7, null_mut());
        DoStep = fmi3DoStep(0.0, 0.0, 1, &mut 7, &mut 7, &mut 7, &mut 7.0);
        DoStep = fmi3DoStep(0.0, -1e-3, 1, &mut 7, &mut 7, &mut 7, &mut 7.0);
        DoStep = fmi3DoStep(0.0, f64::NAN, 1, &mut 7, &mut 7, &mut 7, &mut 7.0);
        DoStep = fmi3DoStep(0.0, f64::INFINITY, 1, &mut 7, &mut 7, &mut 7, &mut 7.0);
        DoStep = fmi3DoStep(f64::NAN, 1e-3, 1, &mut 7, &mut 7, &mut 7, &mut 7.0);
        DoStep = fmi3DoStep(-5.0, 1e-3, 1, &mut 7, &mut 7, &mut 7, &mut 7.0);
        EnterInitializationMode = fmi3EnterInitializationMode(1, -1.0, 0.0, 0, 0.0);
        EnterInitializationMode = fmi3EnterInitializationMode(1, f64::NAN, 0.0, 0, 0.0);
        EnterInitializationMode = fmi3EnterInitializationMode(0, 0.0, f64::NAN, 0, 0.0);
        EnterInitializationMode = fmi3EnterInitializationMode(0, 0.0, 1.0, 1, 0.0);
        GetFloat64 = fmi3GetFloat64(null(), 1, &mut 7.0, 1);
        GetFloat64 = fmi3GetFloat64(&vr("slider.mass"), 1, null_mut(), 1);
        GetFloat64 = fmi3GetFloat64(&vr("slider.mass"), 1, without_provenance_mut(1), 1);
        GetFloat64 = fmi3GetFloat64(&vr("slider.mass"), 1, &mut 7.0, 2);
        GetFloat64 = fmi3GetFloat64(&vr("slider.mass"), usize::MAX, &mut 7.0, usize::MAX);
        GetFloat64 = fmi3GetFloat64(&u32::MAX, 1, &mut 7.0, 1);
        GetFloat64 = fmi3GetFloat64(&vr("joint.C.law"), 1, &mut 7.0, 1);
        GetFloat64 = fmi3GetFloat64(&PENETRATIONS, 1, [7.0; 4].as_mut_ptr(), 3);
        GetFloat64 = fmi3GetFloat64(&PENETRATIONS, 1, &mut 7.0, 1);
        GetFloat64 = fmi3GetFloat64(&CONTACTS, 1, [7.0; 4].as_mut_ptr(), 4);
        SetFloat64 = fmi3SetFloat64(&PENETRATIONS, 1, [7.0; 4].as_ptr(), 4);
        SetBoolean = fmi3SetBoolean(&CONTACTS, 1, &1, 1);
        GetInt32 = fmi3GetInt32(&time_reference(), 1, &mut 7, 1);
        GetInt64 = fmi3GetInt64(&vr("solver.events"), 1, &mut 7, 1);
        GetBoolean = fmi3GetBoolean(null(), 1, null_mut(), 1);
        GetString = fmi3GetString(&vr("slider.mass"), 1, null_mut(), 1);
        GetBinary = fmi3GetBinary(&vr("slider.mass"), 1, null_mut(), null_mut(), 1);
        GetFloat32 = fmi3GetFloat32(&vr("slider.mass"), 1, null_mut(), 1);
        GetInt8 = fmi3GetInt8(&vr("slider.mass"), 1, null_mut(), 1);
        GetUInt8 = fmi3GetUInt8(&vr("slider.mass"), 1, null_mut(), 1);
        GetInt16 = fmi3GetInt16(&vr("slider.mass"), 1, null_mut(), 1);
        GetUInt16 = fmi3GetUInt16(&vr("slider.mass"), 1, null_mut(), 1);
        GetUInt32 = fmi3GetUInt32(&vr("slider.mass"), 1, null_mut(), 1);
        GetUInt64 = fmi3GetUInt64(&vr("slider.mass"), 1, null_mut(), 1);
        SetFloat64 = fmi3SetFloat64(null(), 1, &1.0, 1);
        SetFloat64 = fmi3SetFloat64(&vr("slider.load"), 1, null(), 1);
        SetFloat64 = fmi3SetFloat64(&vr("slider.load"), 1, without_provenance(1), 1);
        SetFloat64 = fmi3SetFloat64(&vr("slider.load"), 1, &f64::NAN, 1);
        SetFloat64 = fmi3SetFloat64(&vr("slider.load"), 1, &f64::INFINITY, 1);
        SetFloat64 = fmi3SetFloat64(&vr("slider.x"), 1, &1.0, 1);
        SetFloat64 = fmi3SetFloat64(&vr("slider.mass"), 1, &-1.0, 1);
        SetFloat64 = fmi3SetFloat64(&time_reference(), 1, &1.0, 1);
        SetFloat64 = fmi3SetFloat64([vr("slider.load"), u32::MAX].as_ptr(), 2, [1.0, 2.0].as_ptr(), 2);
        SetInt32 = fmi3SetInt32(&vr("solver.events"), 1, &1, 1);
        SetInt64 = fmi3SetInt64(&vr("joint.C.law"), 1, &99, 1);
        SetBoolean = fmi3SetBoolean(&vr("joint.C.contact"), 1, &1, 1);
        SetString = fmi3SetString(&vr("slider.mass"), 1, null(), 1);
        SetBinary = fmi3SetBinary(&vr("slider.mass"), 1, null(), null(), 1);
        SetFloat32 = fmi3SetFloat32(&vr("slider.mass"), 1, null(), 1);
        SetInt8 = fmi3SetInt8(&vr("slider.mass"), 1, null(), 1);
        SetUInt8 = fmi3SetUInt8(&vr("slider.mass"), 1, null(), 1);
        SetInt16 = fmi3SetInt16(&vr("slider.mass"), 1, null(), 1);
        SetUInt16 = fmi3SetUInt16(&vr("slider.mass"), 1, null(), 1);
        SetUInt32 = fmi3SetUInt32(&vr("slider.mass"), 1, null(), 1);
        SetUInt64 = fmi3SetUInt64(&vr("slider.mass"), 1, null(), 1);
        GetFMUState = fmi3GetFMUState(null_mut());
        GetFMUState = fmi3GetFMUState(&mut without_provenance_mut(0x1000));
        SetFMUState = fmi3SetFMUState(null_mut());
        SetFMUState = fmi3SetFMUState(without_provenance_mut(0x1000));
        FreeFMUState = fmi3FreeFMUState(&mut without_provenance_mut(0x1000));
        SerializedFMUStateSize = fmi3SerializedFMUStateSize(null_mut(), &mut 7);
        SerializedFMUStateSize = fmi3SerializedFMUStateSize(null_mut(), null_mut());
        SerializeFMUState = fmi3SerializeFMUState(null_mut(), null_mut(), 100);
        SerializeFMUState = fmi3SerializeFMUState(without_provenance_mut(0x1000), &mut 7, 1);
        DeserializeFMUState = fmi3DeserializeFMUState(null(), 100, &mut null_mut());
        DeserializeFMUState = fmi3DeserializeFMUState(&7, 1, &mut null_mut());
        DeserializeFMUState = fmi3DeserializeFMUState(&7, 0, &mut null_mut());
        GetDirectionalDerivative = fmi3GetDirectionalDerivative(null(), 1, null(), 1, null(), 1, null_mut(), 1);
        GetDirectionalDerivative = fmi3GetDirectionalDerivative(
            &vr("slider.a"), 1, &vr("slider.load"), 1, &1.0, 2, &mut 7.0, 1);
        GetDirectionalDerivative = fmi3GetDirectionalDerivative(
            &vr("slider.a"), 1, &vr("slider.x"), 1, &1.0, 1, &mut 7.0, 1);
        GetAdjointDerivative = fmi3GetAdjointDerivative(null(), 1, null(), 1, null(), 1, null_mut(), 1);
        GetAdjointDerivative = fmi3GetAdjointDerivative(
            &vr("slider.a"), 1, &vr("slider.load"), 1, &1.0, 1, &mut 7.0, 2);
        GetAdjointDerivative = fmi3GetAdjointDerivative(
            &vr("slider.load"), 1, &vr("slider.load"), 1, &1.0, 1, &mut 7.0, 1);
        GetOutputDerivatives = fmi3GetOutputDerivatives(null(), 1, null(), null_mut(), 1);
        GetOutputDerivatives = fmi3GetOutputDerivatives(&vr("slider.x"), 1, &2, &mut 7.0, 1);
        GetOutputDerivatives = fmi3GetOutputDerivatives(&vr("slider.x"), 1, &1, &mut 7.0, 0);
        GetOutputDerivatives = fmi3GetOutputDerivatives(&time_reference(), 1, &1, &mut 7.0, 1);
        CompletedIntegratorStep = fmi3CompletedIntegratorStep(1, null_mut(), null_mut());
        SetTime = fmi3SetTime(f64::NAN);
        SetTime = fmi3SetTime(f64::INFINITY);
        SetContinuousStates = fmi3SetContinuousStates(null(), 2);
        SetContinuousStates = fmi3SetContinuousStates(&1.0, 1);
        SetContinuousStates = fmi3SetContinuousStates([1.0, f64::NAN].as_ptr(), 2);
        GetContinuousStateDerivatives = fmi3GetContinuousStateDerivatives(null_mut(), 2);
        GetContinuousStateDerivatives = fmi3GetContinuousStateDerivatives(&mut 7.0, 1);
        GetEventIndicators = fmi3GetEventIndicators(null_mut(), 1);
        GetEventIndicators = fmi3GetEventIndicators(null_mut(), 0);
        GetContinuousStates = fmi3GetContinuousStates(null_mut(), 2);
        GetContinuousStates = fmi3GetContinuousStates([7.0; 3].as_mut_ptr(), 3);
        GetNominalsOfContinuousStates = fmi3GetNominalsOfContinuousStates(null_mut(), 2);
        GetNumberOfEventIndicators = fmi3GetNumberOfEventIndicators(null_mut());
        GetNumberOfContinuousStates = fmi3GetNumberOfContinuousStates(null_mut());
        // Not provided.
        ActivateModelPartition = fmi3ActivateModelPartition(0, 0.0);
        EnterConfigurationMode = fmi3EnterConfigurationMode();
        ExitConfigurationMode = fmi3ExitConfigurationMode();
        GetClock = fmi3GetClock(null(), 1, null_mut());
        GetClock = fmi3GetClock(&vr("slider.x"), 1, &mut 7);
        GetClock = fmi3GetClock(&FIRST_CLOCK, 1, &mut 7);
        GetFloat64 = fmi3GetFloat64(&FIRST_CLOCK, 1, &mut 7.0, 1);
        GetFloat64 = fmi3GetFloat64(&(FIRST_INDICATOR + 6), 1, &mut 7.0, 1);
        SetFloat64 = fmi3SetFloat64(&FIRST_INDICATOR, 1, &1.0, 1);
        SetClock = fmi3SetClock(null(), 1, null());
        GetIntervalDecimal = fmi3GetIntervalDecimal(null(), 1, null_mut(), null_mut());
        GetIntervalFraction = fmi3GetIntervalFraction(null(), 1, null_mut(), null_mut(), null_mut());
        GetShiftDecimal = fmi3GetShiftDecimal(null(), 1, null_mut());
        GetShiftFraction = fmi3GetShiftFraction(null(), 1, null_mut(), null_mut());
        SetIntervalDecimal = fmi3SetIntervalDecimal(null(), 1, null());
        SetIntervalFraction = fmi3SetIntervalFraction(null(), 1, null(), null());
        SetShiftDecimal = fmi3SetShiftDecimal(null(), 1, null());
        SetShiftFraction = fmi3SetShiftFraction(null(), 1, null(), null());
        EvaluateDiscreteStates = fmi3EvaluateDiscreteStates();
        GetNumberOfVariableDependencies = fmi3GetNumberOfVariableDependencies(0, null_mut());
        GetVariableDependencies = fmi3GetVariableDependencies(0, null_mut(), null_mut(), null_mut(), null_mut(), 1);
    }
}

/// Calls without arguments to object to: right in some states only.
fn transitions() -> Vec<Attempt> {
    attempts! {
        EnterInitializationMode = fmi3EnterInitializationMode(0, 0.0, 0.0, 0, 0.0);
        ExitInitializationMode = fmi3ExitInitializationMode();
        EnterEventMode = fmi3EnterEventMode();
        UpdateDiscreteStates = fmi3UpdateDiscreteStates(&mut 0, &mut 0, &mut 0, &mut 0, &mut 0, &mut 0.0);
        EnterStepMode = fmi3EnterStepMode();
        EnterContinuousTimeMode = fmi3EnterContinuousTimeMode();
        CompletedIntegratorStep = fmi3CompletedIntegratorStep(1, &mut 0, &mut 0);
        SetTime = fmi3SetTime(0.25);
        SetContinuousStates = fmi3SetContinuousStates([0.5, 100.0].as_ptr(), 2);
        GetContinuousStates = fmi3GetContinuousStates([0.0; 2].as_mut_ptr(), 2);
        GetContinuousStateDerivatives = fmi3GetContinuousStateDerivatives([0.0; 2].as_mut_ptr(), 2);
        GetNominalsOfContinuousStates = fmi3GetNominalsOfContinuousStates([0.0; 2].as_mut_ptr(), 2);
        GetEventIndicators = fmi3GetEventIndicators(&mut 0.0, 1);
        GetNumberOfContinuousStates = fmi3GetNumberOfContinuousStates(&mut 0);
        GetNumberOfEventIndicators = fmi3GetNumberOfEventIndicators(&mut 0);
        DoStep = fmi3DoStep(0.0, 1e-6, 1, &mut 0, &mut 0, &mut 0, &mut 0.0);
        Terminate = fmi3Terminate();
        Reset = fmi3Reset();
    }
}

/// All that an instance is.
fn memory(slave: &Handle) -> Vec<u8> {
    let mut state = slave.save();
    let bytes = slave.bytes_of(state);
    // SAFETY: live instance, one place.
    assert_eq!(unsafe { fmi3FreeFMUState(slave.0, &mut state) }, Status::Ok);
    bytes
}

fn objection(slave: &Slave, (call, attempt): &Attempt) -> Option<String> {
    let answer = attempt(slave.0);
    let lines = slave.lines();
    let [line] = &lines[..] else {
        return Some(format!("{answer:?}, lines {lines:?}"));
    };
    let told = line.text.starts_with(&format!("{}: ", call.name())) && line.status == Status::Error as i32;
    (answer != Status::Error || !told).then(|| format!("{answer:?}, {line:?}"))
}

#[test]
fn what_is_never_possible_is_refused_in_every_state_and_changes_nothing() {
    for state in STATES {
        let slave = in_state(state);
        let before = memory(&slave);
        for (number, attempt) in impossible().iter().enumerate() {
            assert_eq!(objection(&slave, attempt), None, "{number}: {} in {state:?}", attempt.0.name());
        }
        assert!(memory(&slave) == before, "in {state:?}");
    }
}

#[test]
fn transitions_are_refused_where_the_table_says_so() {
    for state in STATES {
        let slave = in_state(state);
        let before = memory(&slave);
        for attempt in transitions() {
            if !possible(attempt.0, state) {
                assert_eq!(objection(&slave, &attempt), None, "{} in {state:?}", attempt.0.name());
            }
        }
        assert!(memory(&slave) == before, "in {state:?}");
        for attempt in transitions().iter().filter(|(call, _)| possible(*call, state)) {
            let slave = in_state(state);
            let answer = attempt.1(slave.0);
            assert_eq!(answer, Status::Ok, "{} in {state:?}: {:?}", attempt.0.name(), slave.lines());
        }
    }
}

#[test]
fn every_function_that_takes_an_instance_is_tried() {
    let tried: Vec<Call> = impossible().iter().chain(&transitions()).map(|(call, _)| *call).collect();
    let without = [
        Call::GetVersion,
        Call::InstantiateCoSimulation,
        Call::InstantiateModelExchange,
        Call::InstantiateScheduledExecution,
        Call::FreeInstance,
    ];
    for call in Call::ALL {
        assert!(tried.contains(call) || without.contains(call), "{}", call.name());
    }
}

#[test]
fn null_is_no_instance() {
    for (call, attempt) in impossible().iter().chain(&transitions()) {
        for instance in [null_mut(), without_provenance_mut(1)] {
            assert_eq!(attempt(instance), Status::Error, "{}", call.name());
        }
    }
    // SAFETY: NULL is allowed.
    unsafe { fmi3FreeInstance(null_mut()) };
}

#[test]
fn nothing_is_possible_within_a_step_but_reading_and_setting() {
    let objections = Rc::new(RefCell::new(None));
    let found = Rc::clone(&objections);
    let update = move |slave: &Handle, _: f64, _: bool| {
        found.borrow_mut().get_or_insert_with(|| {
            let answers =
                impossible().into_iter().chain(transitions()).filter(|(_, attempt)| attempt(slave.0) != Status::Error);
            answers.map(|(call, _)| call.name()).collect::<Vec<_>>()
        });
        None
    };
    let update = Some(Box::new(update) as Callback);
    let slave = Slave::running(Options { intermediate: &["slider.x"], update, ..Options::default() });
    slave.step(0.0, 2e-3);
    assert_eq!(objections.take(), Some(vec![]));
    let other = Slave::running(Options::default());
    other.step(0.0, 2e-3);
    assert_eq!(slave.picture(), other.picture());
}

#[test]
fn what_cannot_be_instantiated_is_null() {
    // SAFETY: strings that end in zero, and no callbacks.
    unsafe {
        let token = host::guid();
        let (name, token) = (c"x".as_ptr(), token.as_ptr());
        let scheduled =
            fmi3InstantiateScheduledExecution(name, token, null(), 0, 1, null_mut(), None, None, None, None);
        assert!(scheduled.is_null());
        for (name, token) in [(null(), token), (c"".as_ptr(), token), (c" \t".as_ptr(), token), (name, null())] {
            let made = fmi3InstantiateCoSimulation(name, token, null(), 0, 0, 0, 0, null(), 0, null_mut(), None, None);
            assert!(made.is_null());
            assert!(fmi3InstantiateModelExchange(name, token, null(), 0, 0, null_mut(), None).is_null());
        }
        let made = fmi3InstantiateCoSimulation(name, token, null(), 0, 0, 0, 0, null(), 5, null_mut(), None, None);
        assert!(made.is_null(), "an array of five that is NULL");
    }
}

#[test]
fn the_answers_of_a_step_may_share_a_place() {
    let slave = Slave::running(Options::EVENTS);
    let mut time = 7.0_f64;
    let place = (&raw mut time).cast::<u8>();
    // SAFETY: live instance; one place for all.
    let status = unsafe { fmi3DoStep(slave.0, 0.0, 1e-6, 1, place, place, place, &raw mut time) };
    assert_eq!((status, time), (Status::Ok, 1e-6));
}
