//! What an estimator asks of a slave beyond the standard: the map of phase space over a step with its Jacobian, and to
//! continue from a corrected phase.

use super::access::{check_count, finite, finite_number, finite_output, real_output, real_parameter, variable};
use super::course::Course;
use super::error::{Error, VariableError};
use super::states::phase_names;
use super::variables::Access;
use super::{Slave, TOLERANCE, engine_of};
use crate::model::signals::{Inputs, Outputs};
use crate::simulation::SimulationError;
use crate::simulation::step_map::{By, PhaseNumbers, StepMap, StepRequest};

/// What an array of a phase has, for messages.
pub const PHASE: &str = "numbers of a phase";

/// A step with its Jacobian. Rows are those of the phase or of the outputs, columns those of the phase or of what else
/// was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The phase where the step begins.
    pub phase: Vec<f64>,
    /// The phase where it ends.
    pub next: Vec<f64>,
    /// The outputs there.
    pub outputs: Vec<f64>,
    /// The derivatives, if they were asked for.
    pub derivatives: Option<Derivatives>,
}

/// Derivatives of what a step ends with, matrices row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// Of the phase by the phase.
    pub phase_by_phase: Vec<f64>,
    /// Of the phase by the others.
    pub phase_by_others: Vec<f64>,
    /// Of the outputs by the phase.
    pub outputs_by_phase: Vec<f64>,
    /// Of the outputs by the others.
    pub outputs_by_others: Vec<f64>,
}

impl Slave {
    /// Names of the numbers of a phase, in their order.
    pub fn phase_names(&self) -> Vec<String> {
        phase_names(&self.settings.scene)
    }

    /// How many numbers a phase has.
    pub fn phase_count(&self) -> usize {
        PhaseNumbers::of(&self.settings.scene).count()
    }

    /// The step of `size` [s] from the communication point, made on a copy. With `derivatives` there are those by the
    /// phase and by `others`: real parameters and inputs. Outputs that the state does not determine have none.
    pub fn mapped_step(
        &mut self,
        size: f64,
        others: &[u32],
        outputs: &[u32],
        derivatives: bool,
    ) -> Result<Step, Error> {
        let by = others.iter().map(|reference| by(*reference)).collect::<Result<Vec<_>, _>>()?;
        check_once(others)?;
        let undetermined = Outputs::undetermined();
        let readers = outputs.iter().map(|reference| {
            let variable = variable(*reference)?;
            let read = real_output(variable)?;
            if derivatives && read(&undetermined).is_nan() {
                return Err(VariableError::Kind(variable.name, "determined by the state, and has no derivative"));
            }
            Ok(read)
        });
        let readers = readers.collect::<Result<Vec<_>, VariableError>>()?;
        let request = StepRequest { end: self.step_end(self.time(), size)?, derivatives, by };
        let scene = self.settings.simulated_scene()?;
        let numbers = PhaseNumbers::of(&scene);
        let (snapshot, start) = (self.live()?.snapshot(), self.settings.experiment.start);
        let mut found = vec![Outputs::default(); request.output_sets(&numbers)];
        let StepMap { phase, next, jacobian } = engine_of(self.newer, &scene)
            .step_map(&scene, &snapshot, &request, &mut found)
            .map_err(|error| error.counted_from(start))?;
        let names = self.phase_names();
        for (name, value) in names.iter().zip(&next) {
            finite_phase(name, *value)?;
        }
        let values = outputs.iter().zip(&readers).map(|(reference, read)| {
            found.iter().map(|outputs| finite_output(variable(*reference)?, read(outputs))).collect()
        });
        let rows = values.collect::<Result<Vec<Vec<f64>>, Error>>()?;
        for value in jacobian.iter().flatten() {
            finite_number("a derivative of the phase", *value)?;
        }
        let count = phase.len();
        let derivatives = derivatives.then(|| Derivatives {
            phase_by_phase: jacobian.iter().flat_map(|row| &row[..count]).copied().collect(),
            phase_by_others: jacobian.iter().flat_map(|row| &row[count..]).copied().collect(),
            outputs_by_phase: rows.iter().flat_map(|row| &row[1..=count]).copied().collect(),
            outputs_by_others: rows.iter().flat_map(|row| &row[1 + count..]).copied().collect(),
        });
        Ok(Step { phase, next, outputs: rows.iter().map(|row| row[0]).collect(), derivatives })
    }

    /// Continues from these numbers of a phase at the communication point, with these values of real parameters.
    pub fn set_phase(&mut self, phase: &[f64], parameters: &[u32], values: &[f64]) -> Result<(), Error> {
        let numbers = PhaseNumbers::of(&self.settings.scene);
        check_count(PHASE, phase.len(), numbers.count())?;
        for (name, value) in self.phase_names().iter().zip(phase) {
            finite_phase(name, *value)?;
        }
        check_once(parameters)?;
        let mut settings = self.settings.clone();
        for (reference, value) in parameters.iter().zip(values) {
            let variable = variable(*reference)?;
            let parameter = real_parameter(variable).ok_or(VariableError::Kind(variable.name, "a real parameter"))?;
            parameter.write(&mut settings.scene, finite(variable, *value)?)?;
            settings.tolerance_set |= parameter.name == TOLERANCE;
        }
        let (present, scene) = (self.settings.simulated_scene()?, settings.simulated_scene()?);
        let mut run = engine_of(self.newer, &present).restore(&present, &self.live()?.snapshot())?;
        let placed = numbers.phase(run.time(), phase);
        run.place(&placed);
        // The last step is over now. It may have been longer than any step with new values of parameters.
        run = engine_of(self.newer, &scene).restore(&scene, &run.snapshot()).map_err(|error| match error {
            SimulationError::Snapshot(_) => self.beyond(phase),
            other => other.into(),
        })?;
        run.place(&placed);
        (self.settings.scene, self.settings.tolerance_set) = (settings.scene, settings.tolerance_set);
        (self.course, self.outputs) = (Some(Course::Own(run)), None);
        Ok(())
    }

    /// The error of a phase so far away that it cannot be saved.
    fn beyond(&self, phase: &[f64]) -> Error {
        let all = self.phase_names().into_iter().zip(phase.iter().copied());
        let (name, value) = all.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or_default();
        Error::PhaseBeyond(name, value)
    }
}

/// What to differentiate by.
fn by(reference: u32) -> Result<By, VariableError> {
    let variable = variable(reference)?;
    if let Access::Input { set, .. } = variable.access {
        let mut inputs = Inputs::default();
        set(&mut inputs, 1.0);
        return Ok(if inputs.crank_torque == 1.0 { By::CrankTorque } else { By::SliderLoad });
    }
    let parameter = real_parameter(variable).ok_or(VariableError::Kind(variable.name, "a real parameter or input"))?;
    Ok(By::Parameter(parameter.name.into()))
}

/// Refuses a variable that is named twice.
fn check_once(references: &[u32]) -> Result<(), VariableError> {
    for (place, reference) in references.iter().enumerate() {
        let variable = variable(*reference)?;
        if references[..place].contains(reference) {
            return Err(VariableError::Twice(variable.name));
        }
    }
    Ok(())
}

fn finite_phase(name: &str, value: f64) -> Result<(), Error> {
    if value.is_finite() { Ok(()) } else { Err(Error::PhaseNotFinite(name.into(), value)) }
}
