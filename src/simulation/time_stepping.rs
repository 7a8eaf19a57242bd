//! One mechanism with rigid contacts under time stepping.

use super::Size;
use super::derivatives::{sensitivity, slopes};
use super::equations::Linearization;
use super::phase::{Phase, PhaseScales};
use super::record;
use super::run::{Motion, filled, linearization, settings, solver_outputs};
use super::snapshot::{Reader, Snapshot};
use super::system::{Bare, Equations, write};
use crate::integrator::{Extent, Front, Impulses, IntegrationError, Jacobian, Moreau, Settings};
use crate::model::drive::InputSignal;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::signals::{Inputs, Outputs};
use crate::model::start::StartPose;
use crate::model::state::{CONTACTS, Contacts};
use crate::scene::Scene;
use std::hint::black_box;

/// A mechanism of `N` states under Moreau's rule. The forces of its contacts are impulses over the length of a step,
/// from its start to its end; accelerations and reactions are those of the instant under these forces.
pub struct TimeStepping<const N: usize> {
    plant: Box<dyn Plant<N>>,
    integrator: Moreau<N>,
    settings: Settings,
    observer: Observer,
}

impl<const N: usize> TimeStepping<N> {
    /// Starts `plant` at `time` from `pose`.
    pub fn start(scene: &Scene, time: f64, pose: &StartPose, plant: Box<dyn Plant<N>>) -> Self {
        let settings = settings(scene);
        let integrator = Moreau::start(settings, time, plant.start(pose));
        Self { plant, integrator, settings, observer: Observer::new(scene) }
    }

    fn observe(&self, impulses: &Impulses<N>, t: f64, y: &[f64; N]) -> Outputs {
        let instant = self.plant.instant_under(impulses, t, y);
        let penetration = self.plant.penetration(&instant.pose);
        let torque = self.plant.signal().at(t).crank_torque;
        let mut contacts = Contacts::default();
        for (index, contact) in contacts.iter_mut().enumerate().take(CONTACTS) {
            contact.closed = impulses.acts(index);
        }
        self.observer.outputs(&instant, &contacts, &penetration, torque)
    }

    /// Outputs under other inputs, state and contact forces held.
    fn observe_under(&mut self, t: f64, inputs: Inputs) -> Outputs {
        let signal = *self.plant.signal();
        let (y, impulses) = self.integrator.state_at(self.plant.as_ref(), t);
        self.plant.set_signal(InputSignal { at: t, value: inputs, rate: Inputs::default() });
        let outputs = self.observe(&impulses, t, &y);
        self.plant.set_signal(signal);
        outputs
    }
}

impl<const N: usize> Motion for TimeStepping<N> {
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError> {
        self.integrator.advance(self.plant.as_ref(), t)
    }

    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError> {
        self.integrator.advance_to_event(self.plant.as_ref(), after, t)
    }

    fn phase(&mut self, t: f64) -> Phase {
        self.integrator.rewind(self.plant.as_ref(), t);
        let (y, _) = self.integrator.state_at(self.plant.as_ref(), t);
        let states = y[..Extent::of(self.plant.as_ref()).states].to_vec();
        Phase { time: t, states, approach: vec![None; CONTACTS] }
    }

    fn place(&mut self, phase: &Phase) {
        let mut y = [0.0; N];
        write(&phase.states, &mut y);
        self.integrator.place(phase.time, y);
    }

    fn phase_scales(&self) -> PhaseScales {
        let states = self.plant.scales()[..Extent::of(self.plant.as_ref()).states].to_vec();
        PhaseScales { states, approach: 1.0 }
    }

    fn set_signal(&mut self, signal: InputSignal) {
        if !signal.continues(self.plant.signal()) {
            self.integrator.rewind(self.plant.as_ref(), signal.at);
            self.plant.set_signal(signal);
        }
    }

    fn outputs(&mut self, t: f64) -> Outputs {
        let (y, impulses) = self.integrator.state_at(self.plant.as_ref(), t);
        let solver = solver_outputs(self.integrator.memory().statistics_at(t));
        Outputs { solver, ..self.observe(&impulses, t, &y) }
    }

    fn output_rates(&mut self, t: f64) -> Outputs {
        let (y, impulses) = self.integrator.state_at(self.plant.as_ref(), t);
        let mut rates = [0.0; N];
        self.plant.rates_under(&impulses, t, &y, &mut rates);
        let mut slopes = slopes(self.plant.as_ref(), t, &y, &rates, |t, y| self.observe(&impulses, t, y));
        self.observer.set_known_rates(&self.plant.instant_under(&impulses, t, &y), &mut slopes);
        slopes
    }

    fn output_sensitivity(&mut self, t: f64, seed: Inputs) -> Outputs {
        sensitivity(seed, |inputs| self.observe_under(t, inputs))
    }

    fn size(&self) -> Size {
        let Extent { positions, states, .. } = Extent::of(self.plant.as_ref());
        Size { degrees_of_freedom: positions, states, event_functions: self.plant.guard_count() }
    }

    fn evaluate(&self, times: usize) {
        let Front { t, y, .. } = &self.integrator.memory().front;
        let mut rates = [0.0; N];
        for _ in 0..times {
            self.plant.rates(&Contacts::default(), *t, black_box(y), &mut rates);
            black_box(&rates);
        }
    }

    fn differentiate(&self, times: usize) {
        let Front { t, y, .. } = &self.integrator.memory().front;
        let mut jacobian = Jacobian::ZERO;
        for _ in 0..times {
            self.plant.jacobian(&Contacts::default(), *t, black_box(y), &mut jacobian);
            black_box(&jacobian);
        }
    }

    fn front(&self) -> (f64, Vec<f64>) {
        let Front { t, y, .. } = &self.integrator.memory().front;
        (*t, y[..Extent::of(self.plant.as_ref()).states].to_vec())
    }

    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        let mut rates = [0.0; N];
        self.plant.rates(&Contacts::default(), time, &filled(states), &mut rates);
        rates[..Extent::of(self.plant.as_ref()).states].to_vec()
    }

    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        linearization(self.plant.as_ref(), &Contacts::default(), time, &filled(states))
    }

    fn equations(self: Box<Self>) -> Box<dyn Equations> {
        let Front { t, y, rates, .. } = self.integrator.memory().front;
        let start = Front { t, y, rates, modes: self.plant.start_contacts(t, &y), impact_end: t };
        Box::new(Bare::new(self.plant, self.observer, start))
    }

    fn save(&self, snapshot: &mut Snapshot) {
        record::save(self.plant.as_ref(), self.integrator.memory(), snapshot);
    }

    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()> {
        let memory = record::load(self.plant.as_mut(), time, reader)?;
        self.integrator = Moreau::resume(self.settings, memory);
        Some(())
    }
}
