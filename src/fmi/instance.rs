//! One slave: every FMI call as a safe method.
//!
//! The scene is the ground state. Until initialization is over, setting a start value edits it and
//! drops the simulation, which is made anew when an output is asked for; so outputs follow start
//! values in initialization mode. From then on only inputs change.

mod derivatives;
mod states;
mod steps;
mod values;

use super::abi::host_logger::HostLogger;
use super::error::{Error, InstantiateError};
use super::experiment::Experiment;
use super::fmu_state::SavedStates;
use super::inputs::InputLines;
use super::lifecycle::{Call, State};
use super::logger::Logger;
use super::resource_location;
use super::status::Status;
use crate::model::signals::Outputs;
use crate::scene::check::SceneError;
use crate::scene::{Scene, slot};
use crate::simulation::Simulation;
use std::ffi::{CStr, CString};
use std::fmt;

/// What `fmi2Instantiate` is given.
pub struct Request<'a> {
    /// Name for the log; needed.
    pub name: Option<&'a CStr>,
    /// 1 for co-simulation.
    pub fmu_type: i32,
    /// The guid in the XML that the importer read.
    pub guid: Option<&'a CStr>,
    /// URI of the resources, which we do not need.
    pub resource_location: Option<&'a CStr>,
    /// Where messages go.
    pub host: HostLogger,
    /// Whether all log categories are enabled, or none.
    pub logging_on: bool,
}

/// One slave.
pub struct Instance {
    state: State,
    /// The scene that the FMU was packaged with.
    packaged: Scene,
    scene: Scene,
    experiment: Experiment,
    inputs: InputLines,
    /// None until an output is needed; always there once initialization is over.
    simulation: Option<Simulation>,
    /// Outputs at this communication point, once somebody asked.
    outputs: Option<Outputs>,
    last_step: Status,
    saved: SavedStates,
    logger: Logger,
}

impl Instance {
    /// A slave with the packaged start values.
    pub fn instantiate(request: &Request<'_>) -> Result<Self, Error> {
        let Request { name, fmu_type, guid, resource_location, host, logging_on } = *request;
        let name = name.filter(|name| !name.is_empty()).ok_or(InstantiateError::Name)?;
        if fmu_type != super::abi::types::FMI2_CO_SIMULATION {
            return Err(InstantiateError::Type(fmu_type).into());
        }
        let (packaged, expected) = slot::read().map_err(InstantiateError::Slot)?;
        if guid.map(CStr::to_bytes) != Some(expected.as_bytes()) {
            let given = guid.map(|guid| guid.to_string_lossy().into_owned());
            return Err(InstantiateError::Guid { expected, given }.into());
        }
        let logger = Logger::new(host, CString::from(name), logging_on);
        let location = resource_location.map(CStr::to_string_lossy).unwrap_or_default();
        if let Some(odd) = resource_location::oddity(&location) {
            logger.say(Status::Warning, Call::Instantiate, &odd);
        }
        Ok(Self {
            state: State::Instantiated,
            scene: packaged.clone(),
            packaged,
            experiment: Experiment::default(),
            inputs: InputLines::default(),
            simulation: None,
            outputs: None,
            last_step: Status::Ok,
            saved: SavedStates::default(),
            logger,
        })
    }

    /// Where it is in its life.
    pub fn state(&self) -> State {
        self.state
    }

    /// Where its messages go.
    pub fn logger(&self) -> &Logger {
        &self.logger
    }

    /// [s] The communication point reached.
    pub fn time(&self) -> f64 {
        self.simulation.as_ref().map_or(self.experiment.start, Simulation::time)
    }

    /// Lets a call in, if it is allowed in this state.
    pub fn admit(&self, call: Call) -> Result<(), Error> {
        match self.state {
            state if call.allowed(state) => Ok(()),
            State::Fatal => Err(Error::CallOrder(State::Fatal)),
            _ if call.is_model_exchange() => Err(Error::ModelExchange),
            state => Err(Error::CallOrder(state)),
        }
    }

    /// Stops the run after a failure that the importer did not cause; saved states can still be set.
    pub fn fail(&mut self) {
        self.state = State::Error;
    }

    /// Gives the instance up after a fault of ours.
    pub fn give_up(&mut self) {
        self.state = State::Fatal;
    }

    /// `fmi2SetDebugLogging`
    pub fn set_debug_logging(&mut self, logging_on: bool, categories: &[&CStr]) -> Result<(), Error> {
        self.logger.enable(logging_on, categories)
    }

    /// `fmi2SetupExperiment`. A tolerance that the solver cannot meet is limited, with a warning.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Result<Status, Error> {
        let wish = Experiment::new(tolerance, start, stop)?;
        let granted = wish.limited();
        self.experiment = granted;
        if granted == wish {
            return Ok(Status::Ok);
        }
        let limit = Limit { asked: tolerance, granted: granted.tolerance };
        self.logger.say(Status::Warning, Call::SetupExperiment, &limit);
        Ok(Status::Warning)
    }

    /// `fmi2EnterInitializationMode`
    pub fn enter_initialization_mode(&mut self) -> Result<(), Error> {
        self.state = State::InitializationMode;
        Ok(())
    }

    /// `fmi2ExitInitializationMode`. If the scene contradicts itself, the instance stays in
    /// initialization mode, where the importer may correct it.
    pub fn exit_initialization_mode(&mut self) -> Result<(), Error> {
        self.live()?;
        self.state = State::StepComplete;
        Ok(())
    }

    /// `fmi2Terminate`
    pub fn terminate(&mut self) -> Result<(), Error> {
        self.state = State::Terminated;
        Ok(())
    }

    /// `fmi2Reset`: as after instantiation, except that saved states stay and the log goes on.
    pub fn reset(&mut self) -> Result<(), Error> {
        self.state = State::Instantiated;
        self.scene = self.packaged.clone();
        self.experiment = Experiment::default();
        self.inputs = InputLines::default();
        self.last_step = Status::Ok;
        self.forget_simulation();
        Ok(())
    }

    /// The simulation, started if need be, with the inputs of this communication point.
    fn live(&mut self) -> Result<&mut Simulation, Error> {
        match &mut self.simulation {
            Some(simulation) => {
                self.inputs.pass_on(simulation);
                Ok(simulation)
            }
            none => {
                let time = self.experiment.start;
                let scene = asked_for(&self.scene, &self.experiment)?;
                let start = |inputs| Simulation::start(&scene, time, inputs);
                Ok(none.insert(self.inputs.start(time, start)?))
            }
        }
    }

    fn outputs(&mut self) -> Result<&Outputs, Error> {
        if self.outputs.is_none() {
            self.outputs = Some(self.live()?.outputs());
        }
        // There by now; a copy of them for each variable would cost more than making them.
        Ok(self.outputs.get_or_insert_default())
    }

    fn forget_simulation(&mut self) {
        (self.simulation, self.outputs) = (None, None);
    }
}

/// The scene to be simulated, if its parameters go together: the experiment's tolerance comes first.
fn asked_for(scene: &Scene, experiment: &Experiment) -> Result<Scene, SceneError> {
    scene.check()?;
    let mut scene = scene.clone();
    if let Some(tolerance) = experiment.tolerance {
        scene.solver.tolerance = tolerance;
    }
    Ok(scene)
}

/// A tolerance that was not granted.
struct Limit {
    asked: Option<f64>,
    granted: Option<f64>,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [asked, granted] = [self.asked, self.granted].map(Option::unwrap_or_default);
        write!(f, "tolerance {asked:?} is beyond the solver's range; {granted:?} is used")
    }
}
