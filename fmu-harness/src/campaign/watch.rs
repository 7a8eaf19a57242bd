//! Watches trials that run at the same time, and reports a trial that does not end.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Time between two checks.
const LOOKS: Duration = Duration::from_millis(200);

/// The running trials, by their numbers.
#[derive(Default)]
pub struct Watch {
    running: Mutex<HashMap<u64, Instant>>,
    over: AtomicBool,
}

impl Watch {
    /// Runs `work` as the trial of this number.
    pub fn over<T>(&self, number: u64, work: impl FnOnce() -> T) -> T {
        self.running.lock().unwrap_or_else(PoisonError::into_inner).insert(number, Instant::now());
        let done = work();
        self.running.lock().unwrap_or_else(PoisonError::into_inner).remove(&number);
        done
    }

    /// Waits until [`Watch::end`] is called. Calls `late` once for the number of every trial that runs longer than
    /// `limit`.
    pub fn wait(&self, limit: Duration, late: impl Fn(u64)) {
        let mut told = vec![];
        while !self.over.load(Ordering::Relaxed) {
            sleep(LOOKS);
            let running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
            let mut found: Vec<u64> =
                running.iter().filter(|(_, since)| since.elapsed() > limit).map(|(number, _)| *number).collect();
            drop(running);
            found.retain(|number| !told.contains(number));
            found.iter().for_each(|number| late(*number));
            told.extend(found);
        }
    }

    /// Makes [`Watch::wait`] return.
    pub fn end(&self) {
        self.over.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU64;
    use std::thread::scope;

    #[test]
    fn what_runs_too_long_is_told_and_what_ends_in_time_is_not() {
        let (watch, told) = (Watch::default(), AtomicU64::new(0));
        scope(|threads| {
            threads.spawn(|| {
                watch.wait(Duration::from_millis(300), |number| {
                    told.fetch_add(number, Ordering::Relaxed);
                })
            });
            assert_eq!(watch.over(1, || 5), 5);
            watch.over(20, || sleep(Duration::from_millis(900)));
            watch.end();
        });
        assert_eq!(told.into_inner(), 20, "once");
    }
}
