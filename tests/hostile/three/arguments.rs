//! What can be wrong with each argument of each function of FMI 3.0.

use super::stage::{Stage, Use};
use crate::arguments::handles::Handles;
use crate::arguments::numbers::{NOT_FINITE, communication, experiment, time};
use crate::arguments::references::pair;
use crate::arguments::{Argument, HUGE, array, bad, categories, count, good, instance, place, sized};
use crate::exchanged::counts;
use crate::invoke::{NULL, Word};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::fmi3FreeFMUState;
use slidercrank::fmi::v3::lifecycle::Call::{self, *};
use slidercrank::fmi::v3::lifecycle::{State, Touch};
use slidercrank::fmi::v3::variables::time_reference;
use slidercrank::model_description::arrays::{CONTACTS as CORNER_CONTACTS, PENETRATIONS};
use slidercrank::model_description::clocks::FIRST_CLOCK;
use slidercrank::model_description::exchange::{FIRST_INDICATOR, FIRST_STATE};
use slidercrank::simulation::contacts;

/// References that no variable has.
const UNKNOWN: [u32; 2] = [u32::MAX, 1 << 24];

/// The arguments of a function for this instance, one list of values each.
pub fn arguments(call: Call, stage: &Stage) -> Vec<Argument> {
    let Stage { ref slave, saved, theirs, ref memory, now, .. } = *stage;
    let handles = || Handles {
        name: "FMUState",
        saved,
        bytes: slave.bytes_of(saved),
        stale: freed(stage),
        theirs,
        instance: slave.0,
    };
    let states = || if stage.usage == Use::Exchange { counts().0 } else { 2 };
    let of_states = |name: &str, start: f64| {
        let values = array(memory, name, vec![start; states().max(1)], vec![]);
        sized(values, "continuous states", states())
    };
    let mut list = vec![instance(slave.0)];
    list.extend(match call {
        SetDebugLogging => [vec![flag()], categories(memory)].concat(),
        EnterInitializationMode => experiment(&flag()),
        UpdateDiscreteStates => {
            let flags = ["discreteStatesNeedUpdate", "terminateSimulation", "nominalsOfContinuousStatesChanged"];
            let flags = flags.into_iter().chain(["valuesOfContinuousStatesChanged", "nextEventTimeDefined"]);
            let flags = flags.map(|name| place(memory, name, 7_u8));
            flags.chain([place(memory, "nextEventTime", 7.0)]).collect()
        }
        DoStep => {
            let flags = ["eventHandlingNeeded", "terminateSimulation", "earlyReturn"];
            let flags = flags.map(|name| place(memory, name, 7_u8));
            let answers = [place(memory, "lastSuccessfulTime", 7.0)];
            communication(now).into_iter().chain([flag()]).chain(flags).chain(answers).collect()
        }
        GetFloat64 | GetInt32 | GetInt64 | GetBoolean => read(call, stage),
        SetFloat64 | SetInt32 | SetInt64 | SetBoolean => write(call, stage),
        GetClock => clocks(stage),
        GetBinary | SetBinary => {
            let [references, nvr] = absent(call, stage);
            vec![references, nvr, null(), null(), lengths(2)]
        }
        GetFloat32 | GetInt8 | GetUInt8 | GetInt16 | GetUInt16 | GetUInt32 | GetUInt64 | GetString | SetFloat32
        | SetInt8 | SetUInt8 | SetInt16 | SetUInt16 | SetUInt32 | SetUInt64 | SetString => {
            let [references, nvr] = absent(call, stage);
            vec![references, nvr, null(), lengths(2)]
        }
        GetFMUState => vec![handles().place(memory, false)],
        SetFMUState => vec![handles().state()],
        FreeFMUState => vec![handles().place(memory, true)],
        SerializedFMUStateSize => vec![handles().state(), place(memory, "size", 0_usize)],
        SerializeFMUState => handles().serialize(memory),
        DeserializeFMUState => handles().deserialize(memory),
        GetDirectionalDerivative | GetAdjointDerivative => sensitivity(call, stage),
        GetOutputDerivatives => rates(stage),
        CompletedIntegratorStep => {
            vec![flag(), place(memory, "enterEventMode", 7_u8), place(memory, "terminateSimulation", 7_u8)]
        }
        SetTime => vec![time()],
        SetContinuousStates => {
            let faulty = |number: f64| {
                let mut states = vec![1.0; states()];
                states.last_mut().into_iter().for_each(|last| *last = number);
                states
            };
            let faulty = if states() == 0 {
                vec![]
            } else {
                NOT_FINITE.map(|number| (faulty(number), "continuous state ")).to_vec()
            };
            let values = array(memory, "continuousStates", vec![1.0; states().max(1)], faulty);
            sized(values, "continuous states", states())
        }
        GetContinuousStates => of_states("continuousStates", 0.0),
        GetContinuousStateDerivatives => of_states("derivatives", 0.0),
        GetNominalsOfContinuousStates => of_states("nominals", 0.0),
        GetEventIndicators => {
            let indicators = if stage.usage == Use::Exchange { counts().1 } else { 1 };
            sized(
                array(memory, "eventIndicators", vec![0.0; indicators.max(1)], vec![]),
                "event indicators",
                indicators,
            )
        }
        GetNumberOfContinuousStates => vec![place(memory, "nContinuousStates", 0_usize)],
        GetNumberOfEventIndicators => vec![place(memory, "nEventIndicators", 0_usize)],
        _ => not_provided(call),
    });
    list
}

/// C's `bool`, of which every byte is one.
fn flag() -> Argument {
    [1, 0, 255].map(|value| good(Word::Byte(value))).to_vec().into()
}

/// What is not looked at.
fn null() -> Argument {
    vec![good(NULL)].into()
}

/// Any lengths.
fn lengths(sound: usize) -> Argument {
    let others = [0, 1, sound + 1, usize::MAX].map(|length| good(Word::Size(length)));
    [good(Word::Size(sound))].into_iter().chain(others).collect::<Vec<_>>().into()
}

/// Arguments of a function that is always refused.
fn not_provided(call: Call) -> Vec<Argument> {
    let (pointer, number) = (null(), || vec![good(Word::Real(f64::NAN))].into());
    let reference = || vec![good(Word::Reference(u32::MAX))].into();
    let pointers = |count: usize| vec![pointer.clone(); count];
    match call {
        ActivateModelPartition => vec![reference(), number()],
        SetClock | GetShiftDecimal | SetIntervalDecimal | SetShiftDecimal => {
            [pointers(1), vec![lengths(1)], pointers(1)].concat()
        }
        GetIntervalDecimal | GetShiftFraction | SetIntervalFraction | SetShiftFraction => {
            [pointers(1), vec![lengths(1)], pointers(2)].concat()
        }
        GetIntervalFraction => [pointers(1), vec![lengths(1)], pointers(3)].concat(),
        GetNumberOfVariableDependencies => vec![reference(), pointer],
        GetVariableDependencies => [vec![reference()], pointers(4), vec![lengths(1)]].concat(),
        _ => vec![],
    }
}

fn freed(stage: &Stage) -> *mut std::ffi::c_void {
    let mut state = stage.slave.save();
    let stale = state;
    // SAFETY: live instance, one place.
    assert_eq!(unsafe { fmi3FreeFMUState(stage.slave.0, &mut state) }, Status::Ok);
    stale
}

/// Two references.
fn list(stage: &Stage, sound: [&str; 2], others: &[([&str; 2], &str)]) -> Argument {
    pair(&stage.memory, "valueReferences", sound, others, &UNKNOWN)
}

/// A list of references, their number, values, and their number. Lists without references have no values.
fn with_values(references: Argument, values: Argument) -> Vec<Argument> {
    let huge = HUGE.map(|length| bad(Word::Size(length), format!("{length} elements")));
    let nvr: Vec<_> = [good(Word::Size(2)), good(Word::Size(0))].into_iter().chain(huge).collect();
    vec![references.counted_by(2), nvr.into(), values.counted_by(4), lengths(2).equal_to(2)]
}

/// `words` unless variables may be touched so in the stage's state.
fn unless(touch: Touch, stage: &Stage, words: &'static str) -> &'static str {
    if touch.allowed(stage.state) { "" } else { words }
}

/// The same references, and others with other numbers of values or other meanings.
fn of_version_3(stage: &Stage, mut references: Argument, others: &[([u32; 2], &str)]) -> Argument {
    for (pair, words) in others {
        let word = stage.memory.array(pair.to_vec());
        references.values.push(if words.is_empty() { good(word) } else { bad(word, *words) });
    }
    references
}

fn read(call: Call, stage: &Stage) -> Vec<Argument> {
    let output = |words| unless(Touch::GetOutput, stage, words);
    let memory = &stage.memory;
    let (references, values) = match call {
        GetFloat64 => {
            let others = [
                (["gravity", "slider.x"], output("slider.x (output) cannot be read")),
                (["slider.a", "slider.load"], output("slider.a (output) cannot be read")),
                (["slider.a", "solver.steps"], "solver.steps is of type Int32, not Float64"),
                (["joint.C.contact", "gravity"], "joint.C.contact is of type Boolean, not Float64"),
                (["gravity", "drive.mode"], "drive.mode is of type Int64 (Enumeration), not Float64"),
            ];
            // Where outputs are read, what is absent is told; elsewhere nothing is.
            let seen = Touch::GetOutput.allowed(stage.state);
            let absent = |words| if seen { words } else { "(local variable) cannot be read" };
            // A guide with play has the last of them.
            let last_indicator = if counts().1 > 6 { "" } else { "the scene has no event indicator of this number" };
            let (sound, clock) = (list(stage, ["gravity", "crank.torque"], &others), FIRST_CLOCK + 2);
            let others = [
                ([time_reference(); 2], ""),
                ([time_reference(), PENETRATIONS], "5 are needed"),
                ([clock, time_reference()], "a clock is of type Clock, not Float64"),
                ([time_reference(), FIRST_STATE + 63], absent("the scene has no continuous state 64")),
                ([FIRST_INDICATOR + 6, time_reference()], absent(last_indicator)),
            ];
            (of_version_3(stage, sound, &others), array(memory, "values", vec![0.0; 2], vec![]))
        }
        GetInt32 => {
            let others = [
                (["solver.max_evaluations", "solver.steps"], output("solver.steps (output) cannot be read")),
                (["solver.max_evaluations", "slider.x"], "slider.x is of type Float64, not Int32"),
                (["drive.mode", "solver.max_evaluations"], "drive.mode is of type Int64 (Enumeration), not Int32"),
            ];
            let sound = ["solver.max_evaluations", "rod.flexible.bending_modes"];
            (list(stage, sound, &others), array(memory, "values", vec![0_i32; 2], vec![]))
        }
        GetInt64 => {
            let others = [
                (["drive.mode", "solver.steps"], "solver.steps is of type Int32, not Int64"),
                (["energy.audit", "drive.mode"], "energy.audit is of type Boolean, not Int64"),
            ];
            (list(stage, ["drive.mode", "joint.C.law"], &others), array(memory, "values", vec![0_i64; 2], vec![]))
        }
        _ => {
            let others = [
                (["energy.audit", "joint.C.contact"], output("joint.C.contact (output) cannot be read")),
                (["energy.audit", "slider.load"], "slider.load is of type Float64, not Boolean"),
            ];
            let sound = list(stage, ["energy.audit", "rod.flexible.geometric_stiffness"], &others);
            let others = [([CORNER_CONTACTS; 2], "8 are needed")];
            (of_version_3(stage, sound, &others), array(memory, "values", vec![7_u8; 2], vec![]))
        }
    };
    with_values(references, values)
}

fn write(call: Call, stage: &Stage) -> Vec<Argument> {
    let memory = &stage.memory;
    let (references, mut values) = match call {
        SetFloat64 => {
            let gravity = unless(Touch::SetParameter, stage, "gravity (fixed parameter) cannot be set");
            let others = [
                (["slider.load", "gravity"], gravity),
                (["slider.load", "slider.x"], "slider.x (output) cannot be set"),
                (["slider.load", "drive.mode"], "drive.mode is of type Int64 (Enumeration), not Float64"),
                (["slider.load", "joint.T.contacts"], "joint.T.contacts is of type Int32, not Float64"),
            ];
            let references = list(stage, ["slider.load", "crank.torque"], &others);
            let time = format!("value reference {}", time_reference());
            let others = [([vr("slider.load"), time_reference()], &*time), ([PENETRATIONS; 2], "value reference")];
            let faulty = NOT_FINITE.map(|number| (vec![1.0, number], "is not a finite number"));
            let mut values = array(memory, "values", vec![1.0, 2.0], faulty.to_vec());
            values.values.extend([f64::MAX, 5e-324].map(|extreme| good(memory.array(vec![extreme, 2.0]))));
            return with_values(of_version_3(stage, references, &others), values);
        }
        SetInt32 => {
            let others = [
                (["solver.max_evaluations", "solver.steps"], "solver.steps (output) cannot be set"),
                (["solver.max_evaluations", "slider.load"], "slider.load is of type Float64, not Int32"),
            ];
            let references = list(stage, ["solver.max_evaluations"; 2], &others);
            let faulty = [[5, -1], [5, i32::MIN], [i32::MAX, 5]];
            let faulty = faulty.map(|numbers| (numbers.to_vec(), "is out of range; allowed: "));
            let values = array(memory, "values", vec![1000_i32, 2000], faulty.to_vec());
            (settable(stage, references, "solver.max_evaluations (fixed parameter) cannot be set"), values)
        }
        SetInt64 => {
            let others = [
                (["joint.C.law", "solver.steps"], "solver.steps is of type Int32, not Int64"),
                (["joint.C.law", "slider.load"], "slider.load is of type Float64, not Int64"),
            ];
            let references = list(stage, ["joint.C.law", "joint.A.law"], &others);
            let faulty = [[0, 1], [99, 1], [i64::MIN, 1], [2, i64::MAX], [2, -1], [2, 1 << 32]];
            let faulty = faulty.map(|numbers| (numbers.to_vec(), "is out of range; allowed: "));
            let values = array(memory, "values", vec![2_i64, 1], faulty.to_vec());
            (settable(stage, references, "joint.C.law (fixed parameter) cannot be set"), values)
        }
        _ => {
            let others = [
                (["solver.portable", "joint.C.contact"], "joint.C.contact (output) cannot be set"),
                (["solver.portable", "slider.load"], "slider.load is of type Float64, not Boolean"),
            ];
            let references = list(stage, ["solver.portable", "rod.flexible.geometric_stiffness"], &others);
            let values = array(memory, "values", vec![1_u8, 0], vec![]);
            (settable(stage, references, "solver.portable (fixed parameter) cannot be set"), values)
        }
    };
    if call == SetBoolean {
        values.values.extend([2, 255].map(|any| good(memory.array(vec![any, any]))));
    }
    with_values(references, values)
}

/// Refused in any case where parameters cannot be set.
fn settable(stage: &Stage, references: Argument, words: &str) -> Argument {
    if Touch::SetParameter.allowed(stage.state) { references } else { references.refused_as(words) }
}

/// References of a function whose type no variable has, and their number.
fn absent(call: Call, stage: &Stage) -> [Argument; 2] {
    let name = call.name().trim_start_matches("fmi3Get").trim_start_matches("fmi3Set");
    let references = list(stage, ["slider.x", "slider.load"], &[]);
    let references = references.refused_as(&format!("slider.x is of type Float64, not {name}"));
    [references.counted_by(2), count(2)]
}

fn clocks(stage: &Stage) -> Vec<Argument> {
    let memory = &stage.memory;
    let contacts = contacts(&stage.scene());
    let contact = contacts.first().copied().unwrap_or_default() as u32;
    let (clock, load) = (FIRST_CLOCK + contact, vr("slider.load"));
    let missing = (0..7).find(|contact| !contacts.contains(contact)).unwrap_or_default() as u32;
    let mut faulty = vec![
        (vec![load, clock], "slider.load is of type Float64, not Clock"),
        (vec![clock, u32::MAX], "value reference 4294967295"),
    ];
    if contacts.len() < 7 {
        faulty.push((vec![clock, FIRST_CLOCK + missing], "no contact of this clock"));
    }
    let references = array(memory, "valueReferences", vec![clock; 2], faulty);
    let references = if contacts.is_empty() { references.refused_as("no contact of this clock") } else { references };
    let values = array(memory, "values", vec![7_u8; 2], vec![]);
    vec![references.counted_by(2), count(2), values.counted_by(2)]
}

fn rates(stage: &Stage) -> Vec<Argument> {
    let memory = &stage.memory;
    let others = [
        (["slider.x", "slider.load"], "slider.load is not a real output"),
        (["rod.length", "slider.x"], "rod.length is not a real output"),
        (["joint.C.contact", "slider.x"], "joint.C.contact is not a real output"),
    ];
    let references = list(stage, ["slider.x", "crank.angle"], &others);
    let faulty = [0, 2, -1, i32::MIN, i32::MAX].map(|order| (vec![1, order], "only order 1 is known"));
    let orders = array(memory, "orders", vec![1_i32, 1], faulty.to_vec());
    let values = array(memory, "values", vec![0.0; 2], vec![]);
    let nvr = count(2);
    vec![references.counted_by(2), nvr, orders.counted_by(2), values.counted_by(5), lengths(2).equal_to(2)]
}

fn sensitivity(call: Call, stage: &Stage) -> Vec<Argument> {
    let memory = &stage.memory;
    let outputs = [
        (["slider.x", "slider.load"], "slider.load is not a real output"),
        (["rod.length", "slider.x"], "rod.length is not a real output"),
        (["slider.x", "solver.steps"], "solver.steps is not a real output"),
    ];
    let starts = stage.state == State::InitializationMode;
    let inputs = [
        (["slider.load", "slider.x"], "slider.x is not a real input"),
        (["rod.length", "slider.load"], if starts { "" } else { "rod.length is not a real input" }),
        (["slider.load", "drive.mode"], "drive.mode is not a real input"),
        // Named twice it counts twice.
        (["slider.load", "slider.load"], ""),
    ];
    let unknowns = pair(memory, "unknowns", ["slider.x", "slider.a"], &outputs, &UNKNOWN);
    let knowns = pair(memory, "knowns", ["slider.load", "crank.torque"], &inputs, &UNKNOWN);
    let faulty = NOT_FINITE.map(|number| (vec![1.0, number], "is not a finite number"));
    let seeds = array(memory, "seed", vec![1.0, 2.0], faulty.to_vec());
    let answers = array(memory, "sensitivity", vec![0.0; 2], vec![]);
    let (of_seeds, of_answers) = if call == GetDirectionalDerivative { (4, 2) } else { (2, 4) };
    vec![
        unknowns.counted_by(2),
        count(2),
        knowns.counted_by(4),
        count(2),
        seeds.counted_by(6),
        lengths(2).equal_to(of_seeds),
        answers.counted_by(8),
        lengths(2).equal_to(of_answers),
    ]
}

use host::vr;
