//! Work done since the start.

/// Counts of steps, evaluations and events.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Steps rejected for their error.
    pub rejected: u64,
    /// Evaluations of the right-hand side by steps and by landing on events; interpolation apart.
    pub evaluations: u64,
    /// Guards that fell through zero.
    pub events: u64,
}
