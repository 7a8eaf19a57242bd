//! What can be wrong with each argument of each function, and what the importer is told of it.

mod numbers;
mod references;

use crate::host::exchange::STATES;
use crate::invoke::{NULL, Word};
use crate::stage::{Stage, odd};
use numbers::{NOT_FINITE, communication, experiment, time};
use references::References;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::lifecycle::Call;
use slidercrank::fmi::v2::lifecycle::Call::*;
use std::ptr::without_provenance_mut;

/// What a value is refused for, or obeyed with a reservation.
#[derive(Clone, Debug)]
pub struct Fault {
    pub status: Status,
    /// Words of which the log's line has some; without any, nothing can be said.
    pub words: Vec<String>,
}

/// A value of an argument.
#[derive(Clone, Debug)]
pub struct Value {
    pub word: Word,
    pub fault: Option<Fault>,
}

/// An argument: a sound value, if there is one, and others.
#[derive(Clone, Debug)]
pub struct Argument {
    pub values: Vec<Value>,
    /// Place of the argument that tells, by 0, that this one is not looked at.
    pub counted_by: Option<usize>,
}

pub fn good(word: Word) -> Value {
    Value { word, fault: None }
}

pub fn bad(word: Word, words: impl Into<String>) -> Value {
    Value { word, fault: Some(Fault { status: Status::Error, words: vec![words.into()] }) }
}

impl From<Vec<Value>> for Argument {
    fn from(values: Vec<Value>) -> Self {
        Self { values, counted_by: None }
    }
}

impl Argument {
    /// Not looked at while the argument at `place` is 0.
    pub fn counted_by(self, place: usize) -> Self {
        Self { counted_by: Some(place), ..self }
    }

    /// Refused in any case: with these words, if not with its own.
    pub fn refused_as(mut self, words: &str) -> Self {
        for Value { word, fault } in &mut self.values {
            let mut all = bad(*word, words);
            if let (Some(all), Some(own)) = (&mut all.fault, fault.take()) {
                all.words.extend(own.words);
            }
            *fault = all.fault;
        }
        self
    }
}

/// More entries than any array has.
const HUGE: [usize; 4] = [(1 << 24) + 1, 1 << 40, usize::MAX / 8, usize::MAX];

/// An array of `entries`, or of others that are refused with these words.
pub fn array<T: Copy + 'static>(stage: &Stage, name: &str, entries: Vec<T>, faulty: Vec<(Vec<T>, &str)>) -> Argument {
    let whole = stage.array(entries);
    let mut values = vec![good(whole), bad(NULL, format!("'{name}' is NULL"))];
    if align_of::<T>() > 1 {
        values.push(bad(odd(whole), format!("'{name}' is not aligned")));
    }
    values.extend(faulty.into_iter().map(|(entries, words)| bad(stage.array(entries), words)));
    values.into()
}

/// A place for an answer.
fn place<T: Copy + 'static>(stage: &Stage, name: &str, before: T) -> Argument {
    array(stage, name, vec![before], vec![])
}

/// The length of arrays.
pub fn count(length: usize) -> Argument {
    let huge = HUGE.map(|length| bad(Word::Size(length), format!("{length} elements")));
    [good(Word::Size(length)), good(Word::Size(0))].into_iter().chain(huge).collect::<Vec<_>>().into()
}

/// A Boolean, of which every number is one.
pub fn flag(value: i32) -> Argument {
    [value, 1 - value, -1, i32::MIN, i32::MAX].map(|value| good(Word::Integer(value))).to_vec().into()
}

fn component(stage: &Stage) -> Argument {
    let c = Word::Pointer(stage.slave.c);
    let silent = |word| Value { word, fault: Some(Fault { status: Status::Error, words: vec![] }) };
    vec![good(c), silent(NULL), silent(odd(c))].into()
}

/// The arguments of a function for this instance, one list of values each.
pub fn arguments(call: Call, stage: &Stage) -> Vec<Argument> {
    let mut list = match call {
        GetTypesPlatform | GetVersion | Instantiate => return vec![],
        _ => vec![component(stage)],
    };
    let references = References::of(call, stage);
    list.extend(match call {
        SetDebugLogging => categories(stage),
        SetupExperiment => experiment(),
        GetReal | GetInteger | GetBoolean | GetString => references.read(),
        SetReal | SetInteger | SetBoolean | SetString => references.write(),
        GetDirectionalDerivative => references.sensitivity(),
        SetRealInputDerivatives | GetRealOutputDerivatives => references.derivatives(),
        GetFMUstate => vec![state_place(stage, false)],
        SetFMUstate => vec![state(stage)],
        FreeFMUstate => vec![state_place(stage, true)],
        SerializedFMUstateSize => vec![state(stage), place(stage, "size", 0_usize)],
        SerializeFMUstate => serialize(stage),
        DeSerializeFMUstate => deserialize(stage),
        DoStep => communication(stage),
        GetStatus => query(Some(0), place(stage, "value", 0_i32)),
        GetRealStatus => query(Some(2), place(stage, "value", 0.0)),
        GetBooleanStatus => query(Some(3), place(stage, "value", 0_i32)),
        GetIntegerStatus => query(None, place(stage, "value", 0_i32)),
        GetStringStatus => query(None, place(stage, "value", 0_usize)),
        // As many bytes as an fmi2EventInfo.
        NewDiscreteStates => vec![place(stage, "fmi2EventInfo", [0_u64; 4])],
        CompletedIntegratorStep => {
            vec![flag(1), place(stage, "enterEventMode", 0_i32), place(stage, "terminateSimulation", 0_i32)]
        }
        SetTime => vec![time()],
        SetContinuousStates => {
            let faulty = NOT_FINITE.map(|number| (vec![1.0, number], "continuous state 2 = "));
            sized(array(stage, "x", vec![1.0; STATES], faulty.to_vec()), "continuous states", STATES)
        }
        GetContinuousStates => sized(array(stage, "x", vec![0.0; STATES], vec![]), "continuous states", STATES),
        GetDerivatives => sized(array(stage, "derivatives", vec![0.0; STATES], vec![]), "continuous states", STATES),
        GetNominalsOfContinuousStates => {
            sized(array(stage, "x_nominal", vec![0.0; STATES], vec![]), "continuous states", STATES)
        }
        GetEventIndicators => sized(array(stage, "eventIndicators", vec![0.0; STATES], vec![]), "event indicators", 1),
        _ => vec![],
    });
    list
}

/// An array of what is counted as `of`, and its length, which has to be `length`.
fn sized(entries: Argument, of: &str, length: usize) -> Vec<Argument> {
    let mut lengths = vec![good(Word::Size(length))];
    lengths
        .extend([0, length + 1].map(|other| bad(Word::Size(other), format!("{other} {of}, where there are {length}"))));
    lengths.extend(HUGE.map(|length| bad(Word::Size(length), format!("{length} elements"))));
    vec![entries.counted_by(2), lengths.into()]
}

fn categories(stage: &Stage) -> Vec<Argument> {
    let pointer = |text: &[u8]| match stage.text(text) {
        Word::Pointer(pointer) => pointer,
        _ => std::ptr::null_mut(),
    };
    let all = || pointer(b"logAll");
    let no_name = (vec![all(), std::ptr::null_mut()], "'an entry of categories' is NULL");
    let mut names = array(stage, "categories", vec![all(), pointer(b"logStatusError")], vec![no_name]);
    for (entries, words) in [
        (vec![pointer(b"nonsense"), all()], "log category 'nonsense'"),
        (vec![all(), pointer(b"")], "log category ''"),
        (vec![all(), pointer(b"log\xff\xfe%d\n")], "log category 'log"),
    ] {
        let fault = Some(Fault { status: Status::Warning, words: vec![words.into()] });
        names.values.push(Value { word: stage.array(entries), fault });
    }
    vec![flag(1), count(2), names.counted_by(2)]
}

/// A saved state by value.
fn state(stage: &Stage) -> Argument {
    let Stage { saved, theirs, .. } = *stage;
    let unknown = [std::ptr::null_mut(), theirs, without_provenance_mut(0x1234), stage.slave.c, freed(stage)];
    let unknown = unknown.map(|state| bad(Word::Pointer(state), "FMUstate"));
    std::iter::once(good(Word::Pointer(saved))).chain(unknown).collect::<Vec<_>>().into()
}

/// A place that holds a saved state or, mostly, NULL.
fn state_place(stage: &Stage, or_none: bool) -> Argument {
    let place = |state| stage.array(vec![state]);
    let Stage { saved, theirs, .. } = *stage;
    let null = std::ptr::null_mut();
    let no_place = if or_none { good(NULL) } else { bad(NULL, "'FMUstate' is NULL") };
    let unknown = [theirs, without_provenance_mut(0x1234), stage.slave.c, freed(stage)];
    let mut values = vec![good(place(null)), good(place(saved)), no_place];
    values.push(bad(odd(place(null)), "'FMUstate' is not aligned"));
    values.extend(unknown.map(|state| bad(place(state), "FMUstate")));
    values.into()
}

fn freed(stage: &Stage) -> *mut std::ffi::c_void {
    let mut state = stage.slave.save();
    let stale = state;
    assert_eq!(stage.slave.free(&mut state), Status::Ok);
    stale
}

/// Bytes beyond the state in a buffer.
const SPARE: usize = 16;

fn serialize(stage: &Stage) -> Vec<Argument> {
    let length = stage.slave.bytes_of(stage.saved).len();
    let needed = format!("needs {length}");
    let mut sizes = vec![good(Word::Size(length)), good(Word::Size(length + SPARE))];
    sizes.extend([0, 1, length - 1].map(|size| bad(Word::Size(size), needed.clone())));
    sizes.extend(HUGE.map(|size| bad(Word::Size(size), "elements")));
    let bytes = array(stage, "serializedState", vec![0_u8; length + SPARE], vec![]);
    vec![state(stage), bytes.counted_by(3), sizes.into()]
}

fn deserialize(stage: &Stage) -> Vec<Argument> {
    let bytes = stage.slave.bytes_of(stage.saved);
    let with = |change: fn(&mut Vec<u8>)| {
        let mut bytes = [&bytes[..], &[0; SPARE]].concat();
        change(&mut bytes);
        bytes
    };
    let damaged = vec![
        (with(|bytes| bytes[0] ^= 1), "not a state of this FMU"),
        (with(|bytes| bytes[8] ^= 1), "format version"),
        (with(|bytes| bytes[100] ^= 1), "checksum"),
    ];
    let length = bytes.len();
    let mut sizes = vec![good(Word::Size(length)), good(Word::Size(length + SPARE))];
    sizes.extend([10, 50, length - 1].map(|size| bad(Word::Size(size), "instead of")));
    sizes.extend([0, 7].map(|size| bad(Word::Size(size), "not a state of this FMU")));
    sizes.extend(HUGE.map(|size| bad(Word::Size(size), "elements")));
    let bytes = array(stage, "serializedState", with(|_| ()), damaged);
    vec![bytes.counted_by(2), sizes.into(), state_place(stage, false)]
}

/// A status kind, of which `known` at most can be asked for, and the place of the answer.
fn query(known: Option<i32>, answer: Argument) -> Vec<Argument> {
    let kind = |kind: i32| {
        let value = good(Word::Integer(kind));
        if known == Some(kind) {
            value
        } else if (0..4).contains(&kind) {
            let fault = Fault { status: Status::Discard, words: vec!["there is no fmi2".into()] };
            Value { fault: Some(fault), ..value }
        } else {
            bad(value.word, format!("{kind} is not an fmi2StatusKind"))
        }
    };
    let mut kinds: Vec<_> = [0, 1, 2, 3, -1, 4, i32::MIN, i32::MAX].map(kind).to_vec();
    kinds.sort_by_key(|value| value.fault.as_ref().map(|fault| fault.status as i32));
    vec![kinds.into(), answer]
}
