//! One instance: every FMI call as a safe method.

use super::error::{Error, InstantiateError};
use super::fmu_state::FmuState;
use super::lifecycle::{Call, State};
use super::step::{Done, Ends, IntermediateUpdate, Stage};
use super::variables::{CLOCK, Meaning, TIME, are_neutral, check_type, has_intermediate_values, type_name};
use crate::fmi::slave::access::finite_number;
use crate::fmi::slave::engine::{Engine, Stops};
use crate::fmi::slave::error::{SavedStateError, VariableError};
use crate::fmi::slave::log::{Host, Logger};
use crate::fmi::slave::saved_states::{Saved, SavedStates};
use crate::fmi::slave::{Interface, Severity, Slave, ValueType};
use crate::fmi::status::Status;
use crate::scene::slot;
use crate::simulation::{Side, Update};
use std::ffi::{CStr, CString};
use std::fmt::Display;

/// What `fmi3InstantiateCoSimulation` or `fmi3InstantiateModelExchange` is given.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Which of the two.
    pub interface: Interface,
    /// Name for the log; needed.
    pub name: Option<&'a CStr>,
    /// The token in the XML that the importer read.
    pub token: Option<&'a CStr>,
    /// Whether all log categories are enabled, or no category is. Errors are logged in either case.
    pub logging_on: bool,
    /// What is said of steps, if the instance makes any.
    pub steps: StepRequest<'a>,
}

/// What `fmi3InstantiateCoSimulation` is told of steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepRequest<'a> {
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
    /// Whether the importer's callback runs, whose step comes back to this instance.
    updating: bool,
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
        let Request { interface, name, token, logging_on, steps } = *request;
        let StepRequest { event_mode_used, early_return_allowed, intermediate, has_callback } = steps;
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
            slave: Slave::of(interface, packaged, newer)?,
            side: Side::After,
            event_mode_used,
            early_return_allowed,
            intermediate: has_callback.then(|| intermediate.to_vec()),
            ends: Ends::default(),
            updating: false,
            saved: SavedStates::default(),
            logger: Logger::new(host, CString::from(name), logging_on),
        })
    }

    /// Where it is in its life.
    pub fn state(&self) -> State {
        self.state
    }

    /// What moves, and is the same in every version of FMI. For calls that are admitted and whose rules are the slave's.
    pub fn slave(&mut self) -> &mut Slave {
        &mut self.slave
    }

    /// Tells the importer what came of a call of the function `name`.
    pub fn say(&self, severity: Severity, name: &'static str, message: &dyn Display) {
        self.logger.say(severity, name, message);
    }

    /// Lets a call in, if it is allowed in this state.
    pub fn admit(&self, call: Call) -> Result<(), Error> {
        match (self.state, call.interface()) {
            (State::Fatal, _) if !call.allowed(State::Fatal) => Err(Error::CallOrder(State::Fatal)),
            (_, Some(interface)) if interface != self.slave.interface() => Err(Error::Interface(interface)),
            (state, _) if call.allowed(state) => Ok(()),
            (state, _) => Err(call.not_provided().map_or(Error::CallOrder(state), Error::NotProvided)),
        }
    }

    /// Refuses to free an instance within an intermediate update, even one that was given up there: the step comes back.
    pub fn check_free(&self) -> Result<(), Error> {
        if self.updating { Err(Error::CallOrder(self.state)) } else { Ok(()) }
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
                self.say(Severity::Warning, call.name(), &reservation);
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
        let steps_at_once = self.slave.interface() == Interface::CoSimulation && !self.event_mode_used;
        self.state = if steps_at_once { State::StepMode } else { State::EventMode };
        if let Some(left_aside) = self.slave.tolerance_left_aside() {
            self.logger.remark(Call::ExitInitializationMode.name(), &left_aside);
        }
        Ok(())
    }

    /// `fmi3EnterEventMode`
    pub fn enter_event_mode(&mut self) -> Result<(), Error> {
        if self.slave.interface() == Interface::CoSimulation && !self.event_mode_used {
            return Err(Error::NoEventMode);
        }
        self.state = State::EventMode;
        Ok(())
    }

    /// `fmi3UpdateDiscreteStates`: in model exchange contacts close and open, in co-simulation they have done so and the
    /// right limits are shown from now on. One update is enough.
    pub fn update_discrete_states(&mut self) -> Result<Update, Error> {
        match self.slave.interface() {
            Interface::ModelExchange => Ok(self.slave.update_discrete_states()?),
            Interface::CoSimulation => self.look(Side::After).map(|()| Update::default()),
        }
    }

    /// `fmi3EnterContinuousTimeMode`
    pub fn enter_continuous_time_mode(&mut self) -> Result<(), Error> {
        self.state = State::ContinuousTimeMode;
        Ok(())
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

    /// Number of values that these variables have: more than variables if some are arrays.
    pub fn value_count(&self, references: &[u32]) -> Result<usize, Error> {
        let sizes = references.iter().map(|reference| Meaning::of(*reference).map(|meaning| meaning.size()));
        Ok(sizes.sum::<Result<usize, _>>()?)
    }

    /// `fmi3GetFloat64`
    pub fn get_float64(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        self.get(ValueType::Real, references, values, |value| value)
    }

    /// `fmi3GetClock`: active where its contact closes or opens, until the update that ends the event. The clock of a contact that
    /// parameters have taken away never is.
    pub fn get_clock(&mut self, references: &[u32], values: &mut [u8]) -> Result<(), Error> {
        check_type(references, CLOCK)?;
        let handled = match self.slave.interface() {
            Interface::CoSimulation => self.side == Side::After,
            Interface::ModelExchange => self.state != State::EventMode,
        };
        let contacts: Result<Vec<usize>, VariableError> = references
            .iter()
            .map(|reference| match Meaning::of(*reference)? {
                Meaning::Clock(contact) if self.slave.has_clock(contact) => Ok(contact),
                _ => Err(VariableError::Absent("contact of this clock")),
            })
            .collect();
        let contacts = contacts?;
        let changes = self.slave.contacts()?.changes;
        for (value, contact) in values.iter_mut().zip(contacts) {
            *value = (!handled && changes[contact]).into();
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
        Ok(check_type(references, asked)?)
    }

    fn get<T>(
        &mut self,
        asked: ValueType,
        references: &[u32],
        values: &mut [T],
        convert: fn(f64) -> T,
    ) -> Result<(), Error> {
        check_type(references, type_name(asked))?;
        self.check_intermediate(references)?;
        if are_neutral(references) {
            return Ok(self.slave.get(asked, self.state.reading(), references, values, convert)?);
        }
        let mut read = Vec::with_capacity(values.len());
        for &reference in references {
            self.read(asked, reference, &mut read)?;
        }
        for (value, read) in values.iter_mut().zip(read) {
            *value = convert(read);
        }
        Ok(())
    }

    /// Appends the values of one variable. Event indicators and corners are there whichever side integrates.
    fn read(&mut self, asked: ValueType, reference: u32, read: &mut Vec<f64>) -> Result<(), Error> {
        let meaning = Meaning::of(reference)?;
        let permission = self.state.reading();
        match meaning {
            Meaning::Neutral(_) => {
                let mut value = [0.0];
                self.slave.get(asked, permission, &[reference], &mut value, |value| value)?;
                read.extend(value);
            }
            Meaning::Time => read.push(finite_number(TIME, self.slave.time())?),
            Meaning::Indicator(_) | Meaning::Clock(_) | Meaning::CornerPenetrations | Meaning::CornerContacts => {
                permission.check_output(meaning.name(), "local variable")?;
                match meaning {
                    Meaning::Indicator(place) => read.push(self.slave.indicator(place)?),
                    Meaning::CornerPenetrations => read.extend(self.slave.corners()?.map(|(depth, _)| depth)),
                    _ => read.extend(self.slave.corners()?.map(|(_, touches)| f64::from(u8::from(touches)))),
                }
            }
        }
        Ok(())
    }

    fn set<T: Copy>(
        &mut self,
        asked: ValueType,
        references: &[u32],
        values: &[T],
        convert: fn(T) -> f64,
    ) -> Result<(), Error> {
        check_type(references, type_name(asked))?;
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
        if self.intermediate.is_some() {
            self.slave.begin_interval()?;
        }
        Ok(())
    }

    /// Goes on with the step under way, up to its end, an event, or the next intermediate update. What cannot go on
    /// terminates the instance.
    pub fn go_on(&mut self) -> Result<Stage, Error> {
        if self.state == State::Fatal {
            return Err(Error::CallOrder(State::Fatal));
        }
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
            (self.state, self.updating) = (State::IntermediateUpdateMode, true);
            return Ok(Stage::Update(IntermediateUpdate { time, can_return_early: self.early_return_allowed }));
        }
        Ok(Stage::Done(Done { event: false, early: reached < asked, time }))
    }

    /// Takes the importer's answer to an intermediate update: [s] when to return, if it wants to before the end.
    /// [`Instance::go_on`] has to follow. An instance that was given up in the update stays so.
    pub fn end_update(&mut self, return_at: Option<f64>) {
        self.updating = false;
        if self.state != State::IntermediateUpdateMode {
            return;
        }
        self.state = State::StepMode;
        if let Some(time) = return_at.filter(|_| self.early_return_allowed) {
            // NaN means now.
            self.ends.at = self.slave.counted_from_start(time).max(self.slave.reached()).min(self.ends.at);
        }
    }

    /// `fmi3GetFMUState`: saves under `handle`, or under a new one if that is 0.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Error> {
        let (settings, snapshot) = self.slave.save();
        let (interface, before_event) = (self.slave.interface(), self.side == Side::Before);
        let saved = FmuState { interface, state: self.state, before_event, settings, snapshot };
        Ok(self.saved.keep(handle, saved)?)
    }

    /// `fmi3SetFMUState`
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Error> {
        let FmuState { state, before_event, settings, snapshot, .. } = self.saved.get(handle)?;
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
        let saved = FmuState::from_bytes(bytes)?;
        if saved.interface != self.slave.interface() {
            return Err(SavedStateError::Interface.into());
        }
        let of_events = matches!(saved.state, State::EventMode | State::EventPending);
        if of_events && self.slave.interface() == Interface::CoSimulation && !self.event_mode_used {
            return Err(Error::NoEventMode);
        }
        Ok(self.saved.keep(handle, saved)?)
    }
}
