//! Errors of the integrator in the words of a scene.

use super::contacts::{subject, subject_of_event};
use super::error::SimulationError;
use crate::integrator::IntegrationError;
use crate::model::coordinates::state_variables;
use crate::scene::Scene;

/// Message for the only dead end of a mechanism's equations of motion.
const DEAD_END: &str =
    "the rod stands across the guide, where the slider may continue to either side of the change point";

/// What the integrator's numbers of states and events stand for. Only an error asks for it.
pub struct Names {
    scene: Box<Scene>,
}

impl Names {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self { scene: Box::new(scene.clone()) }
    }

    /// The simulation's error for one of the integrator.
    pub fn explain(&self, error: IntegrationError) -> SimulationError {
        let name = |place: usize| state_variables(&self.scene).into_iter().nth(place).map(|state| state.name);
        let state = |place: usize| name(place).unwrap_or_else(|| "a state".into());
        let subject_of = |event: usize| subject_of_event(&self.scene, event);
        // A step that nothing has judged may have led anywhere.
        let hint = if self.scene.solver.method.has("fixed step") { "; solver.step may be too long" } else { "" };
        let cause = match error {
            IntegrationError::StepUnderflow { step, component, .. } => {
                format!("a step of {step:.1e} s no longer moves time; the error of {} is the largest", state(component))
            }
            IntegrationError::NotFinite { component, .. } => {
                format!("the rate of {} is not finite, or too large to continue{hint}", state(component))
            }
            IntegrationError::EventsAccumulate { event, .. } => {
                format!("events accumulate at {}{hint}", subject_of(event))
            }
            IntegrationError::OutOfRange { event, .. } => {
                format!(
                    "{} is so deep in penetration that the journal lies outside its bearing; solver.step is too long",
                    subject_of(event)
                )
            }
            IntegrationError::TooDeep { contact, .. } => {
                format!(
                    "a step ends with {} deeper in penetration than its clearance; solver.step is too long",
                    subject(contact)
                )
            }
            IntegrationError::DeadEnd { .. } => DEAD_END.to_owned(),
            IntegrationError::TooMuchWork { .. } => format!("{error}; see solver.max_evaluations"),
            IntegrationError::Complementarity { .. } => error.to_string(),
        };
        let dead_end = matches!(error, IntegrationError::DeadEnd { .. });
        SimulationError::Integration { time: error.time(), cause, dead_end }
    }
}
