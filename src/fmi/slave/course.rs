//! The motion of a slave, computed by its own integrator or by that of the importer.

use super::engine::{Engine, Run};
use super::error::Error;
use super::inputs::InputLines;
use crate::integrator::MAX_STATES;
use crate::model::signals::{Inputs, Outputs};
use crate::scene::Scene;
use crate::simulation::{ContactReport, HostedMechanism, Snapshot};
use serde::{Deserialize, Serialize};

/// Kind of interface between a slave and its importer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interface {
    /// The slave integrates.
    CoSimulation,
    /// The importer integrates.
    ModelExchange,
}

impl Interface {
    /// Why a function of this kind is refused by a slave of the other kind.
    pub fn mismatch(self) -> &'static str {
        match self {
            Self::CoSimulation => "of co-simulation, and this instance is for model exchange",
            Self::ModelExchange => "of model exchange, and this instance is for co-simulation",
        }
    }
}

/// A mechanism in motion.
pub enum Course {
    /// The slave integrates.
    Own(Box<dyn Run>),
    /// The importer integrates.
    Hosted(Box<HostedMechanism>),
}

/// States and their rates.
pub struct StateValues {
    count: usize,
    states: [f64; MAX_STATES],
    rates: [f64; MAX_STATES],
}

impl StateValues {
    /// A state, if there is one with this number.
    pub fn state(&self, place: usize) -> Option<f64> {
        self.states[..self.count].get(place).copied()
    }

    /// Its rate.
    pub fn rate(&self, place: usize) -> Option<f64> {
        self.rates[..self.count].get(place).copied()
    }
}

impl Course {
    /// The scene's mechanism at the start.
    pub fn start(
        interface: Interface,
        engine: &dyn Engine,
        scene: &Scene,
        inputs: &mut InputLines,
    ) -> Result<Self, Error> {
        Ok(match interface {
            Interface::CoSimulation => Self::Own(inputs.start(|inputs| engine.start(scene, inputs))?),
            Interface::ModelExchange => Self::Hosted(Box::new(HostedMechanism::start(scene, inputs.values(0.0))?)),
        })
    }

    /// The mechanism in the state of `snapshot`.
    pub fn restore(
        interface: Interface,
        engine: &dyn Engine,
        scene: &Scene,
        snapshot: &Snapshot,
    ) -> Result<Self, Error> {
        Ok(match interface {
            Interface::CoSimulation => Self::Own(engine.restore(scene, snapshot)?),
            Interface::ModelExchange => Self::Hosted(Box::new(HostedMechanism::restore(scene, snapshot)?)),
        })
    }

    /// Everything that is needed to continue from here.
    pub fn snapshot(&self) -> Snapshot {
        match self {
            Self::Own(simulation) => simulation.snapshot(),
            Self::Hosted(mechanism) => mechanism.snapshot(),
        }
    }

    /// [s] Time since the start.
    pub fn time(&self) -> f64 {
        match self {
            Self::Own(simulation) => simulation.time(),
            Self::Hosted(mechanism) => mechanism.time(),
        }
    }

    /// Sets the inputs at the current time.
    pub fn take(&mut self, inputs: &mut InputLines) {
        match self {
            Self::Own(simulation) => inputs.pass_on(simulation.as_mut()),
            Self::Hosted(mechanism) => mechanism.set_inputs(inputs.values(mechanism.time())),
        }
    }

    /// Outputs.
    pub fn outputs(&mut self) -> Outputs {
        match self {
            Self::Own(simulation) => simulation.outputs(),
            Self::Hosted(mechanism) => mechanism.outputs(),
        }
    }

    /// Time derivatives of outputs.
    pub fn output_rates(&mut self) -> Outputs {
        match self {
            Self::Own(simulation) => simulation.output_rates(),
            Self::Hosted(mechanism) => mechanism.output_rates(),
        }
    }

    /// Derivatives of outputs with respect to the inputs, along `seed`.
    pub fn output_sensitivity(&mut self, seed: Inputs) -> Outputs {
        match self {
            Self::Own(simulation) => simulation.output_sensitivity(seed),
            Self::Hosted(mechanism) => mechanism.output_sensitivity(seed),
        }
    }

    /// The contacts, and which of them change at this instant.
    pub fn contacts(&mut self) -> ContactReport {
        match self {
            Self::Own(simulation) => simulation.contacts(),
            Self::Hosted(mechanism) => mechanism.contacts(),
        }
    }

    /// States and their rates.
    pub fn state_values(&mut self) -> StateValues {
        let mut values = StateValues { count: 0, states: [0.0; MAX_STATES], rates: [0.0; MAX_STATES] };
        match self {
            Self::Own(simulation) => values.count = simulation.write_states(&mut values.states, &mut values.rates),
            Self::Hosted(mechanism) => {
                let states = mechanism.states();
                values.count = states.len();
                values.states[..states.len()].copy_from_slice(states);
                mechanism.write_rates(&mut values.rates[..values.count]);
            }
        }
        values
    }
}
