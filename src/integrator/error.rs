//! Errors that stop the integrator.

use super::system::EventFunction;
use std::fmt;

/// The time reached and the cause. The state at that time is intact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntegrationError {
    /// The step has become so short that it no longer moves time.
    StepUnderflow {
        /// [s] Time reached.
        time: f64,
        /// [s] Length of the step.
        step: f64,
        /// Index of the state with the largest error.
        component: usize,
    },
    /// The rates at the start or end of a step are NaN, infinite or too large to continue.
    NotFinite {
        /// [s] Time reached.
        time: f64,
        /// Index of the first such state.
        component: usize,
    },
    /// Events follow each other without time passing.
    EventsAccumulate {
        /// [s] Time reached.
        time: f64,
        /// Index of the smallest event function.
        event: usize,
    },
    /// The motion has reached a configuration in which its equations are singular.
    DeadEnd {
        /// [s] Time reached.
        time: f64,
        /// Index of the event function that fell through zero.
        event: usize,
    },
    /// One advance takes more evaluations of the rates than the work limit allows.
    TooMuchWork {
        /// [s] Time reached.
        time: f64,
        /// Number of evaluations made, or allowed.
        evaluations: u64,
    },
    /// No impulses satisfy the contact laws of the closed rigid contacts.
    Complementarity {
        /// [s] Time reached.
        time: f64,
        /// Number of closed contacts.
        contacts: usize,
    },
    /// The motion has left the range in which the equations hold.
    OutOfRange {
        /// [s] Time reached.
        time: f64,
        /// Index of the event function that is too high.
        event: usize,
    },
    /// A step leaves a rigid contact deeper in penetration than its play is wide.
    TooDeep {
        /// [s] Time reached.
        time: f64,
        /// Index of the contact.
        contact: usize,
    },
}

impl IntegrationError {
    /// Events that follow each other without end at `time`; the smallest event function is named.
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
            | Self::Complementarity { time, .. }
            | Self::OutOfRange { time, .. }
            | Self::TooDeep { time, .. } => time,
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
                write!(f, "the rate of component {component} is not finite, or too large to continue")
            }
            Self::EventsAccumulate { event, .. } => {
                write!(f, "events accumulate; event function {event} is lowest")
            }
            Self::DeadEnd { event, .. } => {
                write!(f, "the equations are singular where event function {event} falls through zero")
            }
            Self::TooMuchWork { evaluations, .. } => {
                write!(f, "{evaluations} evaluations of the rates do not suffice to reach the communication point")
            }
            Self::Complementarity { contacts, .. } => {
                write!(f, "no impulses satisfy the laws of {contacts} closed contacts at once")
            }
            Self::OutOfRange { event, .. } => {
                write!(f, "the equations do not hold where event function {event} is so high")
            }
            Self::TooDeep { contact, .. } => {
                write!(f, "the step is too long for contact {contact}, whose penetration exceeds its clearance")
            }
        }
    }
}

impl std::error::Error for IntegrationError {}
