//! Points of phase space, from which motions are compared, perturbed and started.

use serde::{Deserialize, Serialize};

/// A point of phase space: all quantities that determine how a motion continues under given inputs.
///
/// The approach speed of a closed contact belongs to it: two motions through the same states with different approach
/// speeds differ later, because the damping of the contact depends on how it closed. The states of an energy audit do
/// not belong to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Phase {
    /// [s] Time.
    pub time: f64,
    /// States: positions, their rates, bristle deflections.
    pub states: Vec<f64>,
    /// [m/s] Approach speeds of all contacts; `None` for an open contact.
    pub approach: Vec<Option<f64>>,
}

/// Scales of just noticeable differences in a [`Phase`].
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseScales {
    /// Scales of the states, each in the unit of its state.
    pub states: Vec<f64>,
    /// [m/s] Scale of approach speeds.
    pub approach: f64,
}
