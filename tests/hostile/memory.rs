//! What instances leave behind in memory: nothing, but for hosts that never free.

use crate::brief;
use crate::face::Face;
use crate::scenes::{MECHANISMS, hosted};
use crate::{three, two};
use slidercrank::fmi::v2::Status;
use std::alloc::{GlobalAlloc, Layout, System};
use std::any::Any;
use std::cell::Cell;
use std::process::Command;

thread_local! {
    /// Bytes that this thread has allocated and not given back.
    static LIVE: Cell<isize> = const { Cell::new(0) };
}

/// The system's allocator, counting.
struct Counting;

// SAFETY: everything is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        LIVE.set(LIVE.get() + layout.size() as isize);
        // SAFETY: passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.set(LIVE.get() - layout.size() as isize);
        // SAFETY: passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a host does with one instance before it frees it, if it does.
type Life = fn() -> Box<dyn Any>;

fn made<F: Face + 'static>() -> Box<dyn Any> {
    Box::new(F::new())
}

fn run<F: Face + 'static>() -> Box<dyn Any> {
    let slave: F = MECHANISMS[hosted::<F>()[0]].running();
    slave.steps(0.0, 1e-4, 1);
    let mut state = slave.save();
    assert_eq!(slave.restore(state), Status::Ok);
    assert_eq!(slave.forget(&mut state), Status::Ok);
    Box::new(slave)
}

/// Saves each step and frees no state.
fn hoarder<F: Face + 'static>() -> Box<dyn Any> {
    let mechanisms = hosted::<F>();
    // Four plays, if there is a choice.
    let slave: F = MECHANISMS[*mechanisms.get(4).unwrap_or(&mechanisms[0])].running();
    let mut point = 0.0;
    for _ in 0..5 {
        let state = slave.deserialize(&slave.bytes(slave.save())).expect("sound bytes");
        assert_eq!(slave.restore(state), Status::Ok);
        point = slave.steps(point, 1e-5, 1);
    }
    Box::new(slave)
}

/// Is refused again and again.
fn blunderer<F: Face + 'static>() -> Box<dyn Any> {
    let slave = F::new();
    let state = slave.save();
    let bytes = slave.bytes(state);
    for length in [0, 50, bytes.len() - 1] {
        assert!(slave.deserialize(&bytes[..length]).is_err());
    }
    assert_eq!(slave.step(0.0, 1.0), Status::Error);
    assert_eq!(slave.set("slider.load", f64::NAN), Status::Error);
    Box::new(slave)
}

/// The lives of an instance of each kind.
macro_rules! lives {
    ($($version:literal $face:ty),+) => {
        &[$(
            (concat!($version, ", made and freed"), made::<$face> as Life),
            (concat!($version, ", run"), run::<$face>),
            (concat!($version, ", hoarder of states"), hoarder::<$face>),
            (concat!($version, ", blunderer"), blunderer::<$face>),
        )+]
    };
}

const LIVES: &[(&str, Life)] = lives!("FMI 2.0" two::Stepping, "FMI 3.0" three::Stepping, "events" three::Events, "model exchange" three::Exchange);

#[test]
fn an_instance_gives_back_every_byte() {
    for (name, life) in LIVES {
        drop(life());
        let before = LIVE.get();
        (0..10).for_each(|_| drop(life()));
        assert_eq!(LIVE.get(), before, "{name}");
    }
}

/// Which life a process of its own is to see.
const LIFE: &str = "SLIDERCRANK_TEST_LIFE";

/// Runs a test below in a process of its own, where no other test allocates.
fn alone(test: &str, life: &str) {
    let output = Command::new(std::env::current_exe().expect("a path"))
        .args(["--exact", &format!("memory::{test}"), "--ignored", "--nocapture"])
        .env(LIFE, life)
        .output()
        .expect("another process");
    let told = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && told.contains("1 passed"), "{life}: {told}");
    println!("{life}: {}", told.lines().find(|line| line.contains("pages")).unwrap_or_default());
}

fn chosen() -> Option<Life> {
    let wanted = std::env::var(LIFE).ok()?;
    LIVES.iter().find(|(name, _)| *name == wanted).map(|(_, life)| *life)
}

#[test]
#[cfg(target_os = "linux")]
fn two_thousand_instances_take_no_more_room_than_one() {
    LIVES.iter().for_each(|(name, _)| alone("two_thousand_lives", name));
}

/// Pages of this process that come from no file, counted when asked: `/proc/self/statm` lags behind by some dozens, and code
/// comes in sixteen pages at a time, whenever it is first needed.
#[cfg(target_os = "linux")]
fn resident() -> usize {
    let map = std::fs::read_to_string("/proc/self/smaps_rollup").expect("Linux");
    let line = map.lines().find_map(|line| line.strip_prefix("Anonymous:")).expect("a line");
    line.trim().strip_suffix("kB").and_then(|size| size.trim().parse::<usize>().ok()).expect("a number of kB") / 4
}

#[test]
#[ignore = "run by the test above, in a process of its own"]
#[cfg(target_os = "linux")]
fn two_thousand_lives() {
    let Some(life) = chosen() else { return };
    let cycles = if brief() { 200 } else { 2_000 };
    (0..cycles).for_each(|_| drop(life()));
    let before = resident();
    (0..cycles).for_each(|_| drop(life()));
    let after = resident();
    println!("{before} pages, {after} pages after {cycles} more");
    // The smallest block of the C library lost in each instance, 32 bytes, would be 15 pages.
    assert!(after <= before + 8, "{before} pages before, {after} after");
}

#[test]
fn a_process_ends_well_whatever_was_never_freed() {
    LIVES.iter().for_each(|(name, _)| alone("a_thousand_leaks", name));
}

#[test]
#[ignore = "run by the test above, in a process of its own"]
fn a_thousand_leaks() {
    let Some(life) = chosen() else { return };
    (0..1000).for_each(|_| std::mem::forget(life()));
    // Threads that end with instances of theirs alive, too.
    let leak = move || (0..10).for_each(|_| std::mem::forget(life()));
    std::thread::spawn(leak).join().expect("a thread that ends well");
}
