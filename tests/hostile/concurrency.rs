//! Many instances in many threads, and many threads in one instance.

use crate::face::Face;
use crate::scenes::{MECHANISMS, hosted};
use crate::{brief, tried};
use crate::{three, two};
use slidercrank::fmi::v2::Status;
use std::sync::Barrier;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

const THREADS: usize = 8;
/// [s]
const H: f64 = 1e-4;

/// The instance of this number, at time 0: each of its own.
fn nth<F: Face>(number: usize) -> F {
    let mechanisms = hosted::<F>();
    let slave: F = MECHANISMS[mechanisms[number % mechanisms.len()]].initializing();
    assert_eq!(slave.set("crank.speed_start", 100.0 + number as f64), Status::Ok);
    assert_eq!(slave.begin(), Status::Ok);
    slave
}

/// Marches instances side by side, with inputs set on the way; what each is in the end, bit for bit.
fn march<F: Face>(slaves: &[(usize, F)]) -> Vec<Vec<u8>> {
    let mut point = 0.0;
    for step in 0..if brief() { 3 } else { tried(30) as usize } {
        for (number, slave) in slaves {
            assert_eq!(slave.set("slider.load", (number + step) as f64), Status::Ok);
            slave.steps(point, H, 1);
            slave.get("slider.a");
        }
        point += H * F::pace();
    }
    slaves.iter().map(|(_, slave)| slave.memory()).collect()
}

fn sixty_four_instances_in_eight_threads_are_what_each_is_alone<F: Face>() {
    let each = if brief() { 2 } else { 8 };
    let start = Barrier::new(THREADS);
    let mine = |thread: usize| (0..each).map(move |i| i * THREADS + thread);
    let together = |thread: usize| {
        start.wait();
        // Made, run and freed while all the others are.
        march(&mine(thread).map(|number| (number, nth::<F>(number))).collect::<Vec<_>>())
    };
    let states: Vec<Vec<Vec<u8>>> = thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|thread| scope.spawn(move || together(thread))).collect();
        threads.into_iter().map(|thread| thread.join().expect("a run")).collect()
    });
    for (thread, together) in states.iter().enumerate() {
        for (number, bytes) in mine(thread).zip(together) {
            assert_eq!(&march(&[(number, nth::<F>(number))])[0], bytes, "instance {number}");
        }
    }
}

/// The same instance for several threads at once, which no host may do.
struct Shared<F>(F);

// SAFETY: the component refuses a call while another is under way.
unsafe impl<F> Sync for Shared<F> {}

/// In hosts whose step is one call.
fn a_second_thread_in_an_instance_is_refused_or_waits_for_no_one<F: Face>() {
    let shared = Shared(nth::<F>(0));
    let over = AtomicBool::new(false);
    let (mut taken, mut refused) = (0, 0);
    thread::scope(|scope| {
        let (slave, over) = (&shared, &over);
        let intruder = scope.spawn(move || {
            let slave = &slave.0;
            let (mut taken, mut refused) = (0_usize, 0_usize);
            while !over.load(Ordering::Relaxed) {
                match slave.try_get("slider.a") {
                    Ok(_) => taken += 1,
                    Err(status) => {
                        assert_eq!(status, Status::Error);
                        refused += 1;
                    }
                }
            }
            (taken, refused)
        });
        let mut point = 0.0;
        for _ in 0..if brief() { 5 } else { 200 } {
            // The intruder may be in.
            while slave.0.step(point, H) != Status::Ok {}
            point += H;
        }
        over.store(true, Ordering::Relaxed);
        (taken, refused) = intruder.join().expect("no crash");
    });
    let alone = nth::<F>(0);
    alone.steps(0.0, H, if brief() { 5 } else { 200 });
    assert_eq!(shared.0.everything(), alone.everything(), "{taken} calls let in, {refused} refused");
    assert_eq!(shared.0.lines(), []);
}

#[test]
fn a_second_thread_in_an_instance_of_either_version_is_refused_or_waits_for_no_one() {
    a_second_thread_in_an_instance_is_refused_or_waits_for_no_one::<two::Stepping>();
    a_second_thread_in_an_instance_is_refused_or_waits_for_no_one::<three::Stepping>();
}

on_each_face! {
    sixty_four_instances_in_eight_threads_are_what_each_is_alone
}
