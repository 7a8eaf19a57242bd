//! An instance, with every function of the standard as a safe method.

use super::error::{Error, InstantiateError};
use super::fmu_state::FmuState;
use super::lifecycle::{Call, State};
use super::resource_location;
use super::status_kind::StatusKind;
use crate::fmi::slave;
use crate::fmi::slave::engine::Engine;
use crate::fmi::slave::error::SavedStateError;
use crate::fmi::slave::log::{Host, Logger};
use crate::fmi::slave::saved_states::{Saved, SavedStates};
use crate::fmi::slave::{Interface, Severity, Slave, ValueType};
use crate::fmi::status::Status;
use crate::scene::slot;
use crate::simulation::SimulationError;
use std::ffi::{CStr, CString};
use std::fmt::Display;

/// `fmi2ModelExchange`
pub const MODEL_EXCHANGE: i32 = 0;
/// `fmi2CoSimulation`
pub const CO_SIMULATION: i32 = 1;

/// Arguments of `fmi2Instantiate`.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Name for the log; it must not be empty.
    pub name: Option<&'a CStr>,
    /// [`MODEL_EXCHANGE`] or [`CO_SIMULATION`]; anything else is refused.
    pub fmu_type: i32,
    /// GUID in the importer's model description.
    pub guid: Option<&'a CStr>,
    /// URI of the resources, which are not used.
    pub resource_location: Option<&'a CStr>,
    /// Whether remarks are logged. Warnings and errors are always logged.
    pub logging_on: bool,
}

/// A slave with its state in the life cycle of FMI 2.0, its saved states and its log.
pub struct Instance {
    state: State,
    slave: Slave,
    last_step: Status,
    /// Whether the last step reached a dead end.
    dead_end: bool,
    saved: SavedStates<FmuState>,
    logger: Logger,
}

impl Instance {
    /// An instance with the packaged start values, whose messages go to `host`. The engine `newer`, if there is one,
    /// computes its motion unless `solver.portable` is set.
    pub fn instantiate(
        request: &Request<'_>,
        host: Box<dyn Host>,
        newer: Option<&'static dyn Engine>,
    ) -> Result<Self, Error> {
        let Request { name, fmu_type, guid, resource_location, logging_on } = *request;
        let name = name.filter(|name| !name.is_empty()).ok_or(InstantiateError::Name)?;
        let interface = match fmu_type {
            MODEL_EXCHANGE => Interface::ModelExchange,
            CO_SIMULATION => Interface::CoSimulation,
            _ => return Err(InstantiateError::Type(fmu_type).into()),
        };
        let (packaged, expected) = slot::read().map_err(InstantiateError::Slot)?;
        if guid.map(CStr::to_bytes) != Some(expected.as_bytes()) {
            let given = guid.map(|guid| guid.to_string_lossy().into_owned());
            return Err(InstantiateError::Guid { expected, given }.into());
        }
        let logger = Logger::new(host, CString::from(name), logging_on);
        let location = resource_location.map(CStr::to_string_lossy).unwrap_or_default();
        if let Some(odd) = resource_location::oddity(&location) {
            logger.remark(Call::Instantiate.name(), &odd);
        }
        Ok(Self {
            state: State::Instantiated,
            slave: Slave::of(interface, packaged, newer)?,
            last_step: Status::Ok,
            dead_end: false,
            saved: SavedStates::default(),
            logger,
        })
    }

    /// State of the life cycle.
    pub fn state(&self) -> State {
        self.state
    }

    /// What moves, and is the same in every version of FMI. For calls that are admitted and whose rules are the slave's.
    pub fn slave(&mut self) -> &mut Slave {
        &mut self.slave
    }

    /// Where its messages go.
    pub fn logger(&self) -> &Logger {
        &self.logger
    }

    /// [s] The communication point reached.
    pub fn time(&self) -> f64 {
        self.slave.time()
    }

    /// Returns an error unless the call is allowed in this state.
    pub fn admit(&self, call: Call) -> Result<(), Error> {
        match (self.state, call.interface()) {
            (State::Fatal, _) if !call.allowed(State::Fatal) => Err(Error::CallOrder(State::Fatal)),
            (_, Some(interface)) if interface != self.slave.interface() => Err(Error::Interface(interface)),
            (state, _) if call.allowed(state) => Ok(()),
            (state, _) => Err(Error::CallOrder(state)),
        }
    }

    /// Ends the run after a failure that the importer did not cause. Saved states can still be restored.
    pub fn fail(&mut self) {
        self.state = State::Error;
    }

    /// Makes the instance unusable after an internal error.
    pub fn give_up(&mut self) {
        self.state = State::Fatal;
    }

    /// `fmi2SetDebugLogging`. Categories that are not declared are ignored, with a warning.
    pub fn set_debug_logging(&mut self, logging_on: bool, categories: &[&CStr]) -> Result<Status, Error> {
        let unknown = self.logger.enable(logging_on, categories);
        Ok(self.warn_of(Call::SetDebugLogging, unknown))
    }

    /// `fmi2SetupExperiment`. A tolerance outside the solver's range is limited, with a warning.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Result<Status, Error> {
        let limit = self.slave.set_up(tolerance, start, stop)?;
        Ok(self.warn_of(Call::SetupExperiment, limit))
    }

    /// The status of a call that succeeded, with a warning if there is one.
    fn warn_of(&self, call: Call, reservation: Option<impl Display>) -> Status {
        match reservation {
            None => Status::Ok,
            Some(reservation) => {
                self.logger.say(Severity::Warning, call.name(), &reservation);
                Status::Warning
            }
        }
    }

    /// `fmi2EnterInitializationMode`
    pub fn enter_initialization_mode(&mut self) -> Result<(), Error> {
        self.state = State::InitializationMode;
        Ok(())
    }

    /// `fmi2ExitInitializationMode`. If the scene contradicts itself, the instance stays in
    /// initialization mode, where the importer may correct it.
    pub fn exit_initialization_mode(&mut self) -> Result<(), Error> {
        self.slave.initialize()?;
        self.state = match self.slave.interface() {
            Interface::CoSimulation => State::StepComplete,
            Interface::ModelExchange => State::EventMode,
        };
        if let Some(left_aside) = self.slave.tolerance_left_aside() {
            self.logger.remark(Call::ExitInitializationMode.name(), &left_aside);
        }
        Ok(())
    }

    /// `fmi2EnterEventMode`
    pub fn enter_event_mode(&mut self) -> Result<(), Error> {
        self.state = State::EventMode;
        Ok(())
    }

    /// `fmi2EnterContinuousTimeMode`
    pub fn enter_continuous_time_mode(&mut self) -> Result<(), Error> {
        self.state = State::ContinuousTimeMode;
        Ok(())
    }

    /// `fmi2Terminate`
    pub fn terminate(&mut self) -> Result<(), Error> {
        self.state = State::Terminated;
        Ok(())
    }

    /// `fmi2Reset`: returns to the state after instantiation. Saved states and the log are kept.
    pub fn reset(&mut self) -> Result<(), Error> {
        self.state = State::Instantiated;
        (self.last_step, self.dead_end) = (Status::Ok, false);
        self.slave.reset();
        Ok(())
    }

    /// `fmi2GetReal`
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        Ok(self.slave.get(ValueType::Real, self.state.reading(), references, values, |value| value)?)
    }

    /// `fmi2GetInteger`, also for enumerations.
    pub fn get_integer(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), Error> {
        Ok(self.slave.get(ValueType::Integer, self.state.reading(), references, values, |value| value as i32)?)
    }

    /// `fmi2GetBoolean`
    pub fn get_boolean(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), Error> {
        Ok(self.slave.get(ValueType::Boolean, self.state.reading(), references, values, |value| value as i32)?)
    }

    /// `fmi2SetReal`
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        Ok(self.slave.set(ValueType::Real, self.state.writing(), references, values, |value| value)?)
    }

    /// `fmi2SetInteger`, also for enumerations.
    pub fn set_integer(&mut self, references: &[u32], values: &[i32]) -> Result<(), Error> {
        Ok(self.slave.set(ValueType::Integer, self.state.writing(), references, values, f64::from)?)
    }

    /// `fmi2SetBoolean`: 0 is false, everything else true.
    pub fn set_boolean(&mut self, references: &[u32], values: &[i32]) -> Result<(), Error> {
        let number = |value| f64::from(u8::from(value != 0));
        Ok(self.slave.set(ValueType::Boolean, self.state.writing(), references, values, number)?)
    }

    /// `fmi2GetString`, `fmi2SetString`: no variable is a string.
    pub fn check_strings(&self, references: &[u32]) -> Result<(), Error> {
        Ok(self.slave.check_strings(references)?)
    }

    /// `fmi2SetRealInputDerivatives`
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Result<(), Error> {
        Ok(self.slave.set_input_derivatives(references, orders, values)?)
    }

    /// `fmi2GetRealOutputDerivatives`
    pub fn get_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Result<(), Error> {
        Ok(self.slave.get_output_derivatives(references, orders, values)?)
    }

    /// `fmi2GetDirectionalDerivative` of real outputs along a direction of real inputs and, in initialization mode, of
    /// real parameters: the standard's knowns there are all variables whose start value is exact. In model exchange of
    /// derivatives of states and along states, too.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        Ok(self.slave.directional_derivative(self.state.writing(), unknowns, knowns, seeds, values)?)
    }

    /// `fmi2DoStep`
    pub fn do_step(&mut self, point: f64, size: f64) -> Result<(), Error> {
        let end = self.slave.step_end(point, size)?;
        let outcome = self.slave.advance_to(end);
        match &outcome {
            Ok(()) => {}
            Err(slave::Error::Simulation(SimulationError::Integration { dead_end, .. })) => {
                (self.state, self.dead_end) = (State::StepFailed, *dead_end);
            }
            Err(_) => self.fail(),
        }
        let outcome = outcome.map_err(Error::from);
        self.last_step = outcome.as_ref().err().map_or(Status::Ok, Status::from);
        outcome
    }

    /// `fmi2GetStatus`
    pub fn step_status(&self, kind: i32) -> Result<Status, Error> {
        match known(kind)? {
            StatusKind::DoStep => Ok(self.last_step),
            other => Err(Error::StatusKind(other)),
        }
    }

    /// `fmi2GetRealStatus`
    pub fn real_status(&self, kind: i32) -> Result<f64, Error> {
        match known(kind)? {
            StatusKind::LastSuccessfulTime => Ok(self.time()),
            other => Err(Error::StatusKind(other)),
        }
    }

    /// `fmi2GetBooleanStatus`: `fmi2Terminated` is true if the run has reached a dead end.
    pub fn boolean_status(&self, kind: i32) -> Result<bool, Error> {
        match known(kind)? {
            StatusKind::Terminated => Ok(self.dead_end),
            other => Err(Error::StatusKind(other)),
        }
    }

    /// `fmi2GetIntegerStatus`, `fmi2GetStringStatus`: the standard has no integer status, and its
    /// only string status is about a step under way, of which there is never one.
    pub fn absent_status<T>(&self, kind: i32) -> Result<T, Error> {
        Err(Error::StatusKind(known(kind)?))
    }

    /// `fmi2GetFMUstate`: saves under `handle`, or under a new handle if that is 0.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Error> {
        let (settings, snapshot) = self.slave.save();
        let state =
            FmuState { state: self.state, settings, last_step: self.last_step, dead_end: self.dead_end, snapshot };
        Ok(self.saved.keep(handle, state)?)
    }

    /// `fmi2SetFMUstate`
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        let FmuState { state, settings, last_step, dead_end, snapshot } = self.saved.get(handle)?;
        self.slave.restore(settings, snapshot.as_ref())?;
        (self.state, self.last_step, self.dead_end) = (*state, *last_step, *dead_end);
        Ok(())
    }

    /// `fmi2FreeFMUstate`; handle 0 means no state.
    pub fn free_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        Ok(self.saved.forget(handle)?)
    }

    /// `fmi2SerializedFMUstateSize`
    pub fn serialized_size(&self, handle: usize) -> Result<usize, Error> {
        Ok(self.saved.serialized_size(handle)?)
    }

    /// `fmi2SerializeFMUstate`. The rest of a longer buffer is filled with 0.
    pub fn serialize(&self, handle: usize, buffer: &mut [u8]) -> Result<(), Error> {
        Ok(self.saved.serialize(handle, buffer)?)
    }

    /// `fmi2DeSerializeFMUstate`: stores under `handle`, or under a new handle if that is 0.
    pub fn deserialize(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Error> {
        let saved = FmuState::from_bytes(bytes)?;
        if saved.state.interface().is_some_and(|interface| interface != self.slave.interface()) {
            return Err(SavedStateError::Interface.into());
        }
        Ok(self.saved.keep(handle, saved)?)
    }
}

fn known(kind: i32) -> Result<StatusKind, Error> {
    StatusKind::of(kind).ok_or(Error::NotAStatusKind(kind))
}
