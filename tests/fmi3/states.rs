//! Saved states: a restored run is the run, on either side of an event.

use crate::importer::{Options, Slave};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::*;

const STEP: f64 = 1e-3;

#[test]
fn a_run_goes_on_from_a_pending_event_in_another_instance() {
    let slave = Slave::running(Options::EVENTS);
    let told = slave.step(0.0, 0.01);
    assert!(told.event);
    let (before, state) = (slave.picture(), slave.save());
    let bytes = slave.bytes_of(state);
    let finish = |slave: &Slave| {
        assert_eq!(slave.enter_event_mode(), Status::Ok);
        slave.handle_event();
        let events = slave.run(told.time, STEP, told.time + 10.0 * STEP);
        (slave.picture(), events.iter().map(|time| time.to_bits()).collect::<Vec<_>>())
    };
    let there = finish(&slave);
    assert_eq!(slave.set_state(state), Status::Ok);
    assert_eq!(slave.picture(), before, "the left limit");
    assert_eq!(finish(&slave), there);
    let other = Slave::new(Options::EVENTS);
    let state = other.deserialize(&bytes).expect("a state");
    assert_eq!(other.set_state(state), Status::Ok);
    assert_eq!(other.picture(), before);
    assert_eq!(finish(&other), there);
}

#[test]
fn states_of_another_version_of_fmi_are_refused() {
    let two = host::Slave::running();
    let three = Slave::running(Options { logging: true, ..Options::default() });
    assert_eq!(three.deserialize(&two.bytes_of(two.save())), Err(Status::Error));
    assert!(three.line().text.contains("for FMI 2.0; this FMU reads version"));
    assert!(two.deserialize(&three.bytes_of(three.save())).is_err());
}

#[test]
fn a_state_is_freed_once() {
    let slave = Slave::running(Options { logging: true, ..Options::default() });
    let mut state = slave.save();
    let stale = state;
    // SAFETY: live instance, one place.
    unsafe {
        assert_eq!(fmi3FreeFMUState(slave.0, &mut state), Status::Ok);
        assert!(state.is_null());
        assert_eq!(fmi3FreeFMUState(slave.0, &mut state), Status::Ok);
    }
    assert_eq!(slave.set_state(stale), Status::Error);
    assert!(slave.line().text.contains("FMUstate"));
}

#[test]
fn damaged_bytes_are_refused() {
    let slave = Slave::running(Options::EVENTS);
    assert!(slave.step(0.0, 0.01).event);
    let bytes = slave.bytes_of(slave.save());
    for at in (0..bytes.len()).step_by(7) {
        let mut torn = bytes.clone();
        torn[at] ^= 0x10;
        assert_eq!(slave.deserialize(&torn), Err(Status::Error), "byte {at}");
    }
    for length in [0, 1, 50, bytes.len() - 1] {
        assert_eq!(slave.deserialize(&bytes[..length]), Err(Status::Error));
    }
}
