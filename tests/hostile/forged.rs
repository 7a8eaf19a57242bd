//! States with a sound checksum and any content: refused, or as harmless as any other state.

use crate::brief;
use crate::bytes::{HEADER, resealed, some};
use crate::host::{Slave, vr};
use crate::scenes::MECHANISMS;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::slave::variables::{Access, VARIABLES};
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::fmu_state::FmuState;
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

/// No status but these, and no number that is none.
fn look(host: &Slave, told: &mut bool) {
    for (variable, reference) in VARIABLES.iter().zip(0..) {
        if !matches!(variable.access, Access::RealOutput(_) | Access::Input { .. }) {
            continue;
        }
        let mut value = f64::NAN;
        // SAFETY: live component, arrays of one entry.
        match unsafe { (host.api.GetReal)(host.c, &reference, 1, &mut value) } {
            Status::Ok => assert!(value.is_finite(), "{} = {value}", variable.name),
            Status::Discard | Status::Error => *told = true,
            other => panic!("{}: {other:?} {:?}", variable.name, host.log.take()),
        }
    }
    // SAFETY: live component, arrays of one entry.
    let rate = unsafe { (host.api.GetRealOutputDerivatives)(host.c, &vr("slider.x"), 1, &1, &mut 0.0) };
    assert!(rate < Status::Fatal);
}

/// Tries whether a host can go on from these bytes.
pub fn fate(host: &Slave, bytes: &[u8]) -> Fate {
    let outcome = host.deserialize(bytes).and_then(|mut state| {
        let status = host.set_state(state);
        assert_eq!(host.free(&mut state), Status::Ok);
        if status == Status::Ok { Ok(()) } else { Err(status) }
    });
    if let Err(status) = outcome {
        assert_eq!(status, Status::Error);
        host.log.only();
        return Fate::Refused;
    }
    let mut told = false;
    look(host, &mut told);
    for status in [host.enter(), host.exit()] {
        assert!(matches!(status, Status::Ok | Status::Error), "{status:?}");
    }
    let mut time = f64::NAN;
    // SAFETY: live component, one place.
    let status = unsafe { (host.api.GetRealStatus)(host.c, 2, &mut time) };
    assert!(status != Status::Ok || time.is_finite(), "at {time} s");
    for point in [time, time + H] {
        let status = host.step(point, H);
        assert!(status < Status::Fatal, "{:?}", host.log.take());
        told |= status != Status::Ok;
        if status == Status::Ok {
            look(host, &mut told);
        }
    }
    let mut own = host.save();
    let again = host.set_state(own);
    // What works can be saved and restored.
    assert!(again == Status::Ok || told && again == Status::Error, "{:?}", host.log.take());
    assert_eq!(host.free(&mut own), Status::Ok);
    host.log.take();
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

/// A run of this mechanism that has begun: its bytes.
pub fn begun(mechanism: usize) -> Vec<u8> {
    let slave = MECHANISMS[mechanism].running_from(START);
    let point = slave.steps(START, 1e-4, 5);
    assert_eq!(slave.set_rate("slider.load", 1, 30.0), Status::Ok);
    slave.steps(point, 1e-4, 2);
    assert_eq!(slave.set("crank.torque", 0.5), Status::Ok);
    slave.bytes_of(slave.save())
}

/// Tries `change` at every place of the content.
fn everywhere(width: usize, change: impl Fn(usize, &mut [u8])) -> Fates {
    let mut fates = Fates::default();
    for mechanism in some() {
        let bytes = begun(mechanism);
        let host = Slave::new();
        let content: Range<usize> = HEADER..bytes.len() - 4 - width;
        for at in content {
            let forged = resealed(&bytes, |sealed| change(at, &mut sealed[at..at + width]));
            fates.count(fate(&host, &forged));
        }
    }
    fates
}

#[test]
fn a_changed_byte_under_a_sound_checksum_does_no_harm() {
    // Every place meets one of these.
    let patterns = [0x01, 0x10, 0x80, 0xff];
    let fates = everywhere(1, |at, bytes| bytes[0] ^= patterns[at % patterns.len()]);
    assert!(fates.refused > 0 && fates.works > 0, "{fates:?}");
}

#[test]
fn absurd_numbers_anywhere_do_no_harm() {
    // Every place meets one of these.
    let absurd = [f64::NAN, f64::INFINITY, f64::MAX, -1e300, 1e39, -1e20, 1e9, 0.0, -5e-324];
    let fates = everywhere(8, |at, bytes| bytes.copy_from_slice(&absurd[at % absurd.len()].to_le_bytes()));
    assert!(fates.refused > 0, "{fates:?}");
}

#[test]
fn several_numbers_changed_at_once_do_no_harm() {
    let cases = if brief() { 50 } else { 20_000 };
    let config = Config { cases, rng_seed: RngSeed::Fixed(0xBAD), failure_persistence: None, ..Config::default() };
    let sound: Vec<_> = some().map(begun).collect();
    let host = Slave::new();
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

#[test]
fn absurd_counters_and_lists_of_any_length_do_no_harm() {
    for mechanism in some() {
        let host = Slave::new();
        let state = FmuState::from_bytes(&begun(mechanism)).expect("a sound state");
        let whole = state.snapshot.clone().expect("a run");
        let try_with = |snapshot: Snapshot| {
            let forged = FmuState { snapshot: Some(snapshot), ..state.clone() };
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
