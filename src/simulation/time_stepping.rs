//! A mechanism with rigid contacts under time stepping.

use super::contacts::{ContactReport, ContactWatch, Instant};
use super::derivatives::{sensitivity, slopes};
use super::equations::{EquationSystem, Equations, Size};
use super::linearization::{Linearization, filled, linearization, rates_at};
use super::motion::Motion;
use super::observation::solver_outputs;
use super::phase::{Phase, PhaseScales};
use super::record::{self, Discrete};
use super::settings::settings;
use super::side::Side;
use crate::integrator::{
    Account, Impulses, IntegrationError, Jacobian, MAX_STATES, Moreau, Reader, Settings, Snapshot, StateLayout,
    StepPoint,
};
use crate::model::drive::InputSignal;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::signals::{Inputs, Outputs};
use crate::model::start::StartPose;
use crate::model::state::{CONTACTS, Conditions, Contacts};
use crate::scene::Scene;
use std::hint::black_box;

/// A mechanism under Moreau's midpoint rule. Contact forces are the impulses of a step over its length, constant in the
/// step; accelerations and reactions are those of the instant under these forces.
pub struct TimeStepping {
    model: Box<dyn MechanismModel>,
    integrator: Moreau<Conditions>,
    settings: Settings,
    observer: Observer,
    watch: ContactWatch,
}

impl TimeStepping {
    /// Starts `model` from `pose` at time 0 under `inputs`.
    pub fn start(scene: &Scene, pose: &StartPose, inputs: InputSignal, model: Box<dyn MechanismModel>) -> Self {
        let settings = settings(scene);
        let mut y = vec![0.0; model.layout().states];
        model.write_start(pose, &mut y);
        let integrator = Moreau::start(settings, 0.0, &y, Conditions::without_contacts(inputs));
        let (observer, watch) = (Observer::new(scene), ContactWatch::new(scene));
        Self { model, integrator, settings, observer, watch }
    }

    /// Outputs at `t` under other inputs, at constant states and contact forces.
    fn observe_under(&mut self, t: f64, inputs: Inputs) -> Outputs {
        let (y, impulses) = self.integrator.state_at(self.model.as_ref(), t);
        let inputs = InputSignal { at: t, value: inputs, rate: Inputs::default() };
        observe(self.model.as_ref(), &self.observer, &impulses, &inputs, t, y)
    }

    fn inputs(&self) -> InputSignal {
        self.integrator.open().inputs
    }
}

fn observe(
    model: &dyn MechanismModel,
    observer: &Observer,
    impulses: &Impulses,
    inputs: &InputSignal,
    t: f64,
    y: &[f64],
) -> Outputs {
    let evaluation = model.evaluation_under(impulses, inputs, t, y);
    let penetration = model.penetration(&evaluation.pose);
    let torque = inputs.at(t).crank_torque;
    observer.outputs(&evaluation, &Conditions::new(contacts_of(impulses), *inputs), &penetration, torque)
}

/// Contacts are closed where an impulse acts.
fn contacts_of(impulses: &Impulses) -> Contacts {
    let mut contacts = Contacts::default();
    for (index, contact) in contacts.iter_mut().enumerate().take(CONTACTS) {
        contact.closed = impulses.acts(index);
    }
    contacts
}

impl Motion for TimeStepping {
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError> {
        self.integrator.advance(self.model.as_ref(), t)
    }

    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError> {
        self.integrator.advance_to_event(self.model.as_ref(), after, t)
    }

    fn phase(&mut self, t: f64) -> Phase {
        self.integrator.truncate(self.model.as_ref(), t);
        let (y, _) = self.integrator.state_at(self.model.as_ref(), t);
        Phase { time: t, states: y.to_vec(), approach: vec![None; CONTACTS] }
    }

    fn place(&mut self, _: f64, phase: &Phase) {
        self.integrator.place(phase.time, &filled(&phase.states, self.model.layout().states));
    }

    fn phase_scales(&self) -> PhaseScales {
        let states = self.model.scales()[..self.model.layout().states].to_vec();
        PhaseScales { states, approach: 1.0 }
    }

    fn set_inputs(&mut self, inputs: InputSignal) {
        if !inputs.continues(&self.inputs()) {
            self.integrator.truncate(self.model.as_ref(), inputs.at);
            self.integrator.set_open(Conditions::without_contacts(inputs));
        }
    }

    fn outputs(&mut self, t: f64, _: Side) -> Outputs {
        let (solver, inputs) =
            (solver_outputs(self.integrator.state().statistics_at(t), &Account::NEW, 0.0), self.inputs());
        let (y, impulses) = self.integrator.state_at(self.model.as_ref(), t);
        Outputs { solver, ..observe(self.model.as_ref(), &self.observer, &impulses, &inputs, t, y) }
    }

    fn output_rates(&mut self, t: f64, _: Side) -> Outputs {
        let inputs = self.inputs();
        let (y, impulses) = self.integrator.state_at(self.model.as_ref(), t);
        let (mut rates, model, observer) = ([0.0; MAX_STATES], self.model.as_ref(), &self.observer);
        let rates = &mut rates[..y.len()];
        model.rates_under(&impulses, &inputs, t, y, rates);
        let mut slopes = slopes(model, t, y, rates, &|t, y| observe(model, observer, &impulses, &inputs, t, y));
        observer.set_known_rates(&model.evaluation_under(&impulses, &inputs, t, y), &mut slopes);
        slopes
    }

    fn output_sensitivity(&mut self, t: f64, seed: Inputs, _: Side) -> Outputs {
        sensitivity(seed, |inputs| self.observe_under(t, inputs))
    }

    fn contacts(&mut self, t: f64, _: Side) -> ContactReport {
        let (solver, inputs) = (self.integrator.state(), self.inputs());
        let after = contacts_of(&solver.front().discrete);
        let before = if t >= solver.front().t { contacts_of(&solver.start().discrete) } else { after };
        let model = self.model.as_ref();
        let (states, impulses) = self.integrator.state_at(model, t);
        let conditions = Conditions::new(contacts_of(&impulses), inputs);
        self.watch.report(&Instant { model, conditions: &conditions, time: t, states }, &before, &after)
    }

    fn write_states(&mut self, t: f64, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize {
        let inputs = self.inputs();
        let (y, impulses) = self.integrator.state_at(self.model.as_ref(), t);
        states[..y.len()].copy_from_slice(y);
        self.model.rates_under(&impulses, &inputs, t, y, &mut rates[..y.len()]);
        y.len()
    }

    fn size(&self) -> Size {
        let StateLayout { positions, states, .. } = self.model.layout();
        Size { degrees_of_freedom: positions, states, event_functions: self.model.event_count() }
    }

    fn evaluate(&self, times: usize) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        let mut rates = vec![0.0; y.len()];
        for _ in 0..times {
            self.model.rates(self.integrator.open(), *t, black_box(y), &mut rates);
            black_box(&rates);
        }
    }

    fn differentiate(&self, times: usize) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        let mut jacobian = Jacobian::new(y.len());
        for _ in 0..times {
            self.model.jacobian(self.integrator.open(), *t, black_box(y), &mut jacobian);
            black_box(&jacobian);
        }
    }

    fn front_time(&self) -> f64 {
        self.integrator.state().front().t
    }

    fn evaluations(&self) -> u64 {
        self.integrator.state().statistics.evaluations
    }

    fn front(&self) -> (f64, Vec<f64>) {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        (*t, y.clone())
    }

    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        rates_at(self.model.as_ref(), self.integrator.open(), time, states)
    }

    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        linearization(self.model.as_ref(), self.integrator.open(), time, states)
    }

    fn equations(self: Box<Self>) -> Box<dyn Equations> {
        let StepPoint { t, y, .. } = self.integrator.state().front();
        let conditions = Conditions { contacts: self.model.start_contacts(*t, y), ..*self.integrator.open() };
        Box::new(EquationSystem::new(self.model, self.observer, y.clone(), conditions))
    }

    fn save(&self, snapshot: &mut Snapshot) {
        self.inputs().save(0, snapshot);
        record::save(self.integrator.state(), snapshot);
    }

    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()> {
        let open = Conditions::without_contacts(InputSignal::load(0, reader)?);
        let state = record::load(self.model.as_ref(), time, reader)?;
        self.integrator = Moreau::resume(self.settings, state, open);
        Some(())
    }
}
