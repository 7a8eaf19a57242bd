//! Why the integrator cannot go on.

use super::system::EventFunction;
use std::fmt;

/// The time reached, and the cause. The state at that time is intact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntegrationError {
    /// The step no longer moves time.
    StepUnderflow {
        /// [s] Time reached.
        time: f64,
        /// [s] The step asked for.
        step: f64,
        /// The state with the largest error.
        component: usize,
    },
    /// The rates at an end of a step are not numbers, or too large to go on with.
    NotFinite {
        /// [s] Time reached.
        time: f64,
        /// The first state with such a rate.
        component: usize,
    },
    /// Events follow each other without time passing.
    EventsAccumulate {
        /// [s] Time reached.
        time: f64,
        /// The event function that is lowest.
        event: usize,
    },
    /// The motion has come to where its equations have no meaning.
    DeadEnd {
        /// [s] Time reached.
        time: f64,
        /// The event function that fell.
        event: usize,
    },
    /// One advance takes more evaluations of the rates than it may.
    TooMuchWork {
        /// [s] Time reached.
        time: f64,
        /// How many were made, or may be.
        evaluations: u64,
    },
    /// No impulses satisfy the laws of the rigid contacts that are closed.
    Complementarity {
        /// [s] Time reached.
        time: f64,
        /// How many are closed.
        contacts: usize,
    },
}

impl IntegrationError {
    /// Events without end at `time`: the event function that is lowest stands for all.
    pub(super) fn events_accumulate(time: f64, functions: &[EventFunction]) -> Self {
        let lowest = |i: &usize, j: &usize| functions[*i].value.total_cmp(&functions[*j].value);
        Self::EventsAccumulate { time, event: (0..functions.len()).min_by(lowest).unwrap_or_default() }
    }

    /// [s] Time reached.
    pub fn time(&self) -> f64 {
        match *self {
            Self::StepUnderflow { time, .. }
            | Self::NotFinite { time, .. }
            | Self::EventsAccumulate { time, .. }
            | Self::DeadEnd { time, .. }
            | Self::TooMuchWork { time, .. }
            | Self::Complementarity { time, .. } => time,
        }
    }
}

impl fmt::Display for IntegrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepUnderflow { step, component, .. } => {
                write!(f, "a step of {step:.1e} s no longer moves time; component {component} sets the error")
            }
            Self::NotFinite { component, .. } => {
                write!(f, "the rate of component {component} is not finite, or too large to go on with")
            }
            Self::EventsAccumulate { event, .. } => {
                write!(f, "events accumulate; event function {event} is lowest")
            }
            Self::DeadEnd { event, .. } => {
                write!(f, "no motion leads beyond the fall of event function {event}")
            }
            Self::TooMuchWork { evaluations, .. } => {
                write!(f, "{evaluations} evaluations do not reach the communication point")
            }
            Self::Complementarity { contacts, .. } => {
                write!(f, "no impulses satisfy the laws of {contacts} closed contacts at once")
            }
        }
    }
}

impl std::error::Error for IntegrationError {}
