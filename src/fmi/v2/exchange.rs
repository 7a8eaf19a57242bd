//! The functions of model exchange as safe methods of an instance.

use super::error::Error;
use super::instance::Instance;
use super::lifecycle::State;
use crate::fmi::abi::ArgumentError;
use crate::simulation::Update;

/// Results of an event: `fmi2EventInfo` without the parts that this FMU never uses. One iteration is enough, nominal
/// values do not change, and no event is known in advance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EventOutcome {
    /// The motion cannot continue.
    pub terminate: bool,
    /// Values of states have changed.
    pub states_changed: bool,
}

/// Results of a completed step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepOutcome {
    /// An event has happened.
    pub enter_event_mode: bool,
}

impl Instance {
    /// `fmi2EnterEventMode`
    pub fn enter_event_mode(&mut self) -> Result<(), Error> {
        self.state = State::EventMode;
        Ok(())
    }

    /// `fmi2NewDiscreteStates`
    pub fn new_discrete_states(&mut self) -> Result<EventOutcome, Error> {
        let Update { states_changed, dead_end } = self.slave.update_discrete_states()?;
        Ok(EventOutcome { terminate: dead_end, states_changed })
    }

    /// `fmi2EnterContinuousTimeMode`
    pub fn enter_continuous_time_mode(&mut self) -> Result<(), Error> {
        self.state = State::ContinuousTimeMode;
        Ok(())
    }

    /// `fmi2CompletedIntegratorStep`. For an importer that monitors the event indicators it brings nothing new.
    pub fn completed_integrator_step(&mut self) -> Result<StepOutcome, Error> {
        Ok(StepOutcome { enter_event_mode: self.slave.update_is_due()? })
    }

    /// `fmi2SetTime`
    pub fn set_time(&mut self, time: f64) -> Result<(), Error> {
        Ok(self.slave.set_time(time)?)
    }

    /// `fmi2SetContinuousStates`
    pub fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), Error> {
        self.check_states("nx", states.len())?;
        Ok(self.slave.set_states(states)?)
    }

    /// `fmi2GetContinuousStates`
    pub fn get_continuous_states(&mut self, states: &mut [f64]) -> Result<(), Error> {
        self.check_states("nx", states.len())?;
        Ok(self.slave.write_states(states)?)
    }

    /// `fmi2GetNominalsOfContinuousStates`
    pub fn get_nominals(&mut self, nominals: &mut [f64]) -> Result<(), Error> {
        self.check_states("nx", nominals.len())?;
        Ok(self.slave.write_nominals(nominals)?)
    }

    /// `fmi2GetDerivatives`
    pub fn get_derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), Error> {
        self.check_states("nx", derivatives.len())?;
        Ok(self.slave.write_derivatives(derivatives)?)
    }

    /// `fmi2GetEventIndicators`
    pub fn get_event_indicators(&mut self, indicators: &mut [f64]) -> Result<(), Error> {
        check_count("ni", indicators.len(), self.slave.indicator_count()?)?;
        Ok(self.slave.write_indicators(indicators)?)
    }

    fn check_states(&mut self, argument: &'static str, given: usize) -> Result<(), Error> {
        check_count(argument, given, self.slave.state_count()?)
    }
}

fn check_count(argument: &'static str, given: usize, expected: usize) -> Result<(), Error> {
    if given == expected { Ok(()) } else { Err(ArgumentError::Count { argument, given, expected }.into()) }
}
