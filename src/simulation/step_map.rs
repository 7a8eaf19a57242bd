//! The map of phase space over one step, x⁺ = Φ(x, p), with its Jacobian: what estimators predict with.
//!
//! A phase as numbers: the states without the sums of an energy audit, then one approach speed [m/s] for each contact
//! that may close, 0 for an open one.

use super::contacts::{contacts, subject, subject_of_event};
use super::error::SimulationError;
use super::observation::with_settings;
use super::phase::Phase;
use super::variation::{Grazing, Seed, Variation};
use super::{Simulation, Snapshot};
use crate::model::coordinates::{Role, state_variables};
use crate::model::signals::Outputs;
use crate::model::state::CONTACTS;
use crate::scene::parameter::Parameter;
use crate::scene::{Method, Scene};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Which numbers a scene's phase has.
pub struct PhaseNumbers {
    /// How many states come first.
    pub states: usize,
    /// The contacts whose approach speeds follow; rigid contacts remember none.
    pub contacts: Vec<usize>,
}

/// By what, besides the phase, a step is differentiated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum By {
    /// A real parameter, by its name.
    Parameter(String),
    /// [N·m] The crank torque.
    CrankTorque,
    /// [N] The slider load.
    SliderLoad,
}

/// A step from a snapshot, and the derivatives that are asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRequest {
    /// [s] Where the step ends, relative to the start.
    pub end: f64,
    /// Whether there are derivatives by the phase and by the following numbers.
    pub derivatives: bool,
    /// Columns after those of the phase.
    pub by: Vec<By>,
}

/// Both ends of a step, and its Jacobian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepMap {
    /// The phase where the step begins.
    pub phase: Vec<f64>,
    /// The phase where it ends.
    pub next: Vec<f64>,
    /// ∂next/∂(phase, others), one row for each number of the phase; empty without derivatives.
    pub jacobian: Vec<Vec<f64>>,
}

impl PhaseNumbers {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        let states = state_variables(scene).iter().filter(|state| state.role != Role::Sum).count();
        let contacts = if scene.solver.method == Method::Moreau { vec![] } else { contacts(scene) };
        Self { states, contacts }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.states + self.contacts.len()
    }

    /// The numbers of a phase.
    fn numbers(&self, phase: &Phase) -> Vec<f64> {
        let approach = self.contacts.iter().map(|contact| phase.approach[*contact].unwrap_or_default());
        phase.states[..self.states].iter().copied().chain(approach).collect()
    }

    /// The phase of these numbers at `time` [s]. A contact without a positive approach speed is open.
    pub fn phase(&self, time: f64, numbers: &[f64]) -> Phase {
        let (states, speeds) = numbers.split_at(self.states);
        let mut approach = vec![None; CONTACTS];
        for (contact, speed) in self.contacts.iter().zip(speeds) {
            approach[*contact] = Some(*speed).filter(|speed| *speed > 0.0);
        }
        Phase { time, states: states.to_vec(), approach }
    }

    /// A direction for each number.
    fn seeds(&self) -> impl Iterator<Item = Seed> {
        let approaches = self.contacts.iter().map(|contact| Seed::Approach(*contact));
        (0..self.states).map(Seed::State).chain(approaches)
    }

    /// The rows of directions that belong to these numbers. `states` are all states, with the sums of an audit.
    fn rows(&self, directions: &DMatrix<f64>) -> Vec<Vec<f64>> {
        let first_contact = directions.nrows() - CONTACTS;
        let contacts = self.contacts.iter().map(|contact| first_contact + contact);
        (0..self.states).chain(contacts).map(|row| directions.row(row).iter().copied().collect()).collect()
    }
}

impl StepRequest {
    /// How many sets of outputs [`step_map`] writes.
    pub fn output_sets(&self, numbers: &PhaseNumbers) -> usize {
        if self.derivatives { 1 + numbers.count() + self.by.len() } else { 1 }
    }
}

/// Makes a step on a copy of the run that `snapshot` is of. Writes the outputs at its end and, with derivatives, their
/// derivatives by each number of the phase and by each of the others.
///
/// # Errors
/// As [`Simulation::restore`] and [`Simulation::advance_to`]; with derivatives as [`Variation::resume`], too, and
/// `Grazing`.
pub fn step_map(
    scene: &Scene,
    snapshot: &Snapshot,
    request: &StepRequest,
    outputs: &mut [Outputs],
) -> Result<StepMap, SimulationError> {
    let numbers = PhaseNumbers::of(scene);
    let [at_end, derivatives @ ..] = outputs else {
        return Err(SimulationError::Snapshot("there is no place for outputs".into()));
    };
    if !request.derivatives {
        let mut simulation = Simulation::restore(scene, snapshot)?;
        let phase = numbers.numbers(&simulation.phase());
        simulation.advance_to(request.end)?;
        *at_end = simulation.outputs();
        return Ok(StepMap { phase, next: numbers.numbers(&simulation.phase()), jacobian: vec![] });
    }
    let others = request.by.iter().map(By::seed).collect::<Result<Vec<_>, _>>()?;
    let seeds: Vec<Seed> = numbers.seeds().chain(others).collect();
    let mut variation = Variation::resume(scene, snapshot, &seeds)?;
    let phase = numbers.numbers(&variation.phase());
    variation.advance_to(request.end)?;
    *at_end = with_settings(variation.outputs(), scene.solver.tolerance);
    let next = numbers.numbers(&variation.phase());
    let grazed = |grazing| grazed(scene, grazing);
    let directions = variation.directions().map_err(grazed)?;
    let found = variation.output_derivatives().map_err(grazed)?;
    derivatives.iter_mut().zip(found).for_each(|(place, derivative)| *place = derivative);
    Ok(StepMap { phase, next, jacobian: numbers.rows(&directions) })
}

impl By {
    fn seed(&self) -> Result<Seed, SimulationError> {
        match self {
            Self::Parameter(name) => Parameter::named(name)
                .map(Seed::Parameter)
                .ok_or_else(|| SimulationError::Scene(format!("{name} is not a parameter"))),
            Self::CrankTorque => Ok(Seed::CrankTorque),
            Self::SliderLoad => Ok(Seed::SliderLoad),
        }
    }
}

/// The error of a motion of `scene` whose first order has ended.
pub fn grazed(scene: &Scene, Grazing { time, contact, missed, .. }: Grazing) -> SimulationError {
    let contact = if missed { subject_of_event(scene, contact) } else { subject(contact) };
    SimulationError::Grazing { time, contact }
}
