//! What can be wrong with each argument of each function, and what the importer is told of it.

pub mod handles;
pub mod numbers;
pub mod references;

use crate::importers_memory::{ImportersMemory, odd};
use crate::invoke::{NULL, Word};
use crate::stage::Stage;
use handles::Handles;
use host::exchange::STATES;
use numbers::{NOT_FINITE, communication, experiment, time};
use references::References;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::lifecycle::Call;
use slidercrank::fmi::v2::lifecycle::Call::*;
use std::ffi::c_void;

/// What a value is refused for, or obeyed with a reservation.
#[derive(Clone, Debug)]
pub struct Fault {
    pub status: Status,
    /// Words of which the log's line has some; without any, nothing can be said.
    pub words: Vec<String>,
}

impl Fault {
    /// Of a length that is not the one needed.
    pub fn needed() -> Self {
        Self { status: Status::Error, words: vec!["are needed".into()] }
    }
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
    /// Place of the length that this one has to equal.
    pub equals: Option<usize>,
}

pub fn good(word: Word) -> Value {
    Value { word, fault: None }
}

pub fn bad(word: Word, words: impl Into<String>) -> Value {
    Value { word, fault: Some(Fault { status: Status::Error, words: vec![words.into()] }) }
}

impl From<Vec<Value>> for Argument {
    fn from(values: Vec<Value>) -> Self {
        Self { values, counted_by: None, equals: None }
    }
}

impl Argument {
    /// Not looked at while the argument at `place` is 0.
    pub fn counted_by(self, place: usize) -> Self {
        Self { counted_by: Some(place), ..self }
    }

    /// A length that has to be the same as the one at `place`.
    pub fn equal_to(self, place: usize) -> Self {
        let values = self.values.into_iter().map(|value| good(value.word)).collect();
        Self { values, equals: Some(place), ..self }
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
pub const HUGE: [usize; 4] = [(1 << 24) + 1, 1 << 40, usize::MAX / 8, usize::MAX];

/// An array of `entries`, or of others that are refused with these words.
pub fn array<T: Copy + 'static>(
    memory: &ImportersMemory,
    name: &str,
    entries: Vec<T>,
    faulty: Vec<(Vec<T>, &str)>,
) -> Argument {
    let whole = memory.array(entries);
    let mut values = vec![good(whole), bad(NULL, format!("'{name}' is NULL"))];
    if align_of::<T>() > 1 {
        values.push(bad(odd(whole), format!("'{name}' is not aligned")));
    }
    values.extend(faulty.into_iter().map(|(entries, words)| bad(memory.array(entries), words)));
    values.into()
}

/// A place for an answer.
pub fn place<T: Copy + 'static>(memory: &ImportersMemory, name: &str, before: T) -> Argument {
    array(memory, name, vec![before], vec![])
}

/// The length of arrays.
pub fn count(length: usize) -> Argument {
    let huge = HUGE.map(|length| bad(Word::Size(length), format!("{length} elements")));
    [good(Word::Size(length)), good(Word::Size(0))].into_iter().chain(huge).collect::<Vec<_>>().into()
}

/// A Boolean of FMI 2.0, of which every number is one.
pub fn flag() -> Argument {
    [1, 0, -1, i32::MIN, i32::MAX].map(|value| good(Word::Integer(value))).to_vec().into()
}

/// An instance.
pub fn instance(pointer: *mut c_void) -> Argument {
    let c = Word::Pointer(pointer);
    let silent = |word| Value { word, fault: Some(Fault { status: Status::Error, words: vec![] }) };
    vec![good(c), silent(NULL), silent(odd(c))].into()
}

/// The arguments of a function for this instance, one list of values each.
pub fn arguments(call: Call, stage: &Stage) -> Vec<Argument> {
    let mut list = match call {
        GetTypesPlatform | GetVersion | Instantiate => return vec![],
        _ => vec![instance(stage.slave.c)],
    };
    let references = References::of(call, stage);
    let Stage { saved, theirs, ref slave, .. } = *stage;
    let handles = Handles {
        name: "FMUstate",
        saved,
        theirs,
        instance: slave.c,
        stale: freed(stage),
        bytes: slave.bytes_of(saved),
    };
    list.extend(match call {
        SetDebugLogging => [vec![flag()], categories(&stage.memory)].concat(),
        SetupExperiment => experiment(&flag()),
        GetReal | GetInteger | GetBoolean | GetString => references.read(),
        SetReal | SetInteger | SetBoolean | SetString => references.write(),
        GetDirectionalDerivative => references.sensitivity(),
        SetRealInputDerivatives | GetRealOutputDerivatives => references.derivatives(),
        GetFMUstate => vec![handles.place(&stage.memory, false)],
        SetFMUstate => vec![handles.state()],
        FreeFMUstate => vec![handles.place(&stage.memory, true)],
        SerializedFMUstateSize => vec![handles.state(), place(&stage.memory, "size", 0_usize)],
        SerializeFMUstate => handles.serialize(&stage.memory),
        DeSerializeFMUstate => handles.deserialize(&stage.memory),
        DoStep => [communication(stage.now), vec![flag()]].concat(),
        GetStatus => query(Some(0), place(&stage.memory, "value", 0_i32)),
        GetRealStatus => query(Some(2), place(&stage.memory, "value", 0.0)),
        GetBooleanStatus => query(Some(3), place(&stage.memory, "value", 0_i32)),
        GetIntegerStatus => query(None, place(&stage.memory, "value", 0_i32)),
        GetStringStatus => query(None, place(&stage.memory, "value", 0_usize)),
        // As many bytes as an fmi2EventInfo.
        NewDiscreteStates => vec![place(&stage.memory, "fmi2EventInfo", [0_u64; 4])],
        CompletedIntegratorStep => {
            vec![
                flag(),
                place(&stage.memory, "enterEventMode", 0_i32),
                place(&stage.memory, "terminateSimulation", 0_i32),
            ]
        }
        SetTime => vec![time()],
        SetContinuousStates => {
            let faulty = NOT_FINITE.map(|number| (vec![1.0, number], "continuous state 2 = "));
            sized(array(&stage.memory, "x", vec![1.0; STATES], faulty.to_vec()), "continuous states", STATES)
        }
        GetContinuousStates => sized(array(&stage.memory, "x", vec![0.0; STATES], vec![]), "continuous states", STATES),
        GetDerivatives => {
            sized(array(&stage.memory, "derivatives", vec![0.0; STATES], vec![]), "continuous states", STATES)
        }
        GetNominalsOfContinuousStates => {
            sized(array(&stage.memory, "x_nominal", vec![0.0; STATES], vec![]), "continuous states", STATES)
        }
        GetEventIndicators => {
            sized(array(&stage.memory, "eventIndicators", vec![0.0; STATES], vec![]), "event indicators", 1)
        }
        _ => vec![],
    });
    list
}

/// An array of what is counted as `of`, and its length, which has to be `length`.
pub fn sized(entries: Argument, of: &str, length: usize) -> Vec<Argument> {
    let mut lengths = vec![good(Word::Size(length))];
    let others = [0, length + 1].into_iter().filter(|other| *other != length);
    lengths.extend(others.map(|other| bad(Word::Size(other), format!("{other} {of}, where there are {length}"))));
    lengths.extend(HUGE.map(|length| bad(Word::Size(length), format!("{length} elements"))));
    vec![entries.counted_by(2), lengths.into()]
}

/// Number and names of log categories.
pub fn categories(memory: &ImportersMemory) -> Vec<Argument> {
    let pointer = |text: &[u8]| match memory.text(text) {
        Word::Pointer(pointer) => pointer,
        _ => std::ptr::null_mut(),
    };
    let all = || pointer(b"logAll");
    let no_name = (vec![all(), std::ptr::null_mut()], "'an entry of categories' is NULL");
    let mut names = array(memory, "categories", vec![all(), pointer(b"logStatusError")], vec![no_name]);
    for (entries, words) in [
        (vec![pointer(b"nonsense"), all()], "log category 'nonsense'"),
        (vec![all(), pointer(b"")], "log category ''"),
        (vec![all(), pointer(b"log\xff\xfe%d\n")], "log category 'log"),
    ] {
        let fault = Some(Fault { status: Status::Warning, words: vec![words.into()] });
        names.values.push(Value { word: memory.array(entries), fault });
    }
    vec![count(2), names.counted_by(2)]
}

fn freed(stage: &Stage) -> *mut c_void {
    let mut state = stage.slave.save();
    let stale = state;
    assert_eq!(stage.slave.free(&mut state), Status::Ok);
    stale
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
