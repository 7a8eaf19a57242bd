//! Directional and adjoint derivatives.
//!
//! The unknowns are real outputs and, in model exchange, derivatives of states; the knowns are real inputs and, in model
//! exchange, states. In initialization mode the knowns are real parameters, too, as the standard has it: all variables
//! whose start value is exact. There the states and their derivatives at the start are unknowns of either kind of
//! interface.

use super::access::{Permission, finite, finite_output, real_parameter, variable};
use super::course::{Course, Interface};
use super::error::{Error, VariableError};
use super::start_sensitivity::{Rate, Wanted, along};
use super::states::StatePlaces;
use super::variables::{Access, Variable};
use super::{Slave, started};
use crate::integrator::MAX_STATES;
use crate::model::signals::{Inputs, Outputs};
use crate::simulation::{Direction, HostedMechanism, nominals};

/// [s] A rate counts as nothing if it takes longer than this to change the state by a nominal value.
const NOTICED_AFTER: f64 = 1e-3;

/// A direction of the knowns.
struct Along {
    /// Of inputs and states.
    present: Direction,
    /// Of start values.
    starts: Vec<Rate>,
}

/// An unknown.
#[derive(Clone, Copy)]
enum Unknown {
    Output(fn(&Outputs) -> f64),
    State(usize),
    Derivative(usize),
}

/// Derivatives along inputs and states.
struct Found {
    outputs: Outputs,
    /// A state's derivative along itself.
    states: Vec<f64>,
    rates: [f64; MAX_STATES],
}

impl Found {
    fn of(&self, unknown: Unknown) -> f64 {
        match unknown {
            Unknown::Output(get) => get(&self.outputs),
            Unknown::State(place) => self.states.get(place).copied().unwrap_or_default(),
            Unknown::Derivative(place) => self.rates[place],
        }
    }
}

impl Slave {
    /// Derivatives of the unknowns along a direction of the knowns. A variable named twice counts twice. In
    /// co-simulation only derivatives by start values allocate.
    pub fn directional_derivative(
        &mut self,
        permission: Permission,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        let Along { present, starts } = self.direction(permission, knowns, seeds)?;
        let found = self.along_present(permission, present, unknowns)?;
        let by_starts = self.along_starts(permission, &starts, unknowns)?;
        let value = |slave: &Self, place: usize| {
            let (variable, unknown) = slave.unknown(permission, unknowns[place])?;
            finite_output(variable, found.of(unknown) + by_starts.get(place).copied().unwrap_or_default())
        };
        // All or none.
        (0..unknowns.len()).try_for_each(|place| value(self, place).map(drop))?;
        for (place, answer) in values.iter_mut().enumerate() {
            *answer = value(self, place)?;
        }
        Ok(())
    }

    /// Σᵢ `seeds`ᵢ·∂unknownᵢ/∂knownⱼ for each known j. There are few knowns, so each is asked for by itself.
    pub fn adjoint_derivative(
        &mut self,
        permission: Permission,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        for (&unknown, &seed) in unknowns.iter().zip(seeds) {
            finite(self.unknown(permission, unknown)?.0, seed)?;
        }
        // A refusal comes before the mechanism is looked at.
        knowns.iter().try_for_each(|known| self.direction(permission, &[*known], &[1.0]).map(drop))?;
        let mut column = vec![0.0; unknowns.len()];
        let mut sums = Vec::with_capacity(knowns.len());
        for &known in knowns {
            self.directional_derivative(permission, unknowns, &[known], &[1.0], &mut column)?;
            let sum = column.iter().zip(seeds).map(|(slope, seed)| slope * seed).sum();
            sums.push(finite_output(variable(known)?, sum)?);
        }
        values.copy_from_slice(&sums);
        Ok(())
    }

    /// The unknown with this value reference.
    fn unknown(&self, permission: Permission, reference: u32) -> Result<(&'static Variable, Unknown), VariableError> {
        let (at_start, exchange) = (permission.parameters, self.interface == Interface::ModelExchange);
        let variable = variable(reference)?;
        let unknown = match variable.access {
            Access::RealOutput(get) => Unknown::Output(get),
            Access::State(place) if at_start => Unknown::State(self.state_places().of(place, variable)?),
            Access::Derivative(place) if at_start || exchange => {
                Unknown::Derivative(self.state_places().of(place, variable)?)
            }
            _ if exchange => {
                let needed = "a real output or a state's derivative, nor a state in initialization mode";
                return Err(VariableError::Kind(variable.name, needed));
            }
            _ => {
                let needed = "a real output, nor a state or its derivative in initialization mode";
                return Err(VariableError::Kind(variable.name, needed));
            }
        };
        Ok((variable, unknown))
    }

    /// The direction that gives these knowns these rates.
    fn direction(&self, permission: Permission, knowns: &[u32], seeds: &[f64]) -> Result<Along, VariableError> {
        let (mut inputs, mut states, mut starts) = (Inputs::default(), vec![], Vec::<Rate>::new());
        let exchange = self.interface == Interface::ModelExchange;
        if exchange {
            states.resize(self.state_places().count(), 0.0);
        }
        for (&known, &seed) in knowns.iter().zip(seeds) {
            let variable = variable(known)?;
            let seed = |variable| finite(variable, seed);
            match (&variable.access, real_parameter(variable)) {
                (Access::Input { get, set, .. }, _) => {
                    let sum = get(&inputs) + seed(variable)?;
                    set(&mut inputs, sum);
                }
                (Access::State(place), _) if exchange => {
                    *states.get_mut(*place).ok_or(VariableError::Absent(variable.name))? += seed(variable)?;
                }
                (_, Some(parameter)) if permission.parameters => {
                    let seed = seed(variable)?;
                    match starts.iter_mut().find(|(known, _)| known.name == parameter.name) {
                        Some((_, rate)) => *rate += seed,
                        None => starts.push((parameter, seed)),
                    }
                }
                _ => {
                    let needed = if exchange {
                        "a real input or a continuous state, nor a real parameter in initialization mode"
                    } else {
                        "a real input, nor a real parameter in initialization mode"
                    };
                    return Err(VariableError::Kind(variable.name, needed));
                }
            }
        }
        Ok(Along { present: Direction { states, inputs }, starts })
    }

    /// Derivatives along inputs and states.
    fn along_present(
        &mut self,
        permission: Permission,
        direction: Direction,
        unknowns: &[u32],
    ) -> Result<Found, Error> {
        let (mut of_outputs, mut of_rates) = (false, false);
        for &reference in unknowns {
            match self.unknown(permission, reference)?.1 {
                Unknown::Output(_) => of_outputs = true,
                Unknown::Derivative(_) => of_rates = true,
                Unknown::State(_) => {}
            }
        }
        let mut rates = [0.0; MAX_STATES];
        let outputs = match self.live()? {
            Course::Hosted(mechanism) => {
                if of_rates {
                    mechanism.write_rates_along(&direction, &mut rates[..direction.states.len()]);
                }
                if of_outputs { mechanism.outputs_along(&direction) } else { Outputs::default() }
            }
            Course::Own(simulation) => {
                let outputs = simulation.output_sensitivity(direction.inputs);
                if of_rates {
                    self.write_start_rates_along(direction.inputs, &mut rates)?;
                }
                outputs
            }
        };
        Ok(Found { outputs, states: direction.states, rates })
    }

    /// Derivatives of the states' derivatives at the start along inputs, in co-simulation: those of the same equations as
    /// another integrator would have them.
    fn write_start_rates_along(&self, inputs: Inputs, rates: &mut [f64; MAX_STATES]) -> Result<(), Error> {
        let (scene, at) = (self.settings.simulated_scene()?, self.settings.inputs.values(0.0));
        let mechanism = HostedMechanism::start(&scene, at)?;
        let states = vec![0.0; mechanism.states().len()];
        let count = states.len();
        mechanism.write_rates_along(&Direction { states, inputs }, &mut rates[..count]);
        Ok(())
    }

    /// Derivatives along start values; none if no start value changes.
    fn along_starts(&self, permission: Permission, starts: &[Rate], unknowns: &[u32]) -> Result<Vec<f64>, Error> {
        if starts.is_empty() {
            return Ok(vec![]);
        }
        let unknowns = unknowns.iter().map(|unknown| self.unknown(permission, *unknown));
        let unknowns = unknowns.collect::<Result<Vec<_>, _>>()?;
        let nominals = nominals(&self.settings.scene);
        let wanted = unknowns.iter().map(|(variable, unknown)| {
            let least = match unknown {
                Unknown::Output(_) => 0.0,
                Unknown::State(place) => nominals[*place],
                Unknown::Derivative(place) => nominals[*place] / NOTICED_AFTER,
            };
            Wanted { name: variable.name, least }
        });
        along(starts, &self.settings, &wanted.collect::<Vec<_>>(), |mut settings| {
            let mut course = started(self.interface, self.newer, &mut settings)?;
            let (outputs, states) = (course.outputs(), course.state_values());
            let of = |unknown: Unknown| match unknown {
                Unknown::Output(get) => get(&outputs),
                Unknown::State(place) => states.state(place).unwrap_or(f64::NAN),
                Unknown::Derivative(place) => states.rate(place).unwrap_or(f64::NAN),
            };
            Ok(unknowns.iter().map(|(_, unknown)| of(*unknown)).collect())
        })
    }

    /// Where each state of the packaged scene is in the present scene. Where the importer integrates, both have the same states.
    pub(super) fn state_places(&self) -> StatePlaces {
        match &self.course {
            Some(Course::Hosted(mechanism)) => StatePlaces::same(mechanism.states().len()),
            _ => StatePlaces::between(&self.packaged, &self.settings.scene),
        }
    }
}
