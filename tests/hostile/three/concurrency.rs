//! A second thread in an instance whose step is under way, while the importer's callback runs.

use crate::brief;
use crate::importer::{Callback, Handle, Options, Slave};
use slidercrank::fmi::v3::Status;
use slidercrank::fmi::v3::abi::functions::bodies::{fmi3FreeInstance, fmi3Terminate};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// An instance, for a thread that no host may have.
#[derive(Clone, Copy)]
struct Shared(Handle);

// SAFETY: the component refuses a call while another is under way, and these calls write no line to the log.
unsafe impl Send for Shared {}

fn slave() -> Slave {
    let update: Callback = Box::new(|slave, _, _| {
        // The other thread has time to come in, and may be in.
        thread::yield_now();
        let _ = slave.try_get("slider.a");
        None
    });
    Slave::running(Options { intermediate: &["slider.a"], update: Some(update), ..Options::default() })
}

#[test]
fn a_second_thread_within_a_step_reads_or_is_refused_and_the_step_goes_on() {
    let (slave, over, reads) = (slave(), AtomicBool::new(false), AtomicUsize::new(0));
    let shared = Shared(*slave);
    let steps = if brief() { 5 } else { 200 };
    let mut point = 0.0;
    thread::scope(|scope| {
        let (over, reads) = (&over, &reads);
        scope.spawn(move || {
            let shared = shared;
            let Shared(handle) = shared;
            while !over.load(Ordering::Relaxed) {
                match handle.try_get("slider.a") {
                    Ok(value) => assert!(value.is_finite()),
                    Err(status) => assert_eq!(status, Status::Error),
                }
                reads.fetch_add(1, Ordering::Relaxed);
            }
        });
        for _ in 0..steps {
            // The intruder may be in where a step begins.
            point = loop {
                if let Ok(told) = slave.try_step(point, 1e-4) {
                    break told.time;
                }
            };
        }
        over.store(true, Ordering::Relaxed);
    });
    let alone = self::slave();
    let mut point = 0.0;
    for _ in 0..steps {
        point = alone.step(point, 1e-4).time;
    }
    assert_eq!(slave.picture(), alone.picture(), "{reads:?} calls of the other thread");
    assert_eq!(slave.lines(), []);
}

#[test]
fn a_second_thread_within_an_update_cannot_end_the_instance() {
    let update: Callback = Box::new(|slave, _, _| {
        let shared = Shared(*slave);
        let other = thread::spawn(move || {
            let shared = shared;
            // SAFETY: live; both are refused.
            unsafe {
                assert_eq!(fmi3Terminate(shared.0.0), Status::Error);
                fmi3FreeInstance(shared.0.0);
            }
        });
        other.join().expect("no crash");
        None
    });
    let slave = Slave::running(Options { update: Some(update), ..Options::default() });
    slave.step(0.0, 1e-3);
    let lines = slave.lines();
    assert!(!lines.is_empty() && lines.len().is_multiple_of(2), "{lines:?}");
    assert!(
        lines.iter().all(|line| line.text.contains("not allowed in state 'intermediate update mode'")),
        "{lines:?}"
    );
    slave.step(1e-3, 1e-3);
}
