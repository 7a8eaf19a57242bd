//! One mechanism under one method.

use super::derivatives::{sensitivity, slopes};
use super::equations::{EquationSystem, Equations, Size, write};
use super::linearization::{Linearization, linearization, rates_at};
use super::motion::Motion;
use super::observation::{observe, solver_outputs};
use super::phase::{Phase, PhaseScales};
use super::record;
use super::settings::settings;
use crate::integrator::methods::named;
use crate::integrator::{Extent, IntegrationError, Integrator, Jacobian, MAX_STATES, Reader, Snapshot, StepPoint};
use crate::model::contact::ContactMode;
use crate::model::drive::InputSignal;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::scales::Scale;
use crate::model::signals::{Inputs, Outputs};
use crate::model::start::StartPose;
use crate::model::state::Contacts;
use crate::scene::Scene;
use std::hint::black_box;

/// A mechanism under a method with event location, or without.
pub struct Run {
    plant: Box<dyn Plant>,
    integrator: Integrator<Contacts>,
    observer: Observer,
    /// [m/s] A noticeable difference of approach speeds.
    approach_scale: f64,
}

impl Run {
    /// Starts `plant` at `time` from `pose`.
    pub fn start(scene: &Scene, time: f64, pose: &StartPose, plant: Box<dyn Plant>) -> Self {
        let settings = settings(scene);
        let n = plant.extent().states;
        let mut y = vec![0.0; n];
        plant.write_start(pose, &mut y);
        let contacts = plant.start_contacts(time, &y);
        let method = named(scene.solver.method.name(), n).expect("every declared method is made");
        let integrator = Integrator::start(plant.as_ref(), method, settings, time, &y, contacts);
        let Scale { length, frequency, .. } = Scale::of(scene);
        Self { plant, integrator, observer: Observer::new(scene), approach_scale: length * frequency }
    }

    /// Outputs under other inputs, the state held.
    fn observe_under(&mut self, t: f64, inputs: Inputs) -> Outputs {
        let signal = *self.plant.signal();
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        self.plant.set_signal(InputSignal { at: t, value: inputs, rate: Inputs::default() });
        let outputs = observe(self.plant.as_ref(), &self.observer, &contacts, t, y);
        self.plant.set_signal(signal);
        outputs
    }
}

impl Motion for Run {
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError> {
        self.integrator.advance(self.plant.as_ref(), t)
    }

    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError> {
        self.integrator.advance_to_event(self.plant.as_ref(), after, t)
    }

    fn phase(&mut self, t: f64) -> Phase {
        self.integrator.truncate(self.plant.as_ref(), t);
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let weighed = self.plant.extent().weighed;
        let approach = contacts.iter().map(|mode| Some(mode.approach).filter(|_| mode.closed)).collect();
        Phase { time: t, states: y[..weighed].to_vec(), approach }
    }

    fn place(&mut self, phase: &Phase) {
        let (y, mut contacts) = self.integrator.state_at(self.plant.as_ref(), phase.time);
        let mut y = y.to_vec();
        write(&phase.states, &mut y);
        for (mode, approach) in contacts.iter_mut().zip(&phase.approach) {
            *mode = approach.map_or(ContactMode::default(), |approach| ContactMode::closing(approach, approach));
        }
        self.integrator.place(self.plant.as_ref(), phase.time, &y, contacts);
    }

    fn phase_scales(&self) -> PhaseScales {
        let weighed = self.plant.extent().weighed;
        PhaseScales { states: self.plant.scales()[..weighed].to_vec(), approach: self.approach_scale }
    }

    fn set_signal(&mut self, signal: InputSignal) {
        if signal.continues(self.plant.signal()) {
            return;
        }
        self.integrator.truncate(self.plant.as_ref(), signal.at);
        self.plant.set_signal(signal);
        self.integrator.refresh(self.plant.as_ref());
    }

    fn outputs(&mut self, t: f64) -> Outputs {
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let mut outputs = observe(self.plant.as_ref(), &self.observer, &contacts, t, y);
        outputs.solver = solver_outputs(self.integrator.state().statistics_at(t));
        outputs
    }

    fn output_rates(&mut self, t: f64) -> Outputs {
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let (mut rates, plant, observer) = ([0.0; MAX_STATES], self.plant.as_ref(), &self.observer);
        let rates = &mut rates[..y.len()];
        plant.rates(&contacts, t, y, rates);
        let mut slopes = slopes(plant, t, y, rates, |t, y| observe(plant, observer, &contacts, t, y));
        observer.set_known_rates(&plant.instant(&contacts, t, y), &mut slopes);
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
        let StepPoint { t, y, discrete, .. } = self.integrator.state().front();
        let mut rates = vec![0.0; y.len()];
        for _ in 0..times {
            self.plant.rates(black_box(discrete), *t, black_box(y), &mut rates);
            black_box(&rates);
        }
    }

    fn equations(self: Box<Self>) -> Box<dyn Equations> {
        let StepPoint { y, discrete, .. } = self.integrator.state().front();
        Box::new(EquationSystem::new(self.plant, self.observer, y.clone(), *discrete))
    }

    fn differentiate(&self, times: usize) {
        let StepPoint { t, y, discrete, .. } = self.integrator.state().front();
        let mut jacobian = Jacobian::new(y.len());
        for _ in 0..times {
            self.plant.jacobian(black_box(discrete), *t, black_box(y), &mut jacobian);
            black_box(&jacobian);
        }
    }

    fn front(&self) -> (f64, Vec<f64>) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        (*t, y.clone())
    }

    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        rates_at(self.plant.as_ref(), &self.integrator.state().front().discrete, time, states)
    }

    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        linearization(self.plant.as_ref(), &self.integrator.state().front().discrete, time, states)
    }

    fn save(&self, snapshot: &mut Snapshot) {
        record::save(self.plant.as_ref(), self.integrator.state(), snapshot);
        self.integrator.method().save(snapshot);
    }

    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()> {
        let state = record::load(self.plant.as_mut(), time, reader)?;
        self.integrator.set_state(self.plant.as_ref(), state);
        self.integrator.load_method(reader)
    }
}
