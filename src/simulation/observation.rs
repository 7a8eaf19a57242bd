//! Outputs of a mechanism and of its integrator.

use crate::integrator::Statistics;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::signals::{Outputs, SolverOutputs};
use crate::model::state::Contacts;

/// Outputs of the state `y` at `t`.
pub fn observe(plant: &dyn Plant, observer: &Observer, contacts: &Contacts, t: f64, y: &[f64]) -> Outputs {
    let instant = plant.instant(contacts, t, y);
    let penetration = plant.penetration(&instant.pose);
    let torque = plant.signal().at(t).crank_torque;
    let mut outputs = observer.outputs(&instant, contacts, &penetration, torque);
    outputs.energy = plant.energies(contacts, &instant, y);
    outputs
}

/// Counters as outputs.
pub fn solver_outputs(statistics: Statistics) -> SolverOutputs {
    let Statistics { steps, rejected, evaluations, events } = statistics;
    let count = |n: u64| i32::try_from(n).unwrap_or(i32::MAX);
    SolverOutputs {
        steps: count(steps),
        rejected: count(rejected),
        evaluations: count(evaluations),
        events: count(events),
        ..SolverOutputs::default()
    }
}
