//! Counters of the work done since the start.

/// Counts of steps, evaluations and events.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Number of accepted steps.
    pub steps: u64,
    /// Number of steps rejected for their error.
    pub rejected: u64,
    /// Number of evaluations of the rates by steps and by steps to events, without those for interpolation.
    pub evaluations: u64,
    /// Number of event functions that fell through zero.
    pub events: u64,
}
