//! What a description says for model exchange: continuous states, their derivatives, event indicators.
//!
//! They are no rows of the declaration, since the scene decides which there are.

use super::element::Attributes;
use super::rows::{Declaration, Role};
use super::structure::Numbering;

/// Value reference of the first state; the others follow. No row of the declaration comes near.
pub const FIRST_STATE: u32 = 10_000;
/// Value reference of the first state's derivative.
pub const FIRST_DERIVATIVE: u32 = 20_000;
/// Value reference of the first event indicator, which is a variable in FMI 3.0.
pub const FIRST_INDICATOR: u32 = 30_000;

/// Model exchange of one scene.
pub struct Exchange {
    /// The continuous states, in order.
    pub states: Vec<State>,
    /// The event indicators, in order.
    pub indicators: Vec<Indicator>,
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
    /// Whether an event may set it.
    pub reset: bool,
    /// The states on which its derivative depends.
    pub feels: Vec<usize>,
    /// Whether its derivative depends on the inputs.
    pub feels_inputs: bool,
}

/// An event indicator.
pub struct Indicator {
    /// Such as `indicator.joint.C`.
    pub name: String,
    /// What it is.
    pub description: String,
}

/// A variable of model exchange, which is local and continuous and follows from others at the start.
pub(super) struct Local {
    /// Its value reference.
    pub reference: u32,
    /// What every variable has.
    pub general: Attributes<'static>,
    /// What a real number has.
    pub real: Attributes<'static>,
}

impl Local {
    fn new(reference: u32, name: &str, description: &str, real: Attributes<'static>) -> Self {
        let general = vec![
            ("name", name.into()),
            ("valueReference", reference.to_string()),
            ("description", description.into()),
            ("causality", "local".into()),
            ("variability", "continuous".into()),
            ("initial", "calculated".into()),
        ];
        Self { reference, general, real }
    }
}

/// States, then derivatives, whose states have these numbers.
pub(super) fn states(declaration: &Declaration, exchange: &Exchange, numbering: Numbering) -> Vec<Local> {
    let states = (FIRST_STATE..).zip(&exchange.states).map(|(reference, state)| {
        let State { name, description, of_type, nominal, unbounded, reset, .. } = state;
        let mut real = typed(declaration, of_type);
        real.push(("nominal", format!("{nominal:?}")));
        real.extend(unbounded.then(|| ("unbounded", "true".into())));
        real.extend(reset.then(|| ("reinit", "true".into())));
        Local::new(reference, name, description, real)
    });
    let derivatives = (FIRST_DERIVATIVE..).zip(exchange.states.iter().enumerate());
    let derivatives = derivatives.map(|(reference, (place, State { name, rate_type, .. }))| {
        let mut real = typed(declaration, rate_type);
        real.push(("derivative", numbering.state(place).to_string()));
        Local::new(reference, &format!("der({name})"), &format!("Derivative of {name}"), real)
    });
    states.chain(derivatives).collect()
}

/// Event indicators.
pub(super) fn indicators(exchange: &Exchange) -> Vec<Local> {
    let indicators = (FIRST_INDICATOR..).zip(&exchange.indicators);
    let of = |(reference, Indicator { name, description }): (u32, &Indicator)| {
        Local::new(reference, name, description, vec![("unit", "1".into())])
    };
    indicators.map(of).collect()
}

/// Declared type and unit.
fn typed(declaration: &Declaration, name: &str) -> Attributes<'static> {
    let mut attributes: Attributes = vec![("declaredType", name.into())];
    if let Some(of) = declaration.types.iter().find(|declared| declared.name == name) {
        attributes.push(("unit", of.unit.clone()));
        attributes.extend(of.display.clone().map(|display| ("displayUnit", display)));
    }
    attributes
}

/// ModelStructure: each derivative with the inputs and states that it depends on.
pub(super) fn derivatives(
    declaration: &Declaration,
    exchange: &Exchange,
    numbering: Numbering,
) -> Vec<Attributes<'static>> {
    let rows = declaration.rows.iter().enumerate();
    let inputs: Vec<usize> =
        rows.filter(|(_, row)| matches!(row.role, Role::Input { .. })).map(|(row, _)| numbering.row(row)).collect();
    let of = |(place, state): (usize, &State)| {
        let inputs = inputs.iter().copied().filter(|_| state.feels_inputs);
        let knowns = inputs.chain(state.feels.iter().map(|state| numbering.state(*state)));
        numbering.unknown(numbering.derivative(place), Some(knowns.collect()))
    };
    exchange.states.iter().enumerate().map(of).collect()
}

/// ModelStructure: states and derivatives at the start, which follow from all inputs and parameters.
pub(super) fn initial_unknowns(exchange: &Exchange, numbering: Numbering) -> Vec<Attributes<'static>> {
    let places = 0..exchange.states.len();
    let derivatives = places.clone().map(|place| numbering.derivative(place));
    places.map(|place| numbering.state(place)).chain(derivatives).map(|at| numbering.unknown(at, None)).collect()
}
