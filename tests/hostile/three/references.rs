//! Every function that takes value references, in every state, with every variable there is.

use super::invoke::invoke;
use super::stage::{STATES, Stage, Use};
use crate::exchanged::counts;
use crate::invoke::Word;
use crate::product::Staged;
use host::vr;
use slidercrank::fmi::slave::ValueType;
use slidercrank::fmi::slave::variables::{Access, STATES as STATE_VARIABLES, VARIABLES, Variable};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::lifecycle::Call::{self, *};
use slidercrank::fmi::v3::lifecycle::{State, Touch};
use slidercrank::fmi::v3::variables::time_reference;
use slidercrank::model_description::arrays::{CONTACTS as CORNER_CONTACTS, PENETRATIONS};
use slidercrank::model_description::clocks::FIRST_CLOCK;
use slidercrank::model_description::exchange::{FIRST_DERIVATIVE, FIRST_INDICATOR, FIRST_STATE};
use slidercrank::simulation::{CONTACTS, contacts};

/// The functions of a type.
type Functions = (Call, Call);

const REALS: Functions = (GetFloat64, SetFloat64);
const BOOLEANS: Functions = (GetBoolean, SetBoolean);

/// Functions of types that a variable may have, …
const TYPES: [Functions; 4] = [REALS, (GetInt32, SetInt32), (GetInt64, SetInt64), BOOLEANS];
/// … and of those that no variable has.
const ABSENT: [Functions; 9] = [
    (GetFloat32, SetFloat32),
    (GetInt8, SetInt8),
    (GetUInt8, SetUInt8),
    (GetInt16, SetInt16),
    (GetUInt16, SetUInt16),
    (GetUInt32, SetUInt32),
    (GetUInt64, SetUInt64),
    (GetString, SetString),
    (GetBinary, SetBinary),
];

/// What a value reference means to the functions that reach it.
struct Meaning {
    reference: u32,
    of: Functions,
    values: usize,
    reading: bool,
    writing: bool,
    /// A legal value.
    value: f64,
}

fn neutral(stage: &Stage, variable: &Variable, reference: u32) -> Meaning {
    let of = TYPES[match ValueType::of(variable) {
        ValueType::Real => 0,
        ValueType::Integer => 1,
        ValueType::Enumeration => 2,
        ValueType::Boolean => 3,
    }];
    let (get, set, value) = match variable.access {
        Access::Input { start, .. } => (Touch::GetInput, Touch::SetInput, start),
        Access::Parameter(parameter) => (Touch::GetParameter, Touch::SetParameter, parameter.value(&stage.scene())),
        _ => (Touch::GetOutput, Touch::SetOutput, 1.0),
    };
    Meaning { reference, of, values: 1, reading: get.allowed(stage.state), writing: set.allowed(stage.state), value }
}

/// What FMI 2.0 does not have, or has in model exchange alone.
fn others(stage: &Stage) -> Vec<Meaning> {
    let seen = Touch::GetOutput.allowed(stage.state);
    let meaning =
        |reference, of, values, reading| Meaning { reference, of, values, reading, writing: false, value: 1.0 };
    let (states, indicators) = match stage.usage {
        Use::Exchange => counts(),
        // A worn slider pin, but those of the packaged scene: none of its indicators is left.
        _ => (2, 0),
    };
    let settable = stage.usage == Use::Exchange && matches!(stage.state, State::EventMode | State::ContinuousTimeMode);
    let mut all = vec![
        meaning(time_reference(), REALS, 1, true),
        meaning(PENETRATIONS, REALS, 4, seen),
        meaning(CORNER_CONTACTS, BOOLEANS, 4, seen),
    ];
    all.extend((0..CONTACTS).map(|at| meaning(FIRST_INDICATOR + at as u32, REALS, 1, seen && at < indicators)));
    all.extend((0..STATE_VARIABLES.len()).flat_map(|at| {
        let place = at as u32;
        let state = meaning(FIRST_STATE + place, REALS, 1, seen && at < states);
        let writing = settable && at < states;
        [Meaning { writing, ..state }, meaning(FIRST_DERIVATIVE + place, REALS, 1, seen && at < states)]
    }));
    all
}

/// Calls a function that reads or sets one variable.
fn touch(stage: &Stage, call: Call, Meaning { reference, values, value, .. }: &Meaning) -> Status {
    let memory = &stage.memory;
    let reference = memory.array(vec![*reference]);
    let place = match call {
        GetFloat64 | SetFloat64 => memory.array(vec![*value; *values]),
        GetInt32 | SetInt32 => memory.array(vec![*value as i32; *values]),
        GetInt64 | SetInt64 => memory.array(vec![*value as i64; *values]),
        GetBoolean | SetBoolean => memory.array(vec![*value as u8; *values]),
        _ => memory.array(vec![0_u64; *values]),
    };
    let mut words = vec![Word::Pointer(stage.slave.0), reference, Word::Size(1), place, Word::Size(*values)];
    if matches!(call, GetBinary | SetBinary) {
        words.insert(3, memory.array(vec![0_usize; *values]));
    }
    // SAFETY: live instance, arrays of the lengths said.
    unsafe { invoke(call, &words) }.expect("a status")
}

/// One line that says why, or none.
fn judge(stage: &Stage, call: Call, reference: u32, status: Status, wanted: bool) {
    let lines = stage.lines();
    let what = || format!("{} of {reference} in {:?} '{}': {lines:?}", call.name(), stage.usage, stage.state);
    assert_eq!(status, if wanted { Status::Ok } else { Status::Error }, "{}", what());
    assert_eq!(lines.len(), usize::from(!wanted), "{}", what());
    assert!(lines.iter().all(|line| line.text.starts_with(call.name())), "{}", what());
    stage.memory.clear();
}

#[test]
fn every_function_takes_the_variables_of_its_kind_and_refuses_the_others() {
    for at in STATES {
        let stage = Stage::reach(at, std::ptr::null_mut());
        let all = VARIABLES.iter().zip(0..).map(|(variable, reference)| neutral(&stage, variable, reference));
        for meaning in all.chain(others(&stage)) {
            for (get, set) in TYPES.into_iter().chain(ABSENT) {
                let own = meaning.of == (get, set);
                let reads = own && meaning.reading && stage.refusal(get).is_none();
                judge(&stage, get, meaning.reference, touch(&stage, get, &meaning), reads);
                let writes = own && meaning.writing && stage.refusal(set).is_none();
                judge(&stage, set, meaning.reference, touch(&stage, set, &meaning), writes);
            }
        }
    }
}

#[test]
fn derivatives_are_of_real_outputs_and_clocks_are_clocks() {
    for at in STATES {
        let stage = Stage::reach(at, std::ptr::null_mut());
        let clocks = contacts(&stage.scene());
        let names = (0..VARIABLES.len() as u32).chain([time_reference(), PENETRATIONS, u32::MAX]);
        for reference in names.chain((0..CONTACTS as u32).map(|contact| FIRST_CLOCK + contact)) {
            let real = VARIABLES.get(reference as usize);
            let real = real.is_some_and(|variable| matches!(variable.access, Access::RealOutput(_)));
            let memory = &stage.memory;
            let instance = Word::Pointer(stage.slave.0);
            let (one, place) = (Word::Size(1), memory.array(vec![0.0]));
            let rates = [instance, memory.array(vec![reference]), one, memory.array(vec![1]), place, one];
            // SAFETY: live instance, arrays of one entry.
            let status = unsafe { invoke(GetOutputDerivatives, &rates) }.expect("a status");
            judge(
                &stage,
                GetOutputDerivatives,
                reference,
                status,
                real && stage.refusal(GetOutputDerivatives).is_none(),
            );
            let ticks = [instance, memory.array(vec![reference]), one, memory.array(vec![7_u8])];
            // SAFETY: live instance, arrays of one entry.
            let status = unsafe { invoke(GetClock, &ticks) }.expect("a status");
            let clock = reference.checked_sub(FIRST_CLOCK).is_some_and(|contact| clocks.contains(&(contact as usize)));
            judge(&stage, GetClock, reference, status, clock && stage.refusal(GetClock).is_none());
            for call in [GetDirectionalDerivative, GetAdjointDerivative] {
                let (known, seed) = (memory.array(vec![vr("slider.load")]), memory.array(vec![1.0]));
                let place = memory.array(vec![0.0]);
                let words = [instance, memory.array(vec![reference]), one, known, one, seed, one, place, one];
                // SAFETY: live instance, arrays of one entry.
                let status = unsafe { invoke(call, &words) }.expect("a status");
                judge(&stage, call, reference, status, real && stage.refusal(call).is_none());
            }
        }
    }
}
