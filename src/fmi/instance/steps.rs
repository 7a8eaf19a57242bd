//! Steps and what came of them.

use super::super::error::{Error, VariableError};
use super::super::inputs::are_finite;
use super::super::lifecycle::State;
use super::super::status::{Status, StatusKind};
use super::super::variables::{Access, VARIABLES};
use super::Instance;
use super::values::finite;
use crate::simulation::SimulationError;

impl Instance {
    /// `fmi2DoStep`
    pub fn do_step(&mut self, point: f64, size: f64) -> Result<(), Error> {
        let end = self.experiment.step_end(self.time(), point, size)?;
        self.check_inputs(end)?;
        let outcome = self.live()?.advance_to(end);
        self.inputs.move_on();
        self.outputs = None;
        match &outcome {
            Ok(()) => {}
            Err(SimulationError::Integration { .. }) => self.state = State::StepFailed,
            Err(SimulationError::Scene(_) | SimulationError::Snapshot(_)) => self.fail(),
        }
        let outcome = outcome.map_err(Error::from);
        self.last_step = outcome.as_ref().err().map_or(Status::Ok, Error::status);
        outcome
    }

    /// Refuses a step over which the inputs' slopes lead beyond all numbers.
    fn check_inputs(&self, end: f64) -> Result<(), VariableError> {
        let inputs = self.inputs.values_until(self.time(), end);
        if are_finite(&inputs) {
            return Ok(());
        }
        VARIABLES.iter().try_for_each(|variable| match variable.access {
            Access::Input { get, .. } => finite(variable, get(&inputs)).map(drop),
            _ => Ok(()),
        })
    }

    /// `fmi2GetStatus`
    pub fn step_status(&self, kind: StatusKind) -> Result<Status, Error> {
        match kind {
            StatusKind::DoStep => Ok(self.last_step),
            other => Err(Error::StatusKind(other)),
        }
    }

    /// `fmi2GetRealStatus`
    pub fn real_status(&self, kind: StatusKind) -> Result<f64, Error> {
        match kind {
            StatusKind::LastSuccessfulTime => Ok(self.time()),
            other => Err(Error::StatusKind(other)),
        }
    }

    /// `fmi2GetBooleanStatus`. The mechanism never asks for the simulation's end.
    pub fn boolean_status(&self, kind: StatusKind) -> Result<bool, Error> {
        match kind {
            StatusKind::Terminated => Ok(false),
            other => Err(Error::StatusKind(other)),
        }
    }

    /// `fmi2GetIntegerStatus`, `fmi2GetStringStatus`: the standard has no integer status, and a
    /// string only about a step under way.
    pub fn no_status<T>(&self, kind: StatusKind) -> Result<T, Error> {
        Err(Error::StatusKind(kind))
    }
}
