//! Rates of the states at any state, and their derivatives.

use super::equations::write;
use crate::integrator::{Jacobian, StateLayout};
use crate::model::mechanism_model::MechanismModel;
use crate::model::state::Conditions;

/// Linearization at one state and time: ẏ ≈ rates + by_state·Δy + by_time·Δt.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// [s] Time.
    pub time: f64,
    /// States: positions, their rates, first-order states.
    pub states: Vec<f64>,
    /// Number of positions.
    pub positions: usize,
    /// Rates ẏ.
    pub rates: Vec<f64>,
    /// ∂ẏ_i/∂y_j in row i, column j.
    pub by_state: Vec<Vec<f64>>,
    /// ∂ẏ_i/∂t.
    pub by_time: Vec<f64>,
}

/// Rates of the `states` at `time` [s]; missing states count as 0.
pub fn rates_at(model: &dyn MechanismModel, conditions: &Conditions, time: f64, states: &[f64]) -> Vec<f64> {
    let n = model.layout().states;
    let mut rates = vec![0.0; n];
    model.rates(conditions, time, &filled(states, n), &mut rates);
    rates
}

/// The linearization of the equations of motion of `model` at `states` and `time` [s]; missing states count as 0.
pub fn linearization(model: &dyn MechanismModel, conditions: &Conditions, time: f64, states: &[f64]) -> Linearization {
    let StateLayout { positions, states: n, .. } = model.layout();
    let states = filled(states, n);
    let (mut rates, mut jacobian) = (vec![0.0; n], Jacobian::new(n));
    model.rates(conditions, time, &states, &mut rates);
    model.jacobian(conditions, time, &states, &mut jacobian);
    let by_state = (0..n).map(|i| jacobian.row(i).to_vec()).collect();
    Linearization { time, states, positions, rates, by_state, by_time: jacobian.time }
}

/// The state `list` as a list of `states` numbers, padded with zeros.
pub fn filled(list: &[f64], states: usize) -> Vec<f64> {
    let mut all = vec![0.0; states];
    write(list, &mut all);
    all
}
