//! Inputs between communication points: u(t) = u + u̇·(t − t_set), times counted from the start.
//!
//! Value and derivative set at one communication point belong together, in either order. A value
//! set alone is held: its derivative becomes 0. A derivative set alone starts from the value
//! reached. If nothing is set, the line continues, and the simulation is not changed.

use super::engine::Run;
use super::variables::{Access, VARIABLES};
use crate::model::signals::Inputs;
use crate::simulation::SimulationError;
use serde::{Deserialize, Serialize};

/// Every input as a straight line, from a point in time on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Lines {
    values: Inputs,
    rates: Inputs,
}

/// The inputs of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InputLines {
    /// [s] Time at which the current lines have their values.
    since: f64,
    /// The lines that the simulation follows.
    in_force: Lines,
    /// The lines from this communication point on, if an input was set here.
    wanted: Option<Lines>,
    /// Derivatives set at this communication point, 0 for those that were not set.
    rates_set: Inputs,
}

impl Default for InputLines {
    fn default() -> Self {
        let mut in_force = Lines::default();
        for variable in VARIABLES {
            if let Access::Input { start, set, .. } = variable.access {
                set(&mut in_force.values, start);
            }
        }
        Self { since: 0.0, in_force, wanted: None, rates_set: Inputs::default() }
    }
}

impl Lines {
    /// The lines with their values `later` seconds later.
    fn shifted(&self, later: f64) -> Self {
        let Self { values, rates } = *self;
        let values = Inputs {
            crank_torque: reached(values.crank_torque, rates.crank_torque, later),
            slider_load: reached(values.slider_load, rates.slider_load, later),
        };
        Self { values, rates }
    }

    fn are_finite(&self) -> bool {
        are_finite(&self.values) && are_finite(&self.rates)
    }

    fn same_bits(&self, other: &Self) -> bool {
        let bits = |lines: &Self| {
            let Self { values, rates } = lines;
            [values.crank_torque, values.slider_load, rates.crank_torque, rates.slider_load].map(f64::to_bits)
        };
        bits(self) == bits(other)
    }
}

/// Whether both are finite.
pub fn are_finite(inputs: &Inputs) -> bool {
    inputs.crank_torque.is_finite() && inputs.slider_load.is_finite()
}

/// Value of one line. A constant keeps all its bits.
fn reached(value: f64, rate: f64, later: f64) -> f64 {
    if rate == 0.0 { value } else { value + rate * later }
}

impl InputLines {
    /// Sets the value of an input at the communication point `time`.
    pub fn set_value(&mut self, set: fn(&mut Inputs, f64), get: fn(&Inputs) -> f64, time: f64, value: f64) {
        let mut lines = self.at(time);
        set(&mut lines.values, value);
        set(&mut lines.rates, get(&self.rates_set));
        self.wanted = Some(lines);
    }

    /// Sets the first time derivative of an input at the communication point `time`.
    pub fn set_rate(&mut self, set: fn(&mut Inputs, f64), time: f64, rate: f64) {
        let mut lines = self.at(time);
        set(&mut lines.rates, rate);
        set(&mut self.rates_set, rate);
        self.wanted = Some(lines);
    }

    /// Values at the communication point `time`.
    pub fn values(&self, time: f64) -> Inputs {
        self.at(time).values
    }

    /// Values at `later`, when nothing is set after the communication point `time`.
    pub fn values_until(&self, time: f64, later: f64) -> Inputs {
        self.at(time).shifted(later - time).values
    }

    /// Whether all values and derivatives are finite, as all that an importer can set.
    pub fn are_finite(&self) -> bool {
        let Self { since, in_force, wanted, rates_set } = self;
        let lines = [Some(in_force), wanted.as_ref()];
        since.is_finite() && lines.into_iter().flatten().all(Lines::are_finite) && are_finite(rates_set)
    }

    /// Makes a simulation with `start`, with the inputs at its start time.
    pub fn start(
        &mut self,
        start: impl FnOnce(Inputs) -> Result<Box<dyn Run>, SimulationError>,
    ) -> Result<Box<dyn Run>, SimulationError> {
        let lines = self.at(0.0);
        let mut simulation = start(lines.values)?;
        if lines.rates != Inputs::default() {
            simulation.set_inputs(lines.values, lines.rates);
        }
        (self.since, self.in_force) = (0.0, lines);
        Ok(simulation)
    }

    /// Passes inputs that were set at this communication point to the simulation, if they have changed.
    pub fn pass_on(&mut self, simulation: &mut dyn Run) {
        let Some(lines) = self.wanted else { return };
        let time = simulation.time();
        if !lines.same_bits(&self.in_force.shifted(time - self.since)) {
            simulation.set_inputs(lines.values, lines.rates);
            (self.since, self.in_force) = (time, lines);
        }
    }

    /// Ends the communication point: inputs that are set from now on belong to the next one.
    pub fn move_on(&mut self) {
        (self.wanted, self.rates_set) = (None, Inputs::default());
    }

    fn at(&self, time: f64) -> Lines {
        self.wanted.unwrap_or_else(|| self.in_force.shifted(time - self.since))
    }
}
