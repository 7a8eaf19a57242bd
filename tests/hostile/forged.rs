//! States with a sound checksum and any content: refused, or as harmless as any other state.

use crate::bytes::{HEADER, resealed};
use crate::face::{Face, Pieces};
use crate::scenes::{MECHANISMS, hosted};
use crate::{brief, tried};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;
use slidercrank::simulation::Snapshot;
use std::ops::Range;

/// [s] Where the runs begin: so late that a double can tell no steps shorter than 2⁻³² s, and a communication step
/// takes at most some thousand of them, whatever speeds a forged state has.
pub const START: f64 = 1_048_576.0;
/// [s] A communication step of a forged state.
pub const H: f64 = 1.0 / START;

/// What became of a forged state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    Refused,
    /// It came in, and a later call told that it cannot go on.
    Told,
    /// The run went on.
    Works,
}

/// Tries whether a host can go on from these bytes.
pub fn fate<F: Face>(host: &F, bytes: &[u8]) -> Fate {
    let outcome = host.deserialize(bytes).and_then(|mut state| {
        let status = host.restore(state);
        assert_eq!(host.forget(&mut state), Status::Ok);
        if status == Status::Ok { Ok(()) } else { Err(status) }
    });
    if let Err(status) = outcome {
        assert_eq!(status, Status::Error);
        host.only();
        return Fate::Refused;
    }
    let mut told = !host.look("forged");
    for status in host.press_on() {
        assert!(status < Status::Fatal, "{status:?}, {:?}", host.lines());
    }
    host.lines();
    let time = host.time();
    assert!(time.is_err() || time.is_ok_and(f64::is_finite), "at {time:?}");
    let time = time.unwrap_or(f64::NAN);
    for point in [time, time + H] {
        let status = host.step(point, H);
        assert!(status < Status::Fatal, "{:?}", host.lines());
        told |= status != Status::Ok;
        host.lines();
        if status == Status::Ok {
            told |= !host.look("after a step from a forged state");
        }
    }
    host.lines();
    let mut own = host.save();
    let again = host.restore(own);
    // What works can be saved and restored.
    assert!(again == Status::Ok || told && again == Status::Error, "{:?}", host.lines());
    assert_eq!(host.forget(&mut own), Status::Ok);
    host.lines();
    if told { Fate::Told } else { Fate::Works }
}

/// How many came to which end.
#[derive(Debug, Default)]
struct Fates {
    refused: usize,
    told: usize,
    works: usize,
}

impl Fates {
    fn count(&mut self, fate: Fate) {
        *match fate {
            Fate::Refused => &mut self.refused,
            Fate::Told => &mut self.told,
            Fate::Works => &mut self.works,
        } += 1;
    }
}

/// Most evaluations in a step of a forged state, unless that is what is forged. The default of 2e7 lets the few steps that
/// never end by themselves take most of the time.
const LONGEST: f64 = 200_000.0;

/// A run of this mechanism that has begun: its bytes.
pub fn begun<F: Face>(mechanism: usize) -> Vec<u8> {
    let slave: F = MECHANISMS[mechanism].initializing_from(START);
    assert_eq!(slave.set("solver.max_evaluations", LONGEST), Status::Ok);
    assert_eq!(slave.begin(), Status::Ok, "{:?}", slave.lines());
    let point = slave.steps(START, 1e-4, 5);
    assert_eq!(slave.set_slope("slider.load", 30.0).unwrap_or(Status::Ok), Status::Ok);
    slave.steps(point, 1e-4, 2);
    assert_eq!(slave.set("crank.torque", 0.5), Status::Ok);
    slave.memory()
}

/// Tries `change` at every place of the content.
fn everywhere<F: Face>(width: usize, change: impl Fn(usize, &mut [u8])) -> Fates {
    let mut fates = Fates::default();
    for mechanism in hosted::<F>() {
        let bytes = begun::<F>(mechanism);
        let host = F::new();
        let content: Range<usize> = HEADER..bytes.len() - 4 - width;
        for at in content.step_by(F::ONE_IN) {
            let forged = resealed(&bytes, |sealed| change(at, &mut sealed[at..at + width]));
            fates.count(fate(&host, &forged));
        }
    }
    fates
}

fn a_changed_byte_under_a_sound_checksum_does_no_harm<F: Face>() {
    // Every place that is tried meets one of these.
    let patterns = [0x01, 0x10, 0x80, 0xff];
    let fates = everywhere::<F>(1, |at, bytes| bytes[0] ^= patterns[at / F::ONE_IN % patterns.len()]);
    println!("{fates:?}");
    assert!(fates.refused > 0 && fates.works > 0, "{fates:?}");
}

fn absurd_numbers_anywhere_do_no_harm<F: Face>() {
    // Every place that is tried meets one of these.
    let absurd = [f64::NAN, f64::INFINITY, f64::MAX, -1e300, 1e39, -1e20, 1e9, 0.0, -5e-324];
    let fates =
        everywhere::<F>(8, |at, bytes| bytes.copy_from_slice(&absurd[at / F::ONE_IN % absurd.len()].to_le_bytes()));
    println!("{fates:?}");
    assert!(fates.refused > 0, "{fates:?}");
}

fn several_numbers_changed_at_once_do_no_harm<F: Face>() {
    let cases = if brief() { 50 } else { tried(20_000 / F::ONE_IN as u32) };
    let config = Config { cases, rng_seed: RngSeed::Fixed(0xBAD), failure_persistence: None, ..Config::default() };
    let sound: Vec<_> = hosted::<F>().into_iter().map(begun::<F>).collect();
    let host = F::new();
    let number = prop_oneof![any::<u64>(), any::<f64>().prop_map(f64::to_bits), (0..300_u64)];
    let changes = prop::collection::vec((any::<Index>(), 1..=8_usize, number), 1..6);
    let outcome = TestRunner::new(config).run(&(0..sound.len(), changes), |(mechanism, changes)| {
        let forged = resealed(&sound[mechanism], |sealed| {
            for (place, width, number) in &changes {
                let at = HEADER + place.index(sealed.len() - HEADER - width);
                sealed[at..at + width].copy_from_slice(&number.to_le_bytes()[..*width]);
            }
        });
        fate(&host, &forged);
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}

fn absurd_counters_and_lists_of_any_length_do_no_harm<F: Face>() {
    for mechanism in hosted::<F>() {
        let host = F::new();
        let state = F::Content::from_bytes(&begun::<F>(mechanism)).expect("a sound state");
        let whole = state.snapshot().clone().expect("a run");
        let try_with = |snapshot: Snapshot| {
            let mut forged = state.clone();
            forged.set_snapshot(snapshot);
            fate(&host, &forged.to_bytes().expect("bytes"))
        };
        for at in 0..whole.integers.len() {
            for absurd in [0, 1, 2, u64::from(u32::MAX), u64::MAX / 2, u64::MAX] {
                let mut snapshot = whole.clone();
                snapshot.integers[at] = absurd;
                try_with(snapshot);
            }
            let shorter = Snapshot { integers: whole.integers[..at].to_vec(), ..whole.clone() };
            assert_eq!(try_with(shorter), Fate::Refused, "{at} integers");
        }
        for length in 0..whole.reals.len() {
            let shorter = Snapshot { reals: whole.reals[..length].to_vec(), ..whole.clone() };
            assert_eq!(try_with(shorter), Fate::Refused, "{length} reals");
        }
        for more in [1, 7, 4096] {
            let longer = Snapshot { reals: [&whole.reals[..], &vec![0.0; more]].concat(), ..whole.clone() };
            assert_eq!(try_with(longer), Fate::Refused, "{more} reals more");
            let longer = Snapshot { integers: [&whole.integers[..], &vec![0; more]].concat(), ..whole.clone() };
            assert_eq!(try_with(longer), Fate::Refused, "{more} integers more");
        }
        assert_eq!(try_with(whole), Fate::Works);
    }
}

on_each_face! {
    a_changed_byte_under_a_sound_checksum_does_no_harm
    absurd_numbers_anywhere_do_no_harm
    several_numbers_changed_at_once_do_no_harm
    absurd_counters_and_lists_of_any_length_do_no_harm
}
