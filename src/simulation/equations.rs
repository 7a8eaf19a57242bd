//! The equations of motion themselves, at any state: to be timed, to be tested, to be linearized.

use super::Simulation;

/// ẏ ≈ rates + by_state·Δy + by_time·Δt near one state and instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// [s]
    pub time: f64,
    /// Positions, their rates, first-order states.
    pub states: Vec<f64>,
    /// Number of positions.
    pub positions: usize,
    /// ẏ.
    pub rates: Vec<f64>,
    /// ∂ẏ_i/∂y_j in row i, column j.
    pub by_state: Vec<Vec<f64>>,
    /// ∂ẏ_i/∂t.
    pub by_time: Vec<f64>,
}

impl Simulation {
    /// [s] Time and states where the next step starts.
    pub fn front(&self) -> (f64, Vec<f64>) {
        self.motion.front()
    }

    /// Rates of the `states` at `time` [s] with the contacts closed that are so where the next step
    /// starts; states that are missing count as 0.
    pub fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        self.motion.rates_at(time, states)
    }

    /// The equations of motion near `states` and `time` [s], with the same contacts.
    pub fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        self.motion.linearization_at(time, states)
    }

    /// Evaluates the equations of motion so many times, for nothing: where the next step starts, to be timed.
    pub fn evaluate(&self, times: usize) {
        self.motion.evaluate(times);
    }

    /// Evaluates their derivatives so many times, likewise.
    pub fn differentiate(&self, times: usize) {
        self.motion.differentiate(times);
    }
}
