//! States put together from pieces of others: of other mechanisms, other times, other places in life.

use crate::brief;
use crate::bytes::{HEADER, resealed};
use crate::face::{Face, Pieces};
use crate::forged::{Fate, begun, fate};
use crate::scenes::{MECHANISMS, hosted};
use slidercrank::fmi::slave::saved_states::Saved;
use slidercrank::fmi::v2::Status;

/// The pieces of `one`, but those of `other` whose bit is up.
fn mixed<P: Pieces>(one: &P, other: &P, bits: usize) -> P {
    let taken = (0..P::PIECES).filter(|piece| bits >> piece & 1 == 1);
    taken.fold(one.clone(), |mixed, piece| mixed.with(piece, other))
}

/// Runs of all mechanisms, an instance that is new and one in initialization mode.
fn states<F: Face>() -> Vec<Vec<u8>> {
    let mechanisms = hosted::<F>();
    let young = [F::new(), MECHANISMS[mechanisms[mechanisms.len() - 1]].initializing()];
    let runs = mechanisms.into_iter().take(if brief() { 2 } else { usize::MAX });
    runs.map(begun::<F>).chain(young.map(|slave| slave.memory())).collect()
}

fn pieces_of_other_instances_are_refused_or_do_no_harm<F: Face>() {
    let states: Vec<_> = states::<F>().iter().map(|bytes| F::Content::from_bytes(bytes).expect("sound")).collect();
    let host = F::new();
    let mut refused = 0;
    for one in &states {
        for other in &states {
            for bits in 0..1 << F::Content::PIECES {
                let bytes = mixed(one, other, bits).to_bytes().expect("bytes");
                let fate = fate(&host, &bytes);
                let whole = bits == 0 || bits == (1 << F::Content::PIECES) - 1;
                assert!(!whole || fate != Fate::Refused, "{one:?} or {other:?}");
                refused += usize::from(fate == Fate::Refused);
            }
        }
    }
    assert!(refused > 0, "a snapshot of one mechanism is none of another");
}

fn a_state_spliced_from_two_at_any_byte_is_refused_or_does_no_harm<F: Face>() {
    let states = states::<F>();
    let host = F::new();
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

fn a_state_from_any_place_in_life_goes_on_from_there_or_is_refused<F: Face>() {
    let host = F::new();
    for bytes in states::<F>() {
        let sound = F::Content::from_bytes(&bytes).expect("sound");
        for (state, possible, ended) in sound.everywhere(F::EVENTS) {
            let forged = state.to_bytes().expect("bytes");
            assert_eq!(host.deserialize(&forged).is_ok(), possible, "{state:?}");
            host.lines();
            let fate = fate(&host, &forged);
            assert_eq!(fate == Fate::Refused, !possible, "{state:?}");
            // Where no step can follow, that is told.
            let begun = state.snapshot().is_some();
            assert!(!possible || (fate == Fate::Told) == ended || !begun, "{state:?}: {fate:?}");
        }
    }
    assert_eq!(host.reset(), Status::Ok);
}

on_each_face! {
    pieces_of_other_instances_are_refused_or_do_no_harm
    a_state_spliced_from_two_at_any_byte_is_refused_or_does_no_harm
    a_state_from_any_place_in_life_goes_on_from_there_or_is_refused
}
