//! Points of phase space: where a motion is, to be compared, perturbed and started from.

/// All that decides how a motion goes on under given inputs.
///
/// A contact's approach speed belongs to it: two motions through the same states with other approach speeds part, since
/// the damping of a lasting contact remembers how it closed. An audit's sums do not.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// [s]
    pub time: f64,
    /// Positions, their rates, bristles.
    pub states: Vec<f64>,
    /// [m/s] Approach speeds of the closed contacts; `None` of an open one.
    pub approach: Vec<Option<f64>>,
}

/// What size of difference is noticeable in a [`Phase`].
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseScales {
    /// Of the states.
    pub states: Vec<f64>,
    /// [m/s] Of approach speeds.
    pub approach: f64,
}
