//! Every function in every state with every value of every argument: what is not possible is refused, told in one
//! line that names function and cause, and changes neither the instance nor the importer's memory.

use crate::arguments::{Argument, Fault, Value};
use crate::brief;
use crate::importers_memory::ImportersMemory;
use crate::invoke::Word;
use crate::stage::{STATES, Stage};
use host::{Slave, log::Line};
use slidercrank::fmi::v2::Status;

/// An instance of either version in some state, and memory for the arguments of calls.
pub trait Staged {
    type Call: Copy;

    /// Every function that takes an instance.
    fn calls() -> Vec<Self::Call>;
    fn name(call: Self::Call) -> &'static str;
    /// Why a call is refused here whatever its arguments are, if it is.
    fn refusal(&self, call: Self::Call) -> Option<String>;
    /// Whether a call ends the instance.
    fn frees(call: Self::Call) -> bool;
    /// The arguments of a function here, one list of values each, the instance first.
    fn arguments(&self, call: Self::Call) -> Vec<Argument>;
    /// Calls a function with these words; its status, if it has one.
    ///
    /// # Safety
    /// As the function's.
    unsafe fn invoke(&self, call: Self::Call, words: &[Word]) -> Option<Status>;
    fn memory(&self) -> &ImportersMemory;
    /// All that the instance is.
    fn bytes(&self) -> Vec<u8>;
    /// The log's lines since the last look.
    fn lines(&self) -> Vec<Line>;
}

/// What a call must answer.
#[derive(Debug)]
pub struct Verdict {
    pub status: Status,
    /// Words of which the line of the log has some; without any there is no line.
    words: Vec<String>,
}

impl Verdict {
    fn refused(words: Vec<String>) -> Self {
        Self { status: Status::Error, words }
    }

    /// On a call with these faults in its arguments, the instance's first.
    fn on<S: Staged>(stage: &S, call: S::Call, faults: &[Option<Fault>]) -> Self {
        if faults.first().is_some_and(Option::is_some) {
            return Self::refused(vec![]);
        }
        if let Some(refusal) = stage.refusal(call) {
            return Self::refused(vec![refusal]);
        }
        let faults = faults.iter().flatten();
        let status = faults.clone().map(|fault| fault.status).max().unwrap_or(Status::Ok);
        Self { status, words: faults.flat_map(|fault| fault.words.clone()).collect() }
    }

    /// What is wrong with an answer and what the log says of it.
    pub fn objection(&self, name: &str, answer: Status, lines: &[Line]) -> Option<&'static str> {
        if answer != self.status {
            return Some("the status");
        }
        match lines {
            [] if self.words.is_empty() => None,
            [line] if !self.words.is_empty() => {
                let category = self.status.category().map(|category| category.name());
                let named = line.text.starts_with(&format!("{name}: "));
                let told = self.words.iter().any(|words| line.text.contains(words));
                let filed = category == Some(&line.category) && line.status == self.status as i32;
                (!named || !told || !filed || line.instance != "slave").then_some("the words")
            }
            _ => Some("the number of lines"),
        }
    }
}

/// Which value of each argument.
pub type Choice = Vec<usize>;

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

/// What a call came to.
pub struct Outcome {
    pub answer: Option<Status>,
    pub lines: Vec<Line>,
    /// What had to be answered, unless sound arguments lead further than can be foreseen.
    pub verdict: Verdict,
    pub words: Vec<Word>,
    /// The importer's memory has changed.
    pub written: bool,
}

/// Makes one call.
pub fn make<S: Staged>(call: S::Call, stage: &S, choice: &Choice) -> Outcome {
    let list = stage.arguments(call);
    let words: Vec<Word> = list.iter().zip(choice).map(|(argument, &value)| argument.values[value].word).collect();
    let unread = |argument: &Argument| {
        let count = argument.counted_by.map(|place| words[place]);
        matches!(count, Some(Word::Size(0) | Word::Integer(0) | Word::Byte(0)))
    };
    let fault = |(argument, &value): (&Argument, &usize)| match (&argument.values[value], argument.equals) {
        (Value { word, .. }, Some(place)) if *word != words[place] => Some(Fault::needed()),
        (Value { fault: Some(fault), .. }, _) if !unread(argument) => Some(fault.clone()),
        _ => None,
    };
    let faults: Vec<_> = list.iter().zip(choice).map(fault).collect();
    let (verdict, image) = (Verdict::on(stage, call, &faults), stage.memory().image());
    // SAFETY: an instance is live, NULL or misaligned; an array that is looked at has as many entries as are told.
    let answer = unsafe { stage.invoke(call, &words) };
    Outcome { answer, lines: stage.lines(), verdict, words, written: stage.memory().image() != image }
}

/// Makes one call and judges the answer; whether the call was refused.
fn judge<S: Staged>(call: S::Call, stage: &S, choice: &Choice) -> bool {
    let before = stage.bytes();
    let Outcome { answer, lines, verdict, words, written } = make(call, stage, choice);
    let objection = answer.and_then(|answer| verdict.objection(S::name(call), answer, &lines));
    let refused = answer.is_none_or(|answer| answer >= Status::Discard);
    let objection = objection.or((refused && stage.bytes() != before).then_some("what it did to the instance"));
    let objection = objection.or((refused && written).then_some("what it did to the importer's memory"));
    if let Some(objection) = objection {
        panic!("{objection}: {} with {words:?} answers {answer:?}, {lines:?}, not {verdict:?}", S::name(call));
    }
    refused
}

/// Makes every call with every choice of arguments on an instance that `reach` brings to some state; how many.
pub fn walk<S: Staged>(reach: impl Fn() -> S) -> usize {
    let mut cases = 0;
    for call in S::calls() {
        let mut stage = reach();
        let list = stage.arguments(call);
        for choice in choices(&list, stage.refusal(call).is_none() && !brief()) {
            if S::frees(call) && choice[0] == 0 {
                continue;
            }
            cases += 1;
            if judge(call, &stage, &choice) {
                stage.memory().clear();
            } else {
                stage = reach();
            }
        }
    }
    cases
}

#[test]
fn whatever_is_not_possible_is_refused_in_one_line_and_changes_nothing() {
    let other = Slave::new();
    let theirs = other.save();
    let cases: usize = STATES.iter().map(|&state| walk(|| Stage::reach(state, theirs))).sum();
    println!("{cases} calls");
    assert!(cases > if brief() { 2_000 } else { 10_000 }, "{cases}");
    assert_eq!(other.set_state(theirs), Status::Ok);
}
