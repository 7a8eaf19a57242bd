//! Derivatives of inputs and outputs in time, and of outputs with respect to inputs.

use super::super::error::{Error, VariableError};
use super::super::variables::{Access, Variable};
use super::Instance;
use super::values::{finite, variable};
use crate::model::signals::{Inputs, Outputs};

/// Order of the derivatives that we know.
const FIRST: i32 = 1;

fn first(variable: &Variable, order: i32) -> Result<(), VariableError> {
    if order == FIRST { Ok(()) } else { Err(VariableError::Order(variable.name, order)) }
}

/// How a real output is read.
fn real_output(variable: &Variable) -> Result<fn(&Outputs) -> f64, VariableError> {
    match variable.access {
        Access::RealOutput(get) => Ok(get),
        _ => Err(VariableError::Kind(variable.name, "a real output")),
    }
}

/// How a real input is read and written.
struct Reach {
    get: fn(&Inputs) -> f64,
    set: fn(&mut Inputs, f64),
}

fn real_input(variable: &Variable) -> Result<Reach, VariableError> {
    match variable.access {
        Access::Input { get, set, .. } => Ok(Reach { get, set }),
        _ => Err(VariableError::Kind(variable.name, "a real input")),
    }
}

impl Instance {
    /// `fmi2SetRealInputDerivatives`
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Result<(), Error> {
        let (mut inputs, time) = (self.inputs, self.time());
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = variable(reference)?;
            let Reach { set, .. } = real_input(variable)?;
            first(variable, order)?;
            inputs.set_rate(set, time, finite(variable, value)?);
        }
        self.inputs = inputs;
        self.inputs_or_scene_changed();
        Ok(())
    }

    /// `fmi2GetRealOutputDerivatives`
    pub fn get_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Result<(), Error> {
        for (&reference, &order) in references.iter().zip(orders) {
            let variable = variable(reference)?;
            real_output(variable)?;
            first(variable, order)?;
        }
        let rates = self.live()?.output_rates();
        fill(references, &rates, values)
    }

    /// `fmi2GetDirectionalDerivative` of real outputs along a direction of real inputs. An input
    /// named twice counts twice.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seeds: &[f64],
        values: &mut [f64],
    ) -> Result<(), Error> {
        let mut direction = Inputs::default();
        for (&known, &seed) in knowns.iter().zip(seeds) {
            let variable = variable(known)?;
            let Reach { get, set } = real_input(variable)?;
            let sum = get(&direction) + finite(variable, seed)?;
            set(&mut direction, sum);
        }
        for &unknown in unknowns {
            real_output(variable(unknown)?)?;
        }
        let sensitivity = self.live()?.output_sensitivity(direction);
        fill(unknowns, &sensitivity, values)
    }
}

/// Hands out what the outputs of these references have in `source`; infinity, which an input that is far too large may
/// lead to, is refused.
fn fill(references: &[u32], source: &Outputs, values: &mut [f64]) -> Result<(), Error> {
    for (&reference, value) in references.iter().zip(values) {
        let variable = variable(reference)?;
        *value = finite(variable, real_output(variable)?(source))?;
    }
    Ok(())
}
