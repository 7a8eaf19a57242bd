//! Model exchange: the functions of a slave for an importer that integrates. Only directional derivatives allocate.

use super::Slave;
use super::access::{Permission, finite, finite_output, real_input, real_output, variable};
use super::course::{Course, Interface};
use super::engine::Engine;
use super::error::{Error, TimeError, VariableError};
use super::states::{can_be_exchanged, check_structure};
use super::variables::{Access, DERIVATIVES, STATES, Variable};
use crate::integrator::MAX_STATES;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use crate::simulation::{Direction, HostedMechanism, Update};

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
        let start = self.settings.experiment.start;
        self.hosted()?.set_time(time - start);
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

    /// Writes the continuous states.
    pub fn write_states(&mut self, states: &mut [f64]) -> Result<(), Error> {
        self.check_states(states.len())?;
        states.copy_from_slice(self.hosted()?.states());
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

    /// Writes the event indicators.
    pub fn write_indicators(&mut self, indicators: &mut [f64]) -> Result<(), Error> {
        check_count("event indicators", indicators.len(), self.indicator_count()?)?;
        self.hosted()?.write_indicators(indicators);
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

    /// Derivatives of real outputs and of derivatives of states along a direction of real inputs and states. A variable
    /// named twice counts twice.
    pub fn exchange_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        let states = self.state_count()?;
        let mut direction = Direction { states: vec![0.0; states], inputs: Inputs::default() };
        for (&known, &seed) in knowns.iter().zip(seeds) {
            let variable = variable(known)?;
            finite(variable, seed)?;
            match variable.access {
                Access::State(place) => {
                    *direction.states.get_mut(place).ok_or(VariableError::Absent(variable.name))? += seed
                }
                Access::Input { .. } => {
                    let input = real_input(variable)?;
                    let sum = (input.get)(&direction.inputs) + seed;
                    (input.set)(&mut direction.inputs, sum);
                }
                _ => return Err(VariableError::Kind(variable.name, "a real input or a continuous state").into()),
            }
        }
        let (mut of_outputs, mut of_rates) = (false, false);
        for &unknown in unknowns {
            let variable = variable(unknown)?;
            match variable.access {
                Access::Derivative(place) if place < states => of_rates = true,
                Access::Derivative(_) => return Err(VariableError::Absent(variable.name).into()),
                Access::RealOutput(_) => of_outputs = true,
                _ => return Err(VariableError::Kind(variable.name, "a real output or a state's derivative").into()),
            }
        }
        let mechanism = self.hosted()?;
        let outputs = if of_outputs { mechanism.outputs_along(&direction) } else { Outputs::default() };
        let mut rates = [0.0; MAX_STATES];
        if of_rates {
            mechanism.write_rates_along(&direction, &mut rates[..states]);
        }
        for (&unknown, value) in unknowns.iter().zip(values) {
            let variable = variable(unknown)?;
            *value = finite_output(
                variable,
                match variable.access {
                    Access::Derivative(place) => rates[place],
                    _ => real_output(variable)?(&outputs),
                },
            )?;
        }
        Ok(())
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

fn check_count(of: &'static str, given: usize, needed: usize) -> Result<(), Error> {
    if given == needed { Ok(()) } else { Err(Error::Count { of, given, needed }) }
}
