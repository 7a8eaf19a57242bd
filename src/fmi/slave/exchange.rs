//! Model exchange: the functions of a slave for an importer that integrates. None of them allocates.

use super::Slave;
use super::access::{Permission, check_count, finite, finite_number, finite_output};
use super::course::{Course, Interface};
use super::engine::Engine;
use super::error::{Error, TimeError, VariableError};
use super::states::{can_be_exchanged, check_structure};
use super::variables::{Access, DERIVATIVES, STATES, Variable};
use crate::integrator::{MAX_EVENTS, MAX_STATES};
use crate::scene::Scene;
use crate::simulation::{HostedMechanism, Update};

impl Slave {
    /// A slave of this kind of interface, with the start values of the packaged scene.
    ///
    /// # Errors
    /// As [`Slave::for_exchange`].
    pub fn of(interface: Interface, packaged: Scene, newer: Option<&'static dyn Engine>) -> Result<Self, Error> {
        match interface {
            Interface::CoSimulation => Ok(Self::new(packaged, newer)),
            Interface::ModelExchange => Self::for_exchange(packaged),
        }
    }

    /// A slave with the start values of the packaged scene, whose importer integrates.
    ///
    /// # Errors
    /// If the scene has rigid contacts, which have no equations of motion.
    pub fn for_exchange(packaged: Scene) -> Result<Self, Error> {
        if !can_be_exchanged(&packaged) {
            return Err(VariableError::Structure("solver.method").into());
        }
        Ok(Self { interface: Interface::ModelExchange, ..Self::new(packaged, None) })
    }

    /// The slave's kind of interface.
    pub fn interface(&self) -> Interface {
        self.interface
    }

    /// If the importer integrates: returns an error for a scene whose states differ from those of the packaged scene.
    /// `name` is the parameter that makes the difference.
    pub(super) fn check_structure(&self, scene: &Scene, name: &'static str) -> Result<(), VariableError> {
        match self.interface {
            Interface::CoSimulation => Ok(()),
            Interface::ModelExchange => check_structure(&self.packaged, scene, name),
        }
    }

    /// Sets the importer's time [s]. An integrator's trial step may go past the stop time.
    pub fn set_time(&mut self, time: f64) -> Result<(), Error> {
        if !time.is_finite() {
            return Err(TimeError::NotFinite("time", time).into());
        }
        // A time that lies further from the start than any number tells cannot be counted from there.
        let elapsed = time - self.settings.experiment.start;
        if !elapsed.is_finite() {
            return Err(TimeError::NotFinite("time since the start", elapsed).into());
        }
        self.hosted()?.set_time(elapsed);
        self.outputs = None;
        Ok(())
    }

    /// Number of continuous states.
    pub fn state_count(&mut self) -> Result<usize, Error> {
        Ok(self.hosted()?.states().len())
    }

    /// Number of event indicators.
    pub fn indicator_count(&mut self) -> Result<usize, Error> {
        Ok(self.hosted()?.indicators())
    }

    /// Sets the continuous states.
    pub fn set_states(&mut self, states: &[f64]) -> Result<(), Error> {
        self.check_states(states.len())?;
        for (variable, state) in STATES.iter().zip(states) {
            finite(variable, *state)?;
        }
        self.hosted()?.states_mut().copy_from_slice(states);
        self.outputs = None;
        Ok(())
    }

    /// Number of a state that may be set by its value reference: if the importer integrates, after initialization. The
    /// standard has another function for this, which some importers do not use.
    pub(super) fn settable_state(&self, variable: &Variable, permission: Permission) -> Option<usize> {
        match (&variable.access, &self.course) {
            (Access::State(place), Some(Course::Hosted(mechanism))) if self.initialized && permission.inputs => {
                Some(*place).filter(|place| *place < mechanism.states().len())
            }
            _ => None,
        }
    }

    /// Sets the states that have new values.
    pub(super) fn take_states(&mut self, states: &[Option<f64>; MAX_STATES]) {
        if let Some(Course::Hosted(mechanism)) = &mut self.course {
            for (state, new) in mechanism.states_mut().iter_mut().zip(states) {
                *state = new.unwrap_or(*state);
            }
        }
    }

    /// Writes the continuous states; none if one is not finite, as it may be in a state that was not saved but made up.
    pub fn write_states(&mut self, states: &mut [f64]) -> Result<(), Error> {
        self.check_states(states.len())?;
        let now = self.hosted()?.states();
        for (variable, state) in STATES.iter().zip(now) {
            finite_output(variable, *state)?;
        }
        states.copy_from_slice(now);
        Ok(())
    }

    /// Writes the nominal values of the states.
    pub fn write_nominals(&mut self, nominals: &mut [f64]) -> Result<(), Error> {
        self.check_states(nominals.len())?;
        nominals.copy_from_slice(self.hosted()?.nominals());
        Ok(())
    }

    /// Writes the derivatives of the states; none if one is not finite.
    pub fn write_derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), Error> {
        self.check_states(derivatives.len())?;
        let mut rates = [0.0; MAX_STATES];
        let rates = &mut rates[..derivatives.len()];
        self.hosted()?.write_rates(rates);
        for (variable, rate) in DERIVATIVES.iter().zip(rates.iter()) {
            finite_output(variable, *rate)?;
        }
        derivatives.copy_from_slice(rates);
        Ok(())
    }

    /// Writes the event indicators; none if one is not finite.
    pub fn write_indicators(&mut self, indicators: &mut [f64]) -> Result<(), Error> {
        check_count("event indicators", indicators.len(), self.indicator_count()?)?;
        let mut found = [0.0; MAX_EVENTS];
        let found = &mut found[..indicators.len()];
        self.hosted()?.write_indicators(found);
        found.iter().try_for_each(|indicator| finite_number("an event indicator", *indicator).map(drop))?;
        indicators.copy_from_slice(found);
        Ok(())
    }

    /// Closes and opens contacts.
    pub fn update_discrete_states(&mut self) -> Result<Update, Error> {
        let update = self.hosted()?.update();
        self.outputs = None;
        Ok(update)
    }

    /// Whether [`Slave::update_discrete_states`] would change a contact.
    pub fn update_is_due(&mut self) -> Result<bool, Error> {
        Ok(self.hosted()?.update_is_due())
    }

    fn check_states(&mut self, given: usize) -> Result<(), Error> {
        check_count("continuous states", given, self.state_count()?)
    }

    /// The mechanism that the importer moves.
    fn hosted(&mut self) -> Result<&mut HostedMechanism, Error> {
        match self.live()? {
            Course::Hosted(mechanism) => Ok(mechanism),
            // The life cycle allows no call of model exchange here.
            Course::Own(_) => Err(Error::Interface),
        }
    }
}
