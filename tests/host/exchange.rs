//! What an importer of model exchange does.

use super::Slave;
use super::api::Api;
use slidercrank::fmi::v2::Status;
use slidercrank::fmi::v2::abi::types::*;

/// A start value that decides which states there are cannot be set in model exchange, so the mechanism is the packaged one:
/// the linked library's is ideal, with the states angle and speed of the crank and one event indicator.
pub const STATES: usize = 2;

impl Slave {
    /// An instance for model exchange, with logging on.
    pub fn exchanging() -> Self {
        Self::of_type(Api::linked(), "slave", FMI2_MODEL_EXCHANGE, true)
    }

    pub fn enter_event_mode(&self) -> Status {
        // SAFETY: live component.
        unsafe { (self.api.EnterEventMode)(self.c) }
    }

    pub fn enter_continuous_time_mode(&self) -> Status {
        // SAFETY: live component.
        unsafe { (self.api.EnterContinuousTimeMode)(self.c) }
    }

    pub fn new_discrete_states(&self) -> fmi2EventInfo {
        self.try_new_discrete_states().map_err(|status| (status, self.log.take())).expect("an update")
    }

    pub fn try_new_discrete_states(&self) -> Result<fmi2EventInfo, Status> {
        let mut info = fmi2EventInfo {
            new_discrete_states_needed: -1,
            terminate_simulation: -1,
            nominals_of_continuous_states_changed: -1,
            values_of_continuous_states_changed: -1,
            next_event_time_defined: -1,
            next_event_time: -1.0,
        };
        // SAFETY: live component, one place.
        let status = unsafe { (self.api.NewDiscreteStates)(self.c, &mut info) };
        if status == Status::Ok { Ok(info) } else { Err(status) }
    }

    /// Whether to enter event mode, and whether to terminate.
    pub fn completed_step(&self) -> [i32; 2] {
        let mut told = [-1; 2];
        let [enter, terminate] = &mut told;
        // SAFETY: live component, places of one entry.
        let status = unsafe { (self.api.CompletedIntegratorStep)(self.c, 1, enter, terminate) };
        assert_eq!(status, Status::Ok, "{:?}", self.log.take());
        told
    }

    pub fn set_time(&self, time: f64) -> Status {
        // SAFETY: live component.
        unsafe { (self.api.SetTime)(self.c, time) }
    }

    pub fn set_states(&self, states: &[f64]) -> Status {
        // SAFETY: live component, array of the length said.
        unsafe { (self.api.SetContinuousStates)(self.c, states.as_ptr(), states.len()) }
    }

    pub fn states(&self, count: usize) -> Vec<f64> {
        self.list(self.api.GetContinuousStates, count)
    }

    pub fn derivatives(&self, count: usize) -> Vec<f64> {
        self.list(self.api.GetDerivatives, count)
    }

    pub fn indicators(&self, count: usize) -> Vec<f64> {
        self.list(self.api.GetEventIndicators, count)
    }

    pub fn nominals(&self, count: usize) -> Vec<f64> {
        self.list(self.api.GetNominalsOfContinuousStates, count)
    }

    fn list(&self, of: unsafe extern "C" fn(fmi2Component, *mut f64, usize) -> Status, count: usize) -> Vec<f64> {
        let mut list = vec![f64::NAN; count];
        // SAFETY: live component, array of the length said.
        let status = unsafe { of(self.c, list.as_mut_ptr(), count) };
        assert_eq!(status, Status::Ok, "{:?}", self.log.take());
        list
    }
}
