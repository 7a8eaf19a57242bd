//! The operating system's scheduler: a thread of a controller runs at a real-time priority, where it is allowed to.

use std::thread;

/// The scheduler of a measurement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Scheduler {
    /// SCHED_FIFO, which lets no other program interrupt the thread.
    RealTime,
    /// The usual one, and why the machine refused the other.
    Usual(String),
}

impl Scheduler {
    /// Sentence about a measurement.
    pub fn sentence(&self) -> String {
        match self {
            Self::RealTime => "The steps within a deadline ran under the real-time scheduler SCHED_FIFO.".into(),
            Self::Usual(why) => format!(
                "The steps within a deadline ran under the usual scheduler, because the machine refused SCHED_FIFO: {why}."
            ),
        }
    }
}

/// Does `work` in a thread of its own, under the real-time scheduler if the machine allows it.
pub fn in_real_time<T: Send>(work: impl FnOnce() -> T + Send) -> (T, Scheduler) {
    thread::scope(|scope| {
        let thread = scope.spawn(|| {
            let scheduler = request().map_or_else(Scheduler::Usual, |()| Scheduler::RealTime);
            (work(), scheduler)
        });
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Asks for the lowest real-time priority for this thread.
#[cfg(target_os = "linux")]
fn request() -> Result<(), String> {
    use thread_priority::unix::set_thread_priority_and_policy;
    use thread_priority::{RealtimeThreadSchedulePolicy, ThreadPriority, ThreadSchedulePolicy, thread_native_id};
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Min, policy).map_err(|error| error.to_string())
}

#[cfg(not(target_os = "linux"))]
fn request() -> Result<(), String> {
    Err("it is asked for on Linux only".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_is_told() {
        let sentence = Scheduler::Usual("no right".into()).sentence();
        assert!(sentence.ends_with("refused SCHED_FIFO: no right."), "{sentence}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_is_said_is_what_the_system_does() {
        use thread_priority::{RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, thread_schedule_policy};
        let fifo = || {
            let policy = thread_schedule_policy().expect("a policy");
            policy == ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo)
        };
        let (is_fifo, scheduler) = in_real_time(fifo);
        assert_eq!(is_fifo, scheduler == Scheduler::RealTime, "{scheduler:?}");
        assert!(!fifo(), "the other threads keep their scheduler");
    }
}
