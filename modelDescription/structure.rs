//! ModelStructure: what depends on what. FMI 2.0 numbers variables by their places, FMI 3.0 by their value references.

use super::element::Attributes;
use super::exchange::{Exchange, FIRST_DERIVATIVE, FIRST_STATE};
use super::rows::{Declaration, Kind, Role, Row};

/// How a version of FMI refers to variables.
#[derive(Clone, Copy)]
pub(super) struct Numbering {
    attribute: &'static str,
    rows: usize,
    states: usize,
    derivatives: usize,
    count: usize,
}

impl Numbering {
    /// By places in ModelVariables, from 1: behind the rows of the declaration come the states, and then their
    /// derivatives.
    pub(super) fn by_place(declaration: &Declaration, exchange: Option<&Exchange>) -> Self {
        let (rows, count) = (declaration.rows.len(), states_of(exchange));
        Self { attribute: "index", rows: 1, states: 1 + rows, derivatives: 1 + rows + count, count }
    }

    /// By value references.
    pub(super) fn by_reference(exchange: Option<&Exchange>) -> Self {
        let (states, derivatives) = (FIRST_STATE as usize, FIRST_DERIVATIVE as usize);
        Self { attribute: "valueReference", rows: 0, states, derivatives, count: states_of(exchange) }
    }

    /// A row of the declaration.
    pub(super) fn row(self, row: usize) -> usize {
        self.rows + row
    }

    /// A state.
    pub(super) fn state(self, place: usize) -> usize {
        self.states + place
    }

    /// All states.
    pub(super) fn states(self) -> impl Iterator<Item = usize> {
        (0..self.count).map(move |place| self.state(place))
    }

    /// A state's derivative.
    pub(super) fn derivative(self, place: usize) -> usize {
        self.derivatives + place
    }

    /// An entry: an unknown and what it depends on; without the latter it depends on everything.
    pub(super) fn unknown(self, unknown: usize, dependencies: Option<Vec<usize>>) -> Attributes<'static> {
        let list = |numbers: Vec<usize>| numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        let dependencies = dependencies.map(|numbers| ("dependencies", list(numbers)));
        [(self.attribute, unknown.to_string())].into_iter().chain(dependencies).collect()
    }

    /// Outputs between two events: those that are continuous depend on all states.
    pub(super) fn outputs(self, declaration: &Declaration) -> Vec<Attributes<'static>> {
        let of = |(row, Row { role, kind, .. }): (usize, &Row)| {
            let Role::Output { depends, .. } = role else { return None };
            let states = self.states().filter(|_| matches!(kind, Kind::Real { .. }));
            let knowns = depends.iter().map(|row| self.row(*row)).chain(states);
            Some(self.unknown(self.row(row), Some(knowns.collect())))
        };
        declaration.rows.iter().enumerate().filter_map(of).collect()
    }

    /// Outputs at the start.
    pub(super) fn initial_outputs(self, declaration: &Declaration) -> Vec<Attributes<'static>> {
        let of = |(row, Row { role, .. }): (usize, &Row)| {
            let Role::Output { at_start, .. } = role else { return None };
            let knowns = at_start.as_ref().map(|rows| rows.iter().map(|row| self.row(*row)).collect());
            Some(self.unknown(self.row(row), knowns))
        };
        declaration.rows.iter().enumerate().filter_map(of).collect()
    }
}

fn states_of(exchange: Option<&Exchange>) -> usize {
    exchange.map_or(0, |exchange| exchange.states.len())
}
