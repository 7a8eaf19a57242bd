//! Every function in every state with every value of every argument: what is not possible is refused, told in one
//! line that names function and cause, and changes neither the instance nor the importer's memory.

use crate::arguments::{Argument, Fault, arguments};
use crate::brief;
use crate::host::{Slave, log::Line};
use crate::invoke::{Word, invoke};
use crate::stage::{STATES, Stage};
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::types::fmi2FMUstate;
use slidercrank::fmi::v2::lifecycle::{Call, State};

/// What a call must answer.
struct Verdict {
    status: Status,
    /// Words of which the line of the log has some; without any there is no line.
    words: Vec<String>,
}

impl Verdict {
    fn refused(words: &[&str]) -> Self {
        Self { status: Status::Error, words: words.iter().map(ToString::to_string).collect() }
    }

    /// On a call with these faults in its arguments, the component's first.
    fn on(call: Call, state: State, faults: &[Option<Fault>]) -> Self {
        if faults.first().is_some_and(Option::is_some) {
            return Self::refused(&[]);
        }
        // Instances in states of both kinds are for co-simulation here.
        let kind = state.interface().unwrap_or(Interface::CoSimulation);
        match call.interface() {
            Some(Interface::ModelExchange) if kind == Interface::CoSimulation => {
                return Self::refused(&["of model exchange"]);
            }
            Some(Interface::CoSimulation) if kind == Interface::ModelExchange => {
                return Self::refused(&["of co-simulation"]);
            }
            _ => {}
        }
        if !call.allowed(state) {
            return Self::refused(&[&format!("not allowed in state '{state}'")]);
        }
        let faults = faults.iter().flatten();
        let status = faults.clone().map(|fault| fault.status).max().unwrap_or(Status::Ok);
        Self { status, words: faults.flat_map(|fault| fault.words.clone()).collect() }
    }

    /// What is wrong with an answer and what the log says of it.
    fn objection(&self, call: Call, answer: Status, lines: &[Line]) -> Option<&'static str> {
        if answer != self.status {
            return Some("the status");
        }
        match lines {
            [] if self.words.is_empty() => None,
            [line] if !self.words.is_empty() => {
                let category = self.status.category().map(|category| category.name());
                let named = line.text.starts_with(&format!("{}: ", call.name()));
                let told = self.words.iter().any(|words| line.text.contains(words));
                let filed = category == Some(&line.category) && line.status == self.status as i32;
                (!named || !told || !filed || line.instance != "slave").then_some("the words")
            }
            _ => Some("the number of lines"),
        }
    }
}

/// Which value of each argument.
type Choice = Vec<usize>;

/// Sound values but for one argument, or for two.
fn choices(list: &[Argument], pairs: bool) -> Vec<Choice> {
    let sound = vec![0; list.len()];
    let mut all = vec![sound.clone()];
    for (first, one) in list.iter().enumerate() {
        for value in 1..one.values.len() {
            let mut single = sound.clone();
            single[first] = value;
            for (second, other) in list.iter().enumerate().skip(first + 1).filter(|_| pairs) {
                all.extend((1..other.values.len()).map(|value| {
                    let mut pair = single.clone();
                    pair[second] = value;
                    pair
                }));
            }
            all.push(single);
        }
    }
    all
}

/// Makes one call and judges the answer; whether the call was refused.
fn judge(call: Call, stage: &Stage, choice: &Choice) -> bool {
    let list = arguments(call, stage);
    let words: Vec<Word> = list.iter().zip(choice).map(|(argument, &value)| argument.values[value].word).collect();
    let unread = |argument: &Argument| {
        let count = argument.counted_by.map(|place| words[place]);
        matches!(count, Some(Word::Size(0) | Word::Integer(0)))
    };
    let fault = |(argument, &value): (&Argument, &usize)| match &argument.values[value].fault {
        Some(fault) if !unread(argument) => Some(fault.clone()),
        _ => None,
    };
    let faults: Vec<_> = list.iter().zip(choice).map(fault).collect();
    let (before, memory) = (stage.bytes(), stage.memory());
    // SAFETY: a component is live, NULL or misaligned; an array that is looked at has as many entries as are told.
    let answer = unsafe { invoke(&stage.slave.api, call, &words) };
    let lines = stage.slave.log.take();
    let verdict = Verdict::on(call, stage.state, &faults);
    let objection = answer.and_then(|answer| verdict.objection(call, answer, &lines));
    let refused = answer.is_none_or(|answer| answer >= Status::Discard);
    let objection = objection.or((refused && stage.bytes() != before).then_some("what it did to the instance"));
    let objection =
        objection.or((refused && stage.memory() != memory).then_some("what it did to the importer's memory"));
    if let Some(objection) = objection {
        let Verdict { status, words: told } = verdict;
        panic!(
            "{objection}: {} in '{}' with {words:?} answers {answer:?}, {lines:?}, not {status:?}, {told:?}",
            call.name(),
            stage.state
        );
    }
    refused
}

/// A call that ends the instance.
fn ends(call: Call, choice: &Choice) -> bool {
    call == Call::FreeInstance && choice[0] == 0
}

fn walk(state: State, theirs: fmi2FMUstate) -> usize {
    let mut cases = 0;
    for &call in Call::ALL.iter().filter(|&&call| call != Call::Instantiate) {
        let mut stage = Stage::reach(state, theirs);
        let list = arguments(call, &stage);
        for choice in choices(&list, call.allowed(state) && !brief()) {
            if ends(call, &choice) {
                continue;
            }
            cases += 1;
            if judge(call, &stage, &choice) {
                stage.clear();
            } else {
                stage = Stage::reach(state, theirs);
            }
        }
    }
    cases
}

#[test]
fn whatever_is_not_possible_is_refused_in_one_line_and_changes_nothing() {
    let other = Slave::new();
    let theirs = other.save();
    let cases: usize = STATES.iter().map(|&state| walk(state, theirs)).sum();
    println!("{cases} calls");
    assert!(cases > if brief() { 2_000 } else { 10_000 }, "{cases}");
    assert_eq!(other.set_state(theirs), Status::Ok);
}
