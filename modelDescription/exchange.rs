//! What a description says for model exchange: continuous states, their derivatives, event indicators.
//!
//! They are no rows of the declaration, since the scene decides which there are.

use super::element::{Attributes, Xml, leaf, parent};
use super::rows::{Declaration, Role};
use std::io;

/// Value reference of the first state; the others follow. No row of the declaration comes near.
pub const FIRST_STATE: u32 = 10_000;
/// Value reference of the first state's derivative.
pub const FIRST_DERIVATIVE: u32 = 20_000;

/// Model exchange of one scene.
pub struct Exchange {
    /// The continuous states, in order.
    pub states: Vec<State>,
    /// Number of event indicators.
    pub indicators: usize,
}

/// A continuous state.
pub struct State {
    /// Such as `state.crank.angle`.
    pub name: String,
    /// What it is.
    pub description: String,
    /// Its declared type, by name.
    pub of_type: &'static str,
    /// That of its derivative.
    pub rate_type: &'static str,
    /// Its nominal value.
    pub nominal: f64,
    /// Whether it grows for ever, as an angle does.
    pub unbounded: bool,
    /// The states on which its derivative depends.
    pub feels: Vec<usize>,
    /// Whether its derivative depends on the inputs.
    pub feels_inputs: bool,
}

/// Places in ModelVariables, from 1.
#[derive(Clone, Copy)]
pub(super) struct Places {
    rows: usize,
    states: usize,
}

impl Places {
    /// Behind the rows of the declaration come the states, and then their derivatives.
    pub(super) fn of(declaration: &Declaration, exchange: &Exchange) -> Self {
        Self { rows: declaration.rows.len(), states: exchange.states.len() }
    }

    pub(super) fn state(self, state: usize) -> usize {
        self.rows + 1 + state
    }

    fn derivative(self, state: usize) -> usize {
        self.rows + 1 + self.states + state
    }

    pub(super) fn states(self) -> impl Iterator<Item = usize> {
        (0..self.states).map(move |state| self.state(state))
    }
}

/// ModelVariables: states, then derivatives.
pub(super) fn variables(xml: &mut Xml, declaration: &Declaration, exchange: &Exchange) -> io::Result<()> {
    let places = Places::of(declaration, exchange);
    for (reference, state) in (FIRST_STATE..).zip(&exchange.states) {
        let State { name, description, of_type, nominal, unbounded, .. } = state;
        let mut real = typed(declaration, of_type);
        real.push(("nominal", format!("{nominal:?}")));
        real.extend(unbounded.then(|| ("unbounded", "true".into())));
        local(xml, name, reference, description, real)?;
    }
    for ((place, reference), state) in (FIRST_DERIVATIVE..).enumerate().zip(&exchange.states) {
        let State { name, rate_type, .. } = state;
        let mut real = typed(declaration, rate_type);
        real.push(("derivative", places.state(place).to_string()));
        local(xml, &format!("der({name})"), reference, &format!("Derivative of {name}"), real)?;
    }
    Ok(())
}

fn local(xml: &mut Xml, name: &str, reference: u32, description: &str, real: Attributes) -> io::Result<()> {
    let attributes = vec![
        ("name", name.into()),
        ("valueReference", reference.to_string()),
        ("description", description.into()),
        ("causality", "local".into()),
        ("variability", "continuous".into()),
        ("initial", "calculated".into()),
    ];
    parent(xml, "ScalarVariable", attributes, |xml| leaf(xml, "Real", real))
}

/// Declared type and unit.
fn typed<'a>(declaration: &'a Declaration, name: &str) -> Attributes<'a> {
    let mut attributes: Attributes = vec![("declaredType", name.into())];
    if let Some(of) = declaration.types.iter().find(|declared| declared.name == name) {
        attributes.push(("unit", of.unit.clone()));
        attributes.extend(of.display.clone().map(|display| ("displayUnit", display)));
    }
    attributes
}

/// ModelStructure, Derivatives: each with the inputs and states that it depends on.
pub(super) fn derivatives(xml: &mut Xml, declaration: &Declaration, exchange: &Exchange) -> io::Result<()> {
    let places = Places::of(declaration, exchange);
    let rows = declaration.rows.iter().zip(1_usize..);
    let inputs: Vec<usize> =
        rows.filter(|(row, _)| matches!(row.role, Role::Input { .. })).map(|(_, place)| place).collect();
    for (place, state) in exchange.states.iter().enumerate() {
        let inputs = inputs.iter().copied().filter(|_| state.feels_inputs);
        let knowns = inputs.chain(state.feels.iter().map(|state| places.state(*state)));
        let knowns = knowns.map(|known| known.to_string()).collect::<Vec<_>>().join(" ");
        leaf(xml, "Unknown", vec![("index", places.derivative(place).to_string()), ("dependencies", knowns)])?;
    }
    Ok(())
}

/// ModelStructure, InitialUnknowns: states and derivatives, which follow from all inputs and parameters.
pub(super) fn initial_unknowns(xml: &mut Xml, declaration: &Declaration, exchange: &Exchange) -> io::Result<()> {
    let places = Places::of(declaration, exchange);
    let derivatives = (0..exchange.states.len()).map(|state| places.derivative(state));
    for place in places.states().chain(derivatives) {
        leaf(xml, "Unknown", vec![("index", place.to_string())])?;
    }
    Ok(())
}
