//! One mechanism with rigid contacts under time stepping.

use super::derivatives::{sensitivity, slopes};
use super::equations::{EquationSystem, Equations, Size};
use super::linearization::{Linearization, filled, linearization, rates_at};
use super::motion::Motion;
use super::observation::solver_outputs;
use super::phase::{Phase, PhaseScales};
use super::record;
use super::settings::settings;
use crate::integrator::{
    Extent, Impulses, IntegrationError, Jacobian, MAX_STATES, Moreau, Reader, Settings, Snapshot, StepPoint,
};
use crate::model::drive::InputSignal;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::signals::{Inputs, Outputs};
use crate::model::start::StartPose;
use crate::model::state::{CONTACTS, Contacts};
use crate::scene::Scene;
use std::hint::black_box;

/// A mechanism under Moreau's rule. The forces of its contacts are impulses over the length of a step,
/// from its start to its end; accelerations and reactions are those of the instant under these forces.
pub struct TimeStepping {
    plant: Box<dyn Plant>,
    integrator: Moreau,
    settings: Settings,
    observer: Observer,
}

impl TimeStepping {
    /// Starts `plant` at `time` from `pose`.
    pub fn start(scene: &Scene, time: f64, pose: &StartPose, plant: Box<dyn Plant>) -> Self {
        let settings = settings(scene);
        let mut y = vec![0.0; plant.extent().states];
        plant.write_start(pose, &mut y);
        let integrator = Moreau::start(settings, time, &y);
        Self { plant, integrator, settings, observer: Observer::new(scene) }
    }

    /// Outputs under other inputs, state and contact forces held.
    fn observe_under(&mut self, t: f64, inputs: Inputs) -> Outputs {
        let signal = *self.plant.signal();
        let (y, impulses) = self.integrator.state_at(self.plant.as_ref(), t);
        self.plant.set_signal(InputSignal { at: t, value: inputs, rate: Inputs::default() });
        let outputs = observe(self.plant.as_ref(), &self.observer, &impulses, t, y);
        self.plant.set_signal(signal);
        outputs
    }
}

fn observe(plant: &dyn Plant, observer: &Observer, impulses: &Impulses, t: f64, y: &[f64]) -> Outputs {
    let instant = plant.instant_under(impulses, t, y);
    let penetration = plant.penetration(&instant.pose);
    let torque = plant.signal().at(t).crank_torque;
    let mut contacts = Contacts::default();
    for (index, contact) in contacts.iter_mut().enumerate().take(CONTACTS) {
        contact.closed = impulses.acts(index);
    }
    observer.outputs(&instant, &contacts, &penetration, torque)
}

impl Motion for TimeStepping {
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError> {
        self.integrator.advance(self.plant.as_ref(), t)
    }

    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError> {
        self.integrator.advance_to_event(self.plant.as_ref(), after, t)
    }

    fn phase(&mut self, t: f64) -> Phase {
        self.integrator.truncate(self.plant.as_ref(), t);
        let (y, _) = self.integrator.state_at(self.plant.as_ref(), t);
        Phase { time: t, states: y.to_vec(), approach: vec![None; CONTACTS] }
    }

    fn place(&mut self, phase: &Phase) {
        self.integrator.place(phase.time, &filled(&phase.states, self.plant.extent().states));
    }

    fn phase_scales(&self) -> PhaseScales {
        let states = self.plant.scales()[..self.plant.extent().states].to_vec();
        PhaseScales { states, approach: 1.0 }
    }

    fn set_signal(&mut self, signal: InputSignal) {
        if !signal.continues(self.plant.signal()) {
            self.integrator.truncate(self.plant.as_ref(), signal.at);
            self.plant.set_signal(signal);
        }
    }

    fn outputs(&mut self, t: f64) -> Outputs {
        let solver = solver_outputs(self.integrator.state().statistics_at(t));
        let (y, impulses) = self.integrator.state_at(self.plant.as_ref(), t);
        Outputs { solver, ..observe(self.plant.as_ref(), &self.observer, &impulses, t, y) }
    }

    fn output_rates(&mut self, t: f64) -> Outputs {
        let (y, impulses) = self.integrator.state_at(self.plant.as_ref(), t);
        let (mut rates, plant, observer) = ([0.0; MAX_STATES], self.plant.as_ref(), &self.observer);
        let rates = &mut rates[..y.len()];
        plant.rates_under(&impulses, t, y, rates);
        let mut slopes = slopes(plant, t, y, rates, |t, y| observe(plant, observer, &impulses, t, y));
        observer.set_known_rates(&plant.instant_under(&impulses, t, y), &mut slopes);
        slopes
    }

    fn output_sensitivity(&mut self, t: f64, seed: Inputs) -> Outputs {
        sensitivity(seed, |inputs| self.observe_under(t, inputs))
    }

    fn size(&self) -> Size {
        let Extent { positions, states, .. } = self.plant.extent();
        Size { degrees_of_freedom: positions, states, event_functions: self.plant.event_count() }
    }

    fn evaluate(&self, times: usize) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        let mut rates = vec![0.0; y.len()];
        for _ in 0..times {
            self.plant.rates(&Contacts::default(), *t, black_box(y), &mut rates);
            black_box(&rates);
        }
    }

    fn differentiate(&self, times: usize) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        let mut jacobian = Jacobian::new(y.len());
        for _ in 0..times {
            self.plant.jacobian(&Contacts::default(), *t, black_box(y), &mut jacobian);
            black_box(&jacobian);
        }
    }

    fn front(&self) -> (f64, Vec<f64>) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        (*t, y.clone())
    }

    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        rates_at(self.plant.as_ref(), &Contacts::default(), time, states)
    }

    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        linearization(self.plant.as_ref(), &Contacts::default(), time, states)
    }

    fn equations(self: Box<Self>) -> Box<dyn Equations> {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        let (y, contacts) = (y.clone(), self.plant.start_contacts(*t, y));
        Box::new(EquationSystem::new(self.plant, self.observer, y, contacts))
    }

    fn save(&self, snapshot: &mut Snapshot) {
        record::save(self.plant.as_ref(), self.integrator.state(), snapshot);
    }

    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()> {
        let state = record::load(self.plant.as_mut(), time, reader)?;
        self.integrator = Moreau::resume(self.settings, state);
        Some(())
    }
}
