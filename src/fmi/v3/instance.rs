//! One instance: every FMI call as a safe method.

use super::error::{Error, InstantiateError};
use super::fmu_state::FmuState;
use super::lifecycle::{Call, State};
use super::step::{Done, Ends, Stage, Update};
use super::variables::{check_absent, check_type, has_intermediate_values, time_reference};
use crate::fmi::slave::engine::{Engine, Stops};
use crate::fmi::slave::log::{Host, Logger};
use crate::fmi::slave::saved_states::{Saved, SavedStates};
use crate::fmi::slave::{Severity, Slave, ValueType};
use crate::fmi::status::Status;
use crate::scene::slot;
use crate::simulation::Side;
use std::ffi::{CStr, CString};
use std::fmt::Display;

/// What `fmi3InstantiateCoSimulation` is given.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Name for the log; needed.
    pub name: Option<&'a CStr>,
    /// The token in the XML that the importer read.
    pub token: Option<&'a CStr>,
    /// Whether all log categories are enabled, or no category is. Errors are logged in either case.
    pub logging_on: bool,
    /// Whether the importer handles events.
    pub event_mode_used: bool,
    /// Whether a step may return before its end.
    pub early_return_allowed: bool,
    /// Variables that the importer will touch in intermediate updates.
    pub intermediate: &'a [u32],
    /// Whether the importer has a callback for intermediate updates.
    pub has_callback: bool,
}

/// A slave with its place in the lifecycle of FMI 3.0, its saved states and its log.
pub struct Instance {
    state: State,
    slave: Slave,
    /// The side of an event that is shown.
    side: Side,
    event_mode_used: bool,
    early_return_allowed: bool,
    /// What intermediate updates may touch; absent where there are none.
    intermediate: Option<Vec<u32>>,
    /// Of the step under way.
    ends: Ends,
    saved: SavedStates<FmuState>,
    logger: Logger,
}

impl Instance {
    /// An instance with the packaged start values, whose messages go to `host`. Its motions are computed by `newer`, if
    /// there is such an engine and the scene does not ask for portable bits.
    pub fn instantiate(
        request: &Request<'_>,
        host: Box<dyn Host>,
        newer: Option<&'static dyn Engine>,
    ) -> Result<Self, Error> {
        let Request { name, token, logging_on, event_mode_used, early_return_allowed, intermediate, has_callback } =
            *request;
        let name = name.filter(|name| !name.to_bytes().trim_ascii().is_empty()).ok_or(InstantiateError::Name)?;
        let (packaged, expected) = slot::read().map_err(InstantiateError::Slot)?;
        if token.map(CStr::to_bytes) != Some(expected.as_bytes()) {
            let given = token.map(|token| token.to_string_lossy().into_owned());
            return Err(InstantiateError::Token { expected, given }.into());
        }
        if !has_callback && !intermediate.is_empty() {
            return Err(InstantiateError::NoCallback.into());
        }
        if let Some(&reference) = intermediate.iter().find(|reference| !has_intermediate_values(**reference)) {
            return Err(InstantiateError::Intermediate(reference).into());
        }
        Ok(Self {
            state: State::Instantiated,
            slave: Slave::new(packaged, newer),
            side: Side::After,
            event_mode_used,
            early_return_allowed,
            intermediate: has_callback.then(|| intermediate.to_vec()),
            ends: Ends::default(),
            saved: SavedStates::default(),
            logger: Logger::new(host, CString::from(name), logging_on),
        })
    }

    /// Where it is in its life.
    pub fn state(&self) -> State {
        self.state
    }

    /// Tells the importer what came of a call.
    pub fn say(&self, severity: Severity, call: Call, message: &dyn Display) {
        self.logger.say(severity, call.name(), message);
    }

    /// Lets a call in, if it is allowed in this state.
    pub fn admit(&self, call: Call) -> Result<(), Error> {
        match self.state {
            state if call.allowed(state) => Ok(()),
            State::Fatal => Err(Error::CallOrder(State::Fatal)),
            state => Err(call.not_provided().map_or(Error::CallOrder(state), Error::NotProvided)),
        }
    }

    /// Gives the instance up after a fault of ours.
    pub fn give_up(&mut self) {
        self.state = State::Fatal;
    }

    /// `fmi3SetDebugLogging`
    pub fn set_debug_logging(&mut self, on: bool, categories: &[&CStr]) -> Result<Status, Error> {
        let unknown = self.logger.switch(on, categories);
        Ok(self.warn_of(Call::SetDebugLogging, unknown))
    }

    /// The status of a call that succeeded, with a reservation if there is one.
    fn warn_of(&self, call: Call, reservation: Option<impl Display>) -> Status {
        match reservation {
            None => Status::Ok,
            Some(reservation) => {
                self.say(Severity::Warning, call, &reservation);
                Status::Warning
            }
        }
    }

    /// `fmi3EnterInitializationMode`. A tolerance that the solver cannot meet is limited, with a warning.
    pub fn enter_initialization_mode(
        &mut self,
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    ) -> Result<Status, Error> {
        let limit = self.slave.set_up(tolerance, start, stop)?;
        self.state = State::InitializationMode;
        Ok(self.warn_of(Call::EnterInitializationMode, limit))
    }

    /// `fmi3ExitInitializationMode`. If the scene contradicts itself, the instance stays in initialization mode, where
    /// the importer may correct it.
    pub fn exit_initialization_mode(&mut self) -> Result<(), Error> {
        self.slave.initialize()?;
        self.state = if self.event_mode_used { State::EventMode } else { State::StepMode };
        if let Some(left_aside) = self.slave.tolerance_left_aside() {
            self.logger.remark(Call::ExitInitializationMode.name(), &left_aside);
        }
        Ok(())
    }

    /// `fmi3EnterEventMode`
    pub fn enter_event_mode(&mut self) -> Result<(), Error> {
        if !self.event_mode_used {
            return Err(Error::NoEventMode);
        }
        self.state = State::EventMode;
        Ok(())
    }

    /// `fmi3UpdateDiscreteStates`: from now on the right limits are shown. One update is enough.
    pub fn update_discrete_states(&mut self) -> Result<(), Error> {
        self.look(Side::After)
    }

    /// `fmi3EnterStepMode`
    pub fn enter_step_mode(&mut self) -> Result<(), Error> {
        self.look(Side::After)?;
        self.state = State::StepMode;
        Ok(())
    }

    fn look(&mut self, side: Side) -> Result<(), Error> {
        self.slave.look(side)?;
        self.side = side;
        Ok(())
    }

    /// `fmi3Terminate`
    pub fn terminate(&mut self) -> Result<(), Error> {
        self.state = State::Terminated;
        Ok(())
    }

    /// `fmi3Reset`: as after instantiation, except that saved states stay and the log goes on.
    pub fn reset(&mut self) -> Result<(), Error> {
        self.state = State::Instantiated;
        self.side = Side::After;
        self.slave.reset();
        Ok(())
    }

    /// `fmi3GetFloat64`. The independent variable is read where outputs are.
    pub fn get_float64(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        let time = time_reference();
        if !references.contains(&time) {
            return self.get(ValueType::Real, references, values, |value| value);
        }
        check_type(references, ValueType::Real)?;
        self.check_intermediate(references)?;
        let others: Vec<u32> = references.iter().copied().filter(|reference| *reference != time).collect();
        let mut read = vec![0.0; others.len()];
        self.get(ValueType::Real, &others, &mut read, |value| value)?;
        let (mut read, now) = (read.into_iter(), self.slave.time());
        for (reference, value) in references.iter().zip(values) {
            *value = if *reference == time { now } else { read.next().unwrap_or_default() };
        }
        Ok(())
    }

    /// `fmi3GetInt32`
    pub fn get_int32(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), Error> {
        self.get(ValueType::Integer, references, values, |value| value as i32)
    }

    /// `fmi3GetInt64`: enumerations.
    pub fn get_int64(&mut self, references: &[u32], values: &mut [i64]) -> Result<(), Error> {
        self.get(ValueType::Enumeration, references, values, |value| value as i64)
    }

    /// `fmi3GetBoolean`
    pub fn get_boolean(&mut self, references: &[u32], values: &mut [u8]) -> Result<(), Error> {
        self.get(ValueType::Boolean, references, values, |value| u8::from(value != 0.0))
    }

    /// `fmi3SetFloat64`
    pub fn set_float64(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        self.set(ValueType::Real, references, values, |value| value)
    }

    /// `fmi3SetInt32`
    pub fn set_int32(&mut self, references: &[u32], values: &[i32]) -> Result<(), Error> {
        self.set(ValueType::Integer, references, values, f64::from)
    }

    /// `fmi3SetInt64`: enumerations.
    pub fn set_int64(&mut self, references: &[u32], values: &[i64]) -> Result<(), Error> {
        self.set(ValueType::Enumeration, references, values, |value| value as f64)
    }

    /// `fmi3SetBoolean`: 0 is false, everything else true.
    pub fn set_boolean(&mut self, references: &[u32], values: &[u8]) -> Result<(), Error> {
        self.set(ValueType::Boolean, references, values, |value| f64::from(u8::from(value != 0)))
    }

    /// Getters and setters of types that no variable has.
    pub fn check_absent(&self, references: &[u32], asked: &'static str) -> Result<(), Error> {
        Ok(check_absent(references, asked)?)
    }

    fn get<T>(
        &mut self,
        asked: ValueType,
        references: &[u32],
        values: &mut [T],
        convert: fn(f64) -> T,
    ) -> Result<(), Error> {
        check_type(references, asked)?;
        self.check_intermediate(references)?;
        Ok(self.slave.get(asked, self.state.reading(), references, values, convert)?)
    }

    fn set<T: Copy>(
        &mut self,
        asked: ValueType,
        references: &[u32],
        values: &[T],
        convert: fn(T) -> f64,
    ) -> Result<(), Error> {
        check_type(references, asked)?;
        self.check_intermediate(references)?;
        Ok(self.slave.set(asked, self.state.writing(), references, values, convert)?)
    }

    /// Refuses what an intermediate update may not touch.
    fn check_intermediate(&self, references: &[u32]) -> Result<(), Error> {
        let named = self.intermediate.as_deref().filter(|_| self.state == State::IntermediateUpdateMode);
        let foreign = named.and_then(|named| references.iter().find(|reference| !named.contains(reference)));
        foreign.map_or(Ok(()), |reference| Err(Error::NotIntermediate(*reference)))
    }

    /// `fmi3GetOutputDerivatives`
    pub fn get_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Result<(), Error> {
        self.check_intermediate(references)?;
        Ok(self.slave.get_output_derivatives(references, orders, values)?)
    }

    /// `fmi3GetDirectionalDerivative`
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        Ok(self.slave.directional_derivative(self.state.writing(), unknowns, knowns, seeds, values)?)
    }

    /// `fmi3GetAdjointDerivative`
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        Ok(self.slave.adjoint_derivative(self.state.writing(), unknowns, knowns, seeds, values)?)
    }

    /// `fmi3DoStep`, up to where it begins. [`Instance::go_on`] has to follow.
    pub fn begin_step(&mut self, point: f64, size: f64) -> Result<(), Error> {
        let end = self.slave.step_end(point, size)?;
        self.ends = Ends { asked: end, at: end };
        Ok(())
    }

    /// Goes on with the step under way, up to its end, an event, or the next intermediate update. What cannot go on
    /// terminates the instance.
    pub fn go_on(&mut self) -> Result<Stage, Error> {
        let Ends { asked, at } = self.ends;
        let handles_events = self.event_mode_used && self.early_return_allowed;
        let stops = match handles_events {
            _ if self.intermediate.is_some() => Stops::Steps,
            true => Stops::Events,
            false => Stops::Nowhere,
        };
        let event = self.slave.advance_with(at, stops).map_err(|error| {
            self.state = State::Terminated;
            Error::Step(error)
        })?;
        let (reached, time) = (self.slave.reached(), self.slave.time());
        if event && handles_events {
            self.look(Side::Before)?;
            self.state = State::EventPending;
            return Ok(Stage::Done(Done { event: true, early: reached < asked, time }));
        }
        if reached < at {
            self.state = State::IntermediateUpdateMode;
            return Ok(Stage::Update(Update { time, can_return_early: self.early_return_allowed }));
        }
        Ok(Stage::Done(Done { event: false, early: reached < asked, time }))
    }

    /// Takes the importer's answer to an intermediate update: [s] when to return, if it wants to before the end.
    /// [`Instance::go_on`] has to follow.
    pub fn end_update(&mut self, return_at: Option<f64>) {
        self.state = State::StepMode;
        if let Some(time) = return_at.filter(|_| self.early_return_allowed) {
            // NaN means now.
            self.ends.at = self.slave.counted_from_start(time).max(self.slave.reached()).min(self.ends.at);
        }
    }

    /// `fmi3GetFMUState`: saves under `handle`, or under a new one if that is 0.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Error> {
        let (settings, snapshot) = self.slave.save();
        let before_event = self.side == Side::Before;
        Ok(self.saved.keep(handle, FmuState { state: self.state, before_event, settings, snapshot })?)
    }

    /// `fmi3SetFMUState`
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        let FmuState { state, before_event, settings, snapshot } = self.saved.get(handle)?;
        self.slave.restore(settings, snapshot.as_ref())?;
        self.side = Side::After;
        self.state = *state;
        if *before_event {
            self.look(Side::Before)?;
        }
        Ok(())
    }

    /// `fmi3FreeFMUState`; 0 stands for no state.
    pub fn free_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        Ok(self.saved.forget(handle)?)
    }

    /// `fmi3SerializedFMUStateSize`
    pub fn serialized_size(&self, handle: usize) -> Result<usize, Error> {
        Ok(self.saved.serialized_size(handle)?)
    }

    /// `fmi3SerializeFMUState`. The rest of a longer buffer becomes 0.
    pub fn serialize(&self, handle: usize, buffer: &mut [u8]) -> Result<(), Error> {
        Ok(self.saved.serialize(handle, buffer)?)
    }

    /// `fmi3DeserializeFMUState`: keeps under `handle`, or under a new one if that is 0.
    pub fn deserialize(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Error> {
        Ok(self.saved.keep(handle, FmuState::from_bytes(bytes)?)?)
    }
}
