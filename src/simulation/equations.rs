//! The equations of motion of a mechanism, for an external integrator.

use super::observation::observe;
use crate::integrator::{EventFunction, EventFunctions, MAX_EVENTS, MAX_STATES, StateLayout, Triggered};
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::signals::Outputs;
use crate::model::state::Conditions;

/// Size of the equations of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Number of degrees of freedom; a prescribed crank angle is not one.
    pub degrees_of_freedom: usize,
    /// Number of states: positions, their rates and first-order states.
    pub states: usize,
    /// Number of event functions: one for each joint A, B, C with clearance, and four for a guide with clearance.
    pub event_functions: usize,
}

/// Implementation of a [`System`](super::System).
pub trait Equations: Send {
    /// See [`System::size`](super::System::size).
    fn size(&self) -> Size;
    /// See [`System::write_start`](super::System::write_start).
    fn write_start(&self, y: &mut [f64]);
    /// See [`System::write_scales`](super::System::write_scales).
    fn write_scales(&self, scales: &mut [f64]);
    /// See [`System::longest_step`](super::System::longest_step).
    fn longest_step(&self) -> f64;
    /// See [`System::write_rates`](super::System::write_rates).
    fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]);
    /// See [`System::write_event_functions`](super::System::write_event_functions).
    fn write_event_functions(&self, t: f64, y: &[f64], event_functions: &mut [f64]);
    /// See [`System::cross`](super::System::cross).
    fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]);
    /// See [`System::restart`](super::System::restart).
    fn restart(&mut self);
    /// See [`System::outputs`](super::System::outputs).
    fn outputs(&self, t: f64, y: &[f64]) -> Outputs;
}

/// The equations of motion of a mechanism, with its present contact states.
pub struct EquationSystem {
    model: Box<dyn MechanismModel>,
    observer: Observer,
    start: (Vec<f64>, Conditions),
    conditions: Conditions,
}

impl EquationSystem {
    /// The equations of a mechanism that starts at the state `y` under `conditions`.
    pub fn new(model: Box<dyn MechanismModel>, observer: Observer, y: Vec<f64>, conditions: Conditions) -> Self {
        Self { model, observer, start: (y, conditions), conditions }
    }

    fn states(&self) -> usize {
        self.start.0.len()
    }

    #[inline(always)]
    fn events(&self, t: f64, y: &[f64]) -> EventFunctions {
        let mut functions = [EventFunction::default(); MAX_EVENTS];
        self.model.event_functions(&self.conditions, t, &y[..self.states()], &mut functions);
        functions
    }
}

/// The state `list` in an array padded with zeros.
#[inline(always)]
fn filled(list: &[f64]) -> [f64; MAX_STATES] {
    let mut all = [0.0; MAX_STATES];
    write(list, &mut all);
    all
}

/// Copies `values` into `list`, up to the shorter length.
#[inline(always)]
pub fn write(values: &[f64], list: &mut [f64]) {
    for (place, value) in list.iter_mut().zip(values) {
        *place = *value;
    }
}

impl Equations for EquationSystem {
    fn size(&self) -> Size {
        let StateLayout { positions, states, .. } = self.model.layout();
        Size { degrees_of_freedom: positions, states, event_functions: self.model.event_count() }
    }

    fn write_start(&self, y: &mut [f64]) {
        write(&self.start.0, y);
    }

    fn write_scales(&self, scales: &mut [f64]) {
        write(&self.model.scales()[..self.states()], scales);
    }

    fn longest_step(&self) -> f64 {
        self.model.longest_step()
    }

    fn write_rates(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        let n = self.states();
        if y.len() == n && rates.len() == n {
            return self.model.rates(&self.conditions, t, y, rates);
        }
        let mut all = [0.0; MAX_STATES];
        self.model.rates(&self.conditions, t, &filled(y)[..n], &mut all[..n]);
        write(&all[..n], rates);
    }

    fn write_event_functions(&self, t: f64, y: &[f64], event_functions: &mut [f64]) {
        let all = self.events(t, &filled(y));
        for (place, event_function) in event_functions.iter_mut().zip(all).take(self.model.event_count()) {
            *place = event_function.value;
        }
    }

    fn cross(&mut self, t: f64, y: &mut [f64], crossed: &[bool]) {
        let mut state = filled(y);
        let (events, n) = (self.events(t, &state), self.states());
        let mut all: Triggered = [false; MAX_EVENTS];
        for (i, place) in all.iter_mut().enumerate().take(self.model.event_count()) {
            let EventFunction { value, rate } = events[i];
            *place = crossed.get(i).is_some_and(|crossed| *crossed) || value <= 0.0 && rate < 0.0;
        }
        self.conditions = self.model.reset(&self.conditions, t, &mut state[..n], &all).discrete;
        write(&state[..n], y);
    }

    fn restart(&mut self) {
        self.conditions = self.start.1;
    }

    fn outputs(&self, t: f64, y: &[f64]) -> Outputs {
        observe(self.model.as_ref(), &self.observer, &self.conditions, t, &filled(y)[..self.states()])
    }
}
