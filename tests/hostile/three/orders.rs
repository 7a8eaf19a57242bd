//! Hosts that call any function of FMI 3.0 in any order with any arguments, by chance. What the lifecycle or an argument
//! forbids is refused and changes nothing; nothing that is not a number is handed out; and what an instance came to goes
//! on as another one does that is made from its bytes.

use super::stage::{STATES, Stage, Use, restrain, young};
use super::{Events, Exchange, Stepping};
use crate::face::Face;
use crate::importer::{Callback, Handle, Options, Slave};
use crate::invoke::Word;
use crate::product::{Choice, Outcome, Staged, make};
use crate::stage::STOP;
use crate::{brief, tried};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::fmu_state::FmuState;
use slidercrank::fmi::v3::lifecycle::{Call, State};
use slidercrank::fmi::v3::variables::time_reference;
use std::cell::{Cell, RefCell};
use std::rc::Rc;

/// One call.
#[derive(Clone, Debug)]
struct Act {
    call: Call,
    /// Arguments that are not sound, and their values.
    odd: Vec<(Index, Index)>,
}

/// Calls that lead to other states, or to other values.
const LEADING: &[Call] = &[
    Call::EnterInitializationMode,
    Call::ExitInitializationMode,
    Call::EnterEventMode,
    Call::UpdateDiscreteStates,
    Call::EnterStepMode,
    Call::EnterContinuousTimeMode,
    Call::DoStep,
    Call::SetTime,
    Call::SetContinuousStates,
    Call::SetFloat64,
    Call::GetFMUState,
    Call::SetFMUState,
];

fn act() -> impl Strategy<Value = Act> {
    let call = prop_oneof![
        5 => prop::sample::select(LEADING),
        4 => prop::sample::select(Stage::calls()),
    ];
    let odd = || (any::<Index>(), any::<Index>());
    let odd =
        prop_oneof![5 => Just(vec![]), 3 => odd().prop_map(|odd| vec![odd]), 1 => prop::collection::vec(odd(), 2..5)];
    (call, odd).prop_map(|(call, odd)| Act { call, odd })
}

fn content(stage: &Stage) -> FmuState {
    FmuState::from_bytes(&stage.bytes()).expect("a sound state")
}

/// How calls ended.
#[derive(Debug, Default)]
struct Endings {
    done: Cell<usize>,
    refused: Cell<usize>,
    failed: Cell<usize>,
    /// In which states calls met an instance.
    states: RefCell<[usize; 10]>,
}

fn count(cell: &Cell<usize>) {
    cell.set(cell.get() + 1);
}

fn perform(stage: &mut Stage, Act { call, odd }: &Act, endings: &Endings) {
    let (call, list) = (*call, stage.arguments(*call));
    let mut choice: Choice = vec![0; list.len()];
    for (argument, value) in odd.iter().filter(|_| !list.is_empty()) {
        let at = argument.index(list.len());
        choice[at] = value.index(list[at].values.len());
    }
    stage.memory.clear();
    let (before, was) = (stage.bytes(), content(stage));
    let stops = was.settings.experiment.stop == Some(STOP) && stage.now > 0.0;
    let endless = call == Call::DoStep && !stops && choice[2] != 0;
    if call == Call::FreeInstance && choice[0] == 0 || endless {
        return;
    }
    endings.states.borrow_mut()[stage.state as usize] += 1;
    let Outcome { answer, lines, verdict, words, written } = make(call, stage, &choice);
    let answer = answer.unwrap_or(Status::Error);
    let what =
        || format!("{} in '{}' with {words:?} answers {answer:?}, {lines:?}, {verdict:?}", call.name(), stage.state);
    // A time whose rounding is larger than a step tells no wrong communication point.
    let coarse = call == Call::DoStep && stage.now.abs() > 1e3;
    let certain = verdict.status == Status::Error && !coarse && call != Call::FreeInstance;
    if certain {
        assert_eq!(verdict.objection(call.name(), answer, &lines), None, "{}", what());
    }
    assert!(answer < Status::Fatal, "{}", what());
    let silent = choice.first().is_some_and(|instance| *instance != 0);
    assert_eq!(lines.len(), usize::from(answer != Status::Ok && !silent), "{}", what());
    if answer >= Status::Discard {
        let failed = call == Call::DoStep && content(stage).state == State::Terminated;
        assert!(!written && (failed || stage.bytes() == before), "{}", what());
        count(if certain { &endings.refused } else { &endings.failed });
    } else {
        assert!(numbers(call, &words, stage).iter().all(|number| number.is_finite()), "{}", what());
        count(&endings.done);
    }
    if call == Call::Reset && answer == Status::Ok {
        restrain(&stage.slave);
    }
    if call == Call::FreeFMUState && answer == Status::Ok {
        stage.saved = stage.slave.save();
    }
    stage.memory.clear();
    let now = content(stage);
    stage.state = now.state;
    stage.now = stage.slave.try_get_reference(time_reference()).unwrap_or(0.0);
    stage.slave.lines();
    assert!(stage.now.is_finite());
}

/// Real numbers that a call has written.
fn numbers(call: Call, words: &[Word], stage: &Stage) -> Vec<f64> {
    let (place, length) = match call {
        Call::GetFloat64 => (3, 4),
        Call::GetOutputDerivatives => (4, 5),
        Call::GetDirectionalDerivative | Call::GetAdjointDerivative => (7, 8),
        Call::GetContinuousStates
        | Call::GetContinuousStateDerivatives
        | Call::GetEventIndicators
        | Call::GetNominalsOfContinuousStates => (1, 2),
        _ => return vec![],
    };
    match (words[place], words[length]) {
        (Word::Pointer(numbers), Word::Size(count)) if count > 0 => stage.memory.numbers(numbers.cast(), count),
        _ => vec![],
    }
}

/// Goes on from wherever it is: what the calls answer, and what comes of them.
fn onward(slave: Slave, usage: Use) -> (Vec<Status>, Vec<u8>) {
    fn go<F: Face>(face: &F) -> (Vec<Status>, Vec<u8>) {
        let mut answers = face.press_on();
        let time = face.time().unwrap_or(0.0);
        answers.extend((0..3).map(|step| face.step(time + f64::from(step) * 1e-5, 1e-5)));
        face.lines();
        face.look("at the end");
        (answers, face.memory())
    }
    match usage {
        Use::Steps => go(&Stepping(slave)),
        Use::Events => go(&Events(slave)),
        Use::Exchange => go(&Exchange(slave)),
    }
}

fn made(usage: Use) -> Slave {
    let logging = Options { logging: true, ..Options::default() };
    match usage {
        Use::Steps => Slave::new(logging),
        Use::Events => Slave::new(Options::EVENTS),
        Use::Exchange => Slave::exchanging(),
    }
}

fn any_order(usage: Use) {
    let cases = if brief() { 20 } else { tried(1_000) };
    let config = Config { cases, rng_seed: RngSeed::Fixed(0x0DD), failure_persistence: None, ..Config::default() };
    let (other, endings) = (made(usage), Endings::default());
    let theirs = other.save();
    let places: Vec<_> = STATES.into_iter().filter(|(of, _)| *of == usage).collect();
    let hosts = (prop::sample::select(places), prop::collection::vec(act(), 1..50));
    let outcome = TestRunner::new(config).run(&hosts, |(place, acts)| {
        let mut stage = Stage::reach(place, theirs);
        acts.iter().for_each(|act| perform(&mut stage, act, &endings));
        let twin = made(usage);
        let state = twin.deserialize(&stage.bytes()).expect("its own bytes");
        assert_eq!(twin.set_state(state), Status::Ok);
        let Stage { slave, .. } = stage;
        let (here, there) = (onward(slave, usage), onward(twin, usage));
        prop_assert_eq!(here.0, there.0);
        prop_assert!(here.1 == there.1, "other bytes");
        Ok(())
    });
    println!("{endings:?}");
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}

#[test]
fn any_order_of_calls_in_co_simulation() {
    any_order(Use::Steps);
}

#[test]
fn any_order_of_calls_in_co_simulation_with_events() {
    any_order(Use::Events);
}

#[test]
fn any_order_of_calls_in_model_exchange() {
    any_order(Use::Exchange);
}

/// Sets a load at the first update of a step.
fn with_update(load: Rc<Cell<Option<f64>>>) -> Slave {
    let update = move |slave: &Handle, _: f64, _: bool| {
        if let Some(load) = load.take() {
            let answer = slave.set("slider.load", load);
            assert_eq!(answer, if load.is_finite() { Status::Ok } else { Status::Error });
            // What cannot be told is refused.
            assert!(slave.try_get("slider.a").map_or_else(|status| status == Status::Discard, f64::is_finite));
            assert!(slave.rate("slider.a").map_or_else(|status| status == Status::Discard, f64::is_finite));
        }
        None
    };
    let slave = young(
        Use::Steps,
        Options {
            intermediate: &["slider.load", "slider.a"],
            update: Some(Box::new(update) as Callback),
            ..Options::EVENTS
        },
    );
    assert_eq!(slave.enter(), Status::Ok);
    slave.ready(true);
    slave
}

#[test]
fn inputs_beyond_all_measure_within_a_step_are_carried_or_told_and_can_be_taken_back() {
    let load = Rc::new(Cell::new(None));
    let (slave, undisturbed) = (with_update(Rc::clone(&load)), with_update(Rc::default()));
    let end = |slave: &Slave| slave.run(1e-4, 1e-4, 2e-3).len();
    for slave in [&slave, &undisturbed] {
        slave.run(0.0, 1e-4, 1e-4);
    }
    let before = slave.save();
    let events = end(&undisturbed);
    for odd in [1e25, -1e45, 1e300, f64::MAX, f64::MIN, 5e-324, f64::NAN, f64::INFINITY] {
        load.set(Some(odd));
        let answer = slave.try_step(1e-4, 1e-3);
        assert!(answer.is_ok() || answer == Err(Status::Error), "{odd:e}: {answer:?}");
        assert_eq!(load.take(), None, "an update in every step");
        slave.lines();
        assert_eq!(slave.set_state(before), Status::Ok);
        assert_eq!((end(&slave), slave.picture()), (events, undisturbed.picture()), "{odd:e}");
        assert_eq!(slave.set_state(before), Status::Ok);
    }
}
