//! Continuous states of model exchange: their variables, and the parameters that determine their number.

use super::error::VariableError;
use super::variables::{DERIVATIVES, STATES, Variable};
use crate::integrator::MAX_STATES;
use crate::model::coordinates::{Quantity, Role, StateVariable, event_count, state_variables};
use crate::model_description::clocks::Clock;
use crate::model_description::exchange::{Exchange, FIRST_DERIVATIVE, FIRST_STATE, Indicator, State};
use crate::scene::{Method, Scene};
use crate::simulation::step_map::PhaseNumbers;
use crate::simulation::{PINS, contacts, nominals, subject};

const _: () = assert!(STATES.len() == MAX_STATES && DERIVATIVES.len() == MAX_STATES, "a variable for every state");

/// Number of the state whose value or derivative has this value reference, if there is one.
pub fn variable(reference: u32) -> Option<&'static Variable> {
    let of = |list: &'static [Variable], first: u32| {
        reference.checked_sub(first).and_then(|place| list.get(usize::try_from(place).ok()?))
    };
    of(STATES, FIRST_STATE).or_else(|| of(DERIVATIVES, FIRST_DERIVATIVE))
}

/// Whether another integrator can solve the scene's equations. Rigid contacts have no equations of motion.
pub fn can_be_exchanged(scene: &Scene) -> bool {
    scene.solver.method != Method::Moreau
}

/// Contents of the model description for model exchange, if the scene supports it.
pub fn exchange(scene: &Scene) -> Option<Exchange> {
    can_be_exchanged(scene).then(|| {
        let variables = state_variables(scene);
        let states = variables.iter().enumerate().zip(nominals(scene));
        let states = states.map(|((place, variable), nominal)| state(&variables, place, variable, nominal));
        Exchange { states: states.collect(), indicators: indicators(scene) }
    })
}

/// One event indicator for each contact that may close; without contacts, that of the change point.
fn indicators(scene: &Scene) -> Vec<Indicator> {
    let of_contact = |contact: usize| {
        let (name, joint) = contact_name(contact);
        let description = format!("Event indicator: gap of {joint} over its clearance");
        Indicator { name: format!("indicator.{name}"), description }
    };
    let mut indicators: Vec<Indicator> = contacts(scene).into_iter().map(of_contact).collect();
    if indicators.is_empty() {
        let description = "Event indicator: distance to where the rod stands across the guide".to_owned();
        indicators.push(Indicator { name: "indicator.change_point".to_owned(), description });
    }
    indicators
}

/// The clocks of the scene's contacts.
pub fn clocks(scene: &Scene) -> Vec<Clock> {
    let of_contact = |contact: usize| {
        let (name, subject) = contact_name(contact);
        let name = match name.split_once('[') {
            Some((joint, number)) => format!("{joint}.contact_change[{number}"),
            None => format!("{name}.contact_change"),
        };
        Clock { contact, name, description: format!("Active where {subject} closes or opens") }
    };
    contacts(scene).into_iter().map(of_contact).collect()
}

/// Name of a contact, and what it is called in a sentence.
fn contact_name(contact: usize) -> (String, String) {
    let name = match ["A", "B", "C"].get(contact) {
        Some(joint) => format!("joint.{joint}"),
        None => format!("joint.T[{}]", contact + 1 - PINS),
    };
    (name, subject(contact))
}

/// Names of the numbers of a phase: of states as in model exchange, of approach speeds by their contacts.
pub fn phase_names(scene: &Scene) -> Vec<String> {
    let numbers = PhaseNumbers::of(scene);
    let states = state_variables(scene).into_iter().take(numbers.states).map(|state| format!("state.{}", state.name));
    states.chain(numbers.contacts.iter().map(|contact| format!("{}.approach", contact_name(*contact).0))).collect()
}

/// Where each state of the packaged scene is in the present scene; `None` if it is not there.
pub struct StatePlaces(Vec<Option<usize>>);

impl StatePlaces {
    /// The places in `scene` of the states of `packaged`, by their names.
    pub fn between(packaged: &Scene, scene: &Scene) -> Self {
        let present = state_variables(scene);
        let place = |state: StateVariable| present.iter().position(|other| other.name == state.name);
        Self(state_variables(packaged).into_iter().map(place).collect())
    }

    /// The places of `count` states where both scenes have the same.
    pub fn same(count: usize) -> Self {
        Self((0..count).map(Some).collect())
    }

    /// Number of states of the packaged scene.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The place of the packaged scene's state `number`, of which `variable` is the value or the derivative.
    ///
    /// # Errors
    /// `Absent` if the present scene does not have it.
    pub fn of(&self, number: usize, variable: &Variable) -> Result<usize, VariableError> {
        self.0.get(number).copied().flatten().ok_or(VariableError::Absent(variable.name))
    }
}

/// Where an event indicator of the packaged scene is in another scene, by its contact; `None` if it is not there.
pub fn indicator_place(packaged: &Scene, scene: &Scene, place: usize) -> Option<usize> {
    let (declared, present) = (contacts(packaged), contacts(scene));
    if declared.is_empty() {
        return (place == 0 && present.is_empty()).then_some(place);
    }
    let contact = declared.get(place)?;
    present.iter().position(|other| other == contact)
}

/// Refuses a scene whose states or event indicators are not those of the packaged one; `name` is the parameter that made
/// the difference.
pub fn check_structure(packaged: &Scene, scene: &Scene, name: &'static str) -> Result<(), VariableError> {
    let names = |scene| state_variables(scene).into_iter().map(|state| state.name);
    let same = names(packaged).eq(names(scene)) && event_count(packaged) == event_count(scene);
    if same && can_be_exchanged(scene) { Ok(()) } else { Err(VariableError::Structure(name)) }
}

fn state(all: &[StateVariable], place: usize, variable: &StateVariable, nominal: f64) -> State {
    let StateVariable { name, description, quantity, role } = variable;
    let (of_type, rate_type) = match quantity {
        Quantity::Length => ("Length", "Velocity"),
        Quantity::Angle => ("Angle", "RotationalSpeed"),
        Quantity::Velocity => ("Velocity", "Acceleration"),
        Quantity::AngularVelocity => ("RotationalSpeed", "AngularAcceleration"),
        Quantity::Energy => ("Energy", "Power"),
    };
    let places_of = |wanted: fn(Role) -> bool| {
        all.iter().enumerate().filter(move |(_, state)| wanted(state.role)).map(|(place, _)| place)
    };
    let moving = |role: Role| matches!(role, Role::Position(_) | Role::Rate);
    let (feels, feels_inputs) = match *role {
        Role::Position(rate) => (vec![rate], false),
        Role::Rate | Role::Sum => (places_of(|role| role != Role::Sum).collect(), true),
        Role::Bristle => (places_of(moving).chain([place]).collect(), false),
    };
    State {
        name: format!("state.{name}"),
        description: description.clone(),
        of_type,
        rate_type,
        nominal,
        unbounded: *quantity == Quantity::Angle,
        // Bristles of a contact that opens are straight.
        reset: *role == Role::Bristle,
        feels,
        feels_inputs,
    }
}
