//! The same trajectory to the bit: in FMI 2.0, in FMI 3.0, with event mode, with intermediate updates.

use crate::importer::{Options, Slave};

/// [s] 0.03 crank turns a step.
const STEP: f64 = 1.0 / 4096.0;
const STEPS: usize = 40;

fn by_fmi2() -> Vec<u64> {
    let slave = host::Slave::running();
    slave.steps(0.0, STEP, STEPS);
    slave.picture()
}

/// What a run in FMI 3.0 ends with, and the number of events that it told.
fn by_fmi3(options: Options) -> (Vec<u64>, usize) {
    let slave = Slave::running(options);
    let events = slave.run(0.0, STEP, STEP * STEPS as f64);
    (slave.picture(), events.len())
}

#[test]
fn steps_end_where_those_of_fmi2_end() {
    assert_eq!(by_fmi3(Options::default()), (by_fmi2(), 0));
}

#[test]
fn events_change_nothing() {
    let (picture, events) = by_fmi3(Options::EVENTS);
    assert_eq!(picture, by_fmi2());
    assert!(events > 30, "{events}");
    // Without early return events are handled within the step.
    assert_eq!(by_fmi3(Options { early_return: false, ..Options::EVENTS }), (by_fmi2(), 0));
}

#[test]
fn looking_on_changes_nothing() {
    for event_mode in [false, true] {
        let update = Some(Box::new(|slave: &crate::importer::Handle, _, _| {
            assert!(slave.get("slider.x").is_finite());
            None
        }) as crate::importer::Callback);
        let options = Options { event_mode, early_return: true, intermediate: &["slider.x"], update, logging: true };
        let (picture, events) = by_fmi3(options);
        assert_eq!(picture, by_fmi2());
        assert_eq!(events > 30, event_mode);
    }
}
