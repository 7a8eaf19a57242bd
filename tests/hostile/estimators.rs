//! The functions for estimators with any arguments, and as detours of a run.

use crate::brief;
use crate::face::Face;
use crate::invoke::{NULL, Word};
use crate::scenes::{MECHANISMS, hosted};
use host::vr;
use slidercrank::fmi::slave::Interface;
use slidercrank::fmi::v2::Status;
use std::ffi::c_void;

/// An instance and its version's functions for estimators: names of a phase, a step's Jacobian, setting a phase.
pub struct Estimated {
    pub instance: *mut c_void,
    pub calls: [unsafe fn(&[Word]) -> Status; 3],
}

/// An instance of a version with these functions.
macro_rules! estimated {
    ($instance:expr, $version:ident: $names:ident $map:ident $set:ident) => {{
        use crate::invoke::{Function, Word};
        use slidercrank::fmi::$version::abi::estimation::bodies;
        unsafe fn names(words: &[Word]) -> Status {
            // SAFETY: the caller's.
            unsafe { Function::call(bodies::$names as unsafe extern "C" fn(_, _, _) -> _, words) }.expect("a status")
        }
        unsafe fn map(words: &[Word]) -> Status {
            let map = bodies::$map as unsafe extern "C" fn(_, _, _, _, _, _, _, _, _, _, _, _, _, _) -> _;
            // SAFETY: the caller's.
            unsafe { Function::call(map, words) }.expect("a status")
        }
        unsafe fn set(words: &[Word]) -> Status {
            // SAFETY: the caller's.
            unsafe { Function::call(bodies::$set as unsafe extern "C" fn(_, _, _, _, _, _) -> _, words) }
                .expect("a status")
        }
        crate::estimators::Estimated { instance: $instance, calls: [names, map, set] }
    }};
}

pub(crate) use estimated;

/// [s] Length of the steps.
const STEP: f64 = 1e-4;
/// What no refused call writes.
const UNTOUCHED: f64 = -7.0;
/// Bytes that have room for all names.
const NAMES: usize = 4096;

/// More entries than any array may have: the library must not look at one of them.
const TOO_MANY: usize = (1 << 24) + 1;

/// What the pointers of the calls point to.
struct Memory {
    references: [[u32; 2]; 2],
    sizes: [usize; 2],
    names: Vec<u8>,
    arrays: [Vec<f64>; 7],
    phase: Vec<f64>,
    values: [f64; 1],
}

impl Memory {
    /// Everything for a phase of `count` numbers and names of `size` bytes.
    fn new(count: usize, size: usize, phase: Vec<f64>, clearance: f64) -> Self {
        let lengths = [count, count, 2, count * count, count * 2, 2 * count, 4];
        Self {
            references: [["joint.C.clearance", "crank.torque"].map(vr), ["slider.x", "slider.v"].map(vr)],
            sizes: [count, size],
            names: vec![1; NAMES],
            arrays: lengths.map(|length| vec![UNTOUCHED; length]),
            phase,
            values: [clearance],
        }
    }

    /// Sound words of the three calls.
    fn words(&mut self, instance: *mut c_void) -> [Vec<Word>; 3] {
        let instance = Word::Pointer(instance);
        let references = self.references.each_ref().map(|of| Word::Pointer(of.as_ptr().cast_mut().cast()));
        let sizes = self.sizes.each_mut().map(|size| Word::Pointer((&raw mut *size).cast()));
        let arrays = self.arrays.each_mut().map(|array| Word::Pointer(array.as_mut_ptr().cast()));
        let names = vec![instance, Word::Pointer(self.names.as_mut_ptr().cast()), sizes[1]];
        let two = Word::Size(2);
        let mut map = vec![instance, Word::Real(STEP), references[0], two, references[1], two, sizes[0]];
        map.extend(arrays);
        let (phase, count) = (Word::Pointer(self.phase.as_mut_ptr().cast()), Word::Size(self.phase.len()));
        let values = Word::Pointer(self.values.as_mut_ptr().cast());
        [names, map, vec![instance, phase, count, references[0], Word::Size(1), values]]
    }

    fn is_untouched(&self) -> bool {
        self.names.iter().all(|byte| *byte == 1) && self.arrays.iter().flatten().all(|value| *value == UNTOUCHED)
    }
}

/// Words that no sane host passes in place of this one.
fn bad(word: Word) -> Vec<Word> {
    match word {
        Word::Pointer(pointer) => vec![NULL, Word::Pointer(pointer.wrapping_byte_add(1))],
        Word::Size(size) => {
            [0, size.wrapping_sub(1), size + TOO_MANY, usize::MAX / 8, usize::MAX].map(Word::Size).into()
        }
        Word::Real(_) => [f64::NAN, f64::INFINITY, -f64::INFINITY, -STEP, 0.0, 1e-300].map(Word::Real).into(),
        other => vec![other],
    }
}

/// Ways to spoil what the pointers point to.
const SPOILERS: [fn(&mut Memory); 9] = [
    |memory| memory.references[0][0] = u32::MAX,
    |memory| memory.references[1][1] = u32::MAX,
    |memory| memory.references[0] = memory.references[1],
    |memory| memory.sizes = [0, 0],
    |memory| memory.sizes = [usize::MAX, usize::MAX],
    |memory| memory.phase.iter_mut().for_each(|number| *number = f64::NAN),
    |memory| memory.phase.iter_mut().for_each(|number| *number = 1e300),
    |memory| memory.values = [f64::INFINITY],
    |memory| memory.values = [-1.0],
];

/// The phase of an instance with its number of numbers and the bytes of its names; `None` where there is none.
fn phase_of(estimated: &Estimated) -> Option<(Vec<f64>, usize)> {
    let mut memory = Memory::new(0, NAMES, vec![], 0.0);
    let [mut names, mut map, _] = memory.words(estimated.instance);
    names[1] = NULL;
    map[7..].fill(NULL);
    // SAFETY: a live instance and two places.
    let asked = unsafe { [(estimated.calls[0])(&names), (estimated.calls[1])(&map)] };
    if asked != [Status::Ok; 2] {
        return None;
    }
    let [count, size] = memory.sizes;
    let mut memory = Memory::new(count, size, vec![], 0.0);
    let [_, mut map, _] = memory.words(estimated.instance);
    (map[3], map[5], map[10]) = (Word::Size(0), Word::Size(0), NULL);
    // SAFETY: arrays of the lengths said.
    assert_eq!(unsafe { (estimated.calls[1])(&map) }, Status::Ok);
    Some((memory.arrays[0].clone(), size))
}

fn any_argument_of_theirs_is_refused_or_does_no_harm<F: Face>() {
    for mechanism in hosted::<F>() {
        let (slave, plain): (F, F) = (MECHANISMS[mechanism].running(), MECHANISMS[mechanism].running());
        let point = slave.steps(0.0, STEP, 3);
        plain.steps(0.0, STEP, 3);
        let (estimated, mut saved, before) = (slave.estimated(), slave.save(), slave.memory());
        let found = phase_of(&estimated);
        slave.lines();
        assert_eq!(found.is_some(), F::INTERFACE == Interface::CoSimulation);
        let (phase, size) = found.unwrap_or_default();
        let clearance = slave.get("joint.C.clearance");
        let fresh = || Memory::new(phase.len(), size, phase.clone(), clearance);
        let judge = |number: usize, status: Status, memory: &Memory, what: &str| {
            let lines = slave.lines();
            assert!(
                matches!(status, Status::Ok | Status::Warning | Status::Error | Status::Discard),
                "{what}: {lines:?}"
            );
            if matches!(status, Status::Error | Status::Discard) {
                assert!(memory.is_untouched(), "{what}: {lines:?}");
                assert!(lines.len() <= 1, "{what}: {lines:?}");
            }
            let set = number == 2 && matches!(status, Status::Ok | Status::Warning);
            assert!(set || slave.memory() == before, "{what}: {lines:?}");
            assert_eq!(slave.restore(saved), Status::Ok);
        };
        for number in 0..3 {
            let places = fresh().words(estimated.instance)[number].len();
            for place in 0..places {
                for k in 0.. {
                    let mut memory = fresh();
                    let mut words = memory.words(estimated.instance)[number].clone();
                    let Some(word) = bad(words[place]).get(k).copied() else { break };
                    if place == 0 && word != NULL {
                        break;
                    }
                    words[place] = word;
                    let what = format!("{}: call {number}, argument {place}: {word:?}", MECHANISMS[mechanism].name);
                    // SAFETY: NULL, misaligned or of a length that is refused; else arrays of the lengths said or longer.
                    let status = unsafe { (estimated.calls[number])(&words) };
                    judge(number, status, &memory, &what);
                }
            }
            for (k, spoil) in SPOILERS.iter().enumerate() {
                let mut memory = fresh();
                spoil(&mut memory);
                let words = memory.words(estimated.instance)[number].clone();
                let what = format!("{}: call {number}, spoiled by {k}", MECHANISMS[mechanism].name);
                // SAFETY: arrays of the lengths said or longer; a length that is said wrongly is refused.
                let status = unsafe { (estimated.calls[number])(&words) };
                judge(number, status, &memory, &what);
            }
        }
        assert_eq!(slave.forget(&mut saved), Status::Ok);
        for run in [&slave, &plain] {
            run.steps(point, STEP, if brief() { 1 } else { 5 });
        }
        assert_eq!(slave.everything(), plain.everything(), "{}", MECHANISMS[mechanism].name);
    }
}

on_each_face! {
    any_argument_of_theirs_is_refused_or_does_no_harm
}
