//! Outputs of a mechanism and of its integrator.

use crate::integrator::{Account, Statistics};
use crate::math::PORTABLE;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::signals::{Outputs, SolverOutputs};
use crate::model::state::Conditions;

/// Outputs of the state `y` at `t`, without the integrator's counters.
pub fn observe(model: &dyn MechanismModel, observer: &Observer, conditions: &Conditions, t: f64, y: &[f64]) -> Outputs {
    let evaluation = model.evaluation(conditions, t, y);
    let penetration = model.penetration(&evaluation.pose);
    let torque = conditions.inputs.at(t).crank_torque;
    let mut outputs = observer.outputs(&evaluation, conditions, &penetration, torque);
    outputs.energy = model.energies(&conditions.contacts, &evaluation, y);
    outputs
}

/// Counters of the integrator as outputs; larger counts saturate. `relative` is the scale of positions over the smallest
/// clearance.
pub fn solver_outputs(statistics: Statistics, account: &Account, relative: f64) -> SolverOutputs {
    let Statistics { steps, rejected, evaluations, events } = statistics;
    let count = |n: u64| i32::try_from(n).unwrap_or(i32::MAX);
    SolverOutputs {
        steps: count(steps),
        rejected: count(rejected),
        evaluations: count(evaluations),
        events: count(events),
        deadline_hits: count(account.hits),
        error_estimate: relative * account.error,
        ..SolverOutputs::default()
    }
}

/// Outputs with the settings in use: the tolerance and the library.
pub fn with_settings(mut outputs: Outputs, tolerance: f64) -> Outputs {
    (outputs.solver.tolerance_used, outputs.solver.portable_used) = (tolerance, PORTABLE);
    outputs
}
