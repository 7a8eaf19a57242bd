//! States put together from pieces of others: of other mechanisms, other times, other places in life.

use crate::brief;
use crate::bytes::{HEADER, resealed};
use crate::forged::{Fate, begun, fate};
use crate::host::Slave;
use crate::scenes::MECHANISMS;
use slidercrank::fmi::slave::Settings;
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::fmu_state::FmuState;
use slidercrank::fmi::v2::lifecycle::State;

/// Number of pieces that [`mixed`] takes from either state.
const PIECES: usize = 6;

/// The pieces of `one`, but those of `other` whose bit is up.
fn mixed(one: &FmuState, other: &FmuState, bits: usize) -> FmuState {
    let of = |piece: usize| if bits >> piece & 1 == 1 { other } else { one };
    FmuState {
        state: of(0).state,
        settings: Settings {
            scene: of(1).settings.scene.clone(),
            experiment: of(2).settings.experiment,
            inputs: of(3).settings.inputs,
            tolerance_set: of(2).settings.tolerance_set,
        },
        last_step: of(4).last_step,
        dead_end: of(4).dead_end,
        snapshot: of(5).snapshot.clone(),
    }
}

/// Runs of all mechanisms, an instance that is new and one in initialization mode.
fn states() -> Vec<Vec<u8>> {
    let young = [Slave::new(), MECHANISMS[4].initializing()];
    let runs = 0..if brief() { 2 } else { MECHANISMS.len() };
    runs.map(begun).chain(young.map(|slave| slave.bytes_of(slave.save()))).collect()
}

#[test]
fn pieces_of_other_instances_are_refused_or_do_no_harm() {
    let states: Vec<_> = states().iter().map(|bytes| FmuState::from_bytes(bytes).expect("sound")).collect();
    let host = Slave::new();
    let mut refused = 0;
    for one in &states {
        for other in &states {
            for bits in 0..1 << PIECES {
                let bytes = mixed(one, other, bits).to_bytes().expect("bytes");
                let fate = fate(&host, &bytes);
                let whole = bits == 0 || bits == (1 << PIECES) - 1;
                assert!(!whole || fate != Fate::Refused, "in {} or {}", one.state, other.state);
                refused += usize::from(fate == Fate::Refused);
            }
        }
    }
    assert!(refused > 0, "a snapshot of one mechanism is none of another");
}

#[test]
fn a_state_spliced_from_two_at_any_byte_is_refused_or_does_no_harm() {
    let states = states();
    let host = Slave::new();
    let mut refused = 0;
    for (one, other) in states.iter().zip(states.iter().cycle().skip(1)) {
        for at in HEADER..one.len().min(other.len()) - 4 {
            // As long as the header of `one` says.
            let mut spliced = [&one[..at], &other[at..other.len() - 4]].concat();
            spliced.resize(one.len(), 0);
            refused += usize::from(fate(&host, &resealed(&spliced, |_| ())) == Fate::Refused);
        }
    }
    assert!(refused > 0);
}

#[test]
fn a_state_from_any_place_in_life_goes_on_from_there_or_is_refused() {
    let host = Slave::new();
    for bytes in states() {
        let sound = FmuState::from_bytes(&bytes).expect("sound");
        for state in State::ALL {
            let forged = FmuState { state, ..sound.clone() }.to_bytes().expect("bytes");
            let begun = !matches!(state, State::Instantiated | State::InitializationMode);
            let possible = sound.snapshot.is_some() == begun
                && !matches!(state, State::StartAndEnd | State::StepInProgress | State::Fatal)
                // Of an instance for model exchange.
                && !matches!(state, State::EventMode | State::ContinuousTimeMode);
            assert_eq!(host.deserialize(&forged).is_ok(), possible, "{state}");
            host.log.take();
            let fate = fate(&host, &forged);
            assert_eq!(fate == Fate::Refused, !possible, "{state}");
            // Where no step can follow, that is told.
            let ended = matches!(state, State::StepFailed | State::StepCanceled | State::Terminated | State::Error);
            assert!(!possible || (fate == Fate::Told) == ended || !begun, "{state}: {fate:?}");
        }
    }
    assert_eq!(host.reset(), Status::Ok);
}
