//! The equations of motion of a scene for an integrator that is not ours: right-hand side, event
//! functions, and what happens at an event.

use super::run::{Motion, observe};
use super::{SimulationError, Size, assemble, start_pose};
use crate::integrator::{EventFunction, EventFunctions, Extent, MAX_EVENTS, MAX_STATES, Triggered};
use crate::model::drive::InputSignal;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::signals::{Inputs, Outputs};
use crate::model::state::Contacts;
use crate::scene::Scene;

/// A scene's equations, with the contacts as they are now.
///
/// States are positions, as many rates of theirs, and what else is integrated, in the order in which
/// our own integrator has them. Contacts change only in [`System::cross`]: between two events the
/// right-hand side is smooth but for friction's and the force law's own kinks.
pub struct System {
    equations: Box<dyn Equations>,
}

impl System {
    /// The equations of `scene` from `time` [s] on, under constant `inputs`.
    ///
    /// # Errors
    /// `Scene` if the start position does not close the loop.
    pub fn start(scene: &Scene, time: f64, inputs: Inputs) -> Result<Self, SimulationError> {
        let signal = InputSignal { at: time, value: inputs, rate: Inputs::default() };
        let motion: Box<dyn Motion> = assemble::start(scene, time, &start_pose(scene)?, signal);
        Ok(Self { equations: motion.equations() })
    }

    /// How many freedoms, states and event functions there are.
    pub fn size(&self) -> Size {
        self.equations.size()
    }

    /// Writes the start state.
    pub fn write_start(&self, y: &mut [f64]) {
        self.equations.write_start(y);
    }

    /// Writes what size of error is just noticeable in each state: our error norm's weights over the
    /// tolerance.
    pub fn write_scales(&self, scales: &mut [f64]) {
        self.equations.write_scales(scales);
    }

    /// [s] No step of ours is longer, so that no event is missed.
    pub fn longest_step(&self) -> f64 {
        self.equations.longest_step()
    }

    /// Writes the rates of the state `y` at `t` [s].
    #[inline]
    pub fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        self.equations.write_rates(t, y, rates);
    }

    /// Writes the event functions: an event happens when one falls through zero.
    #[inline]
    pub fn write_guards(&self, t: f64, y: &[f64], guards: &mut [f64]) {
        self.equations.write_guards(t, y, guards);
    }

    /// Opens or closes the contacts of the event functions in `crossed`, and of all others that are at or
    /// below zero and falling.
    pub fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]) {
        self.equations.cross(t, y, crossed);
    }

    /// Takes the contacts of the start again.
    pub fn restart(&mut self) {
        self.equations.restart();
    }

    /// Outputs of the state `y` at `t` [s] with the contacts as they are now.
    pub fn outputs(&self, t: f64, y: &[f64]) -> Outputs {
        self.equations.outputs(t, y)
    }
}

/// A [`System`], whatever its size.
pub trait Equations: Send {
    /// See [`System::size`].
    fn size(&self) -> Size;
    /// See [`System::write_start`].
    fn write_start(&self, y: &mut [f64]);
    /// See [`System::write_scales`].
    fn write_scales(&self, scales: &mut [f64]);
    /// See [`System::longest_step`].
    fn longest_step(&self) -> f64;
    /// See [`System::write_rates`].
    fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]);
    /// See [`System::write_guards`].
    fn write_guards(&self, t: f64, y: &[f64], guards: &mut [f64]);
    /// See [`System::cross`].
    fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]);
    /// See [`System::restart`].
    fn restart(&mut self);
    /// See [`System::outputs`].
    fn outputs(&self, t: f64, y: &[f64]) -> Outputs;
}

/// A mechanism without an integrator.
pub struct EquationSystem {
    plant: Box<dyn Plant>,
    observer: Observer,
    start: (Vec<f64>, Contacts),
    contacts: Contacts,
}

impl EquationSystem {
    /// From a mechanism and where it starts.
    pub fn new(plant: Box<dyn Plant>, observer: Observer, y: Vec<f64>, contacts: Contacts) -> Self {
        Self { plant, observer, start: (y, contacts), contacts }
    }

    fn states(&self) -> usize {
        self.start.0.len()
    }

    #[inline(always)]
    fn events(&self, t: f64, y: &[f64]) -> EventFunctions {
        let mut functions = [EventFunction::default(); MAX_EVENTS];
        self.plant.event_functions(&self.contacts, t, &y[..self.states()], &mut functions);
        functions
    }
}

/// A state in an array with room: those that are missing count as 0.
#[inline(always)]
fn filled(list: &[f64]) -> [f64; MAX_STATES] {
    let mut all = [0.0; MAX_STATES];
    write(list, &mut all);
    all
}

/// As many of `values` as `list` has room for.
#[inline(always)]
pub fn write(values: &[f64], list: &mut [f64]) {
    for (place, value) in list.iter_mut().zip(values) {
        *place = *value;
    }
}

impl Equations for EquationSystem {
    fn size(&self) -> Size {
        let Extent { positions, states, .. } = self.plant.extent();
        Size { degrees_of_freedom: positions, states, event_functions: self.plant.event_count() }
    }

    fn write_start(&self, y: &mut [f64]) {
        write(&self.start.0, y);
    }

    fn write_scales(&self, scales: &mut [f64]) {
        write(&self.plant.scales()[..self.states()], scales);
    }

    fn longest_step(&self) -> f64 {
        self.plant.longest_step()
    }

    fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        let n = self.states();
        if y.len() == n && rates.len() == n {
            return self.plant.rates(&self.contacts, t, y, rates);
        }
        let mut all = [0.0; MAX_STATES];
        self.plant.rates(&self.contacts, t, &filled(y)[..n], &mut all[..n]);
        write(&all[..n], rates);
    }

    fn write_guards(&self, t: f64, y: &[f64], guards: &mut [f64]) {
        let all = self.events(t, &filled(y));
        for (place, guard) in guards.iter_mut().zip(all).take(self.plant.event_count()) {
            *place = guard.value;
        }
    }

    fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]) {
        let mut state = filled(y);
        let (events, n) = (self.events(t, &state), self.states());
        let mut all: Triggered = [false; MAX_EVENTS];
        for (i, place) in all.iter_mut().enumerate().take(self.plant.event_count()) {
            let EventFunction { value, rate } = events[i];
            *place = crossed.get(i).is_some_and(|crossed| *crossed) || value <= 0.0 && rate < 0.0;
        }
        self.contacts = self.plant.reset(&self.contacts, t, &mut state[..n], &all).discrete;
        write(&state[..n], y);
    }

    fn restart(&mut self) {
        self.contacts = self.start.1;
    }

    fn outputs(&self, t: f64, y: &[f64]) -> Outputs {
        observe(self.plant.as_ref(), &self.observer, &self.contacts, t, &filled(y)[..self.states()])
    }
}
