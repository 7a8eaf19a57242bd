//! A mechanism under a method other than time stepping.

use super::contacts::{ContactReport, ContactWatch, Instant};
use super::derivatives::{sensitivity, slopes};
use super::equations::{EquationSystem, Equations, Size, write};
use super::interval::{Examined, IntervalAudit};
use super::linearization::{Linearization, linearization, rates_at};
use super::motion::Motion;
use super::observation::{observe, solver_outputs};
use super::phase::{Phase, PhaseScales};
use super::record;
use super::settings::{deadline, settings};
use super::side::Side;
use crate::integrator::methods::named;
use crate::integrator::{IntegrationError, Integrator, Jacobian, MAX_STATES, Reader, Snapshot, StateLayout, StepPoint};
use crate::model::contact::ContactState;
use crate::model::drive::InputSignal;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::scales::Scale;
use crate::model::signals::{Inputs, Outputs};
use crate::model::start::StartPose;
use crate::model::state::Conditions;
use crate::scene::Scene;
use std::hint::black_box;

/// A mechanism under an integrator, with or without event location.
pub struct Run {
    model: Box<dyn MechanismModel>,
    integrator: Integrator<Conditions>,
    observer: Observer,
    watch: ContactWatch,
    /// The audit of intervals, if it is asked for.
    audit: Option<Box<IntervalAudit>>,
    /// [m/s] Scale of approach speeds.
    approach_scale: f64,
    /// Scale of positions over the smallest clearance.
    relative: f64,
}

impl Run {
    /// Starts `model` from `pose` at time 0 under `inputs`.
    pub fn start(scene: &Scene, pose: &StartPose, inputs: InputSignal, model: Box<dyn MechanismModel>) -> Self {
        let settings = settings(scene);
        let n = model.layout().states;
        let mut y = vec![0.0; n];
        model.write_start(pose, &mut y);
        let conditions = Conditions::new(model.start_contacts(0.0, &y), inputs);
        let method = named(scene.solver.method.name(), n).expect("every declared method is implemented");
        let integrator = Integrator::start(model.as_ref(), method, settings, 0.0, &y, conditions);
        let integrator = integrator.with_deadline(deadline(scene));
        let Scale { length, frequency, relative, .. } = Scale::of(scene);
        let (observer, watch) = (Observer::new(scene), ContactWatch::new(scene));
        let audit = IntervalAudit::new(scene).map(Box::new);
        let approach_scale = length * frequency;
        let mut run = Self { model, integrator, observer, watch, audit, approach_scale, relative };
        run.begin_interval(0.0);
        run
    }

    /// The model, what is observed of it, and its integrator.
    pub(super) fn parts(&mut self) -> (&dyn MechanismModel, &Observer, &mut Integrator<Conditions>) {
        (self.model.as_ref(), &self.observer, &mut self.integrator)
    }

    /// As [`Motion::advance`]; `follow` sees each step that was accepted.
    pub(super) fn advance_followed(
        &mut self,
        t: f64,
        follow: &mut dyn FnMut(&dyn MechanismModel, &Integrator<Conditions>),
    ) -> Result<(), IntegrationError> {
        let Self { model, integrator, observer, audit, .. } = self;
        let mut watched = watch(model.as_ref(), observer, audit);
        integrator.advance_watched(model.as_ref(), t, &mut |integrator| {
            watched(integrator);
            follow(model.as_ref(), integrator);
        })
    }

    /// Outputs at `t` under other inputs, at constant states.
    fn observe_under(&mut self, t: f64, inputs: Inputs, side: Side) -> Outputs {
        let (y, conditions) = state_at(&mut self.integrator, self.model.as_ref(), t, side);
        let inputs = InputSignal { at: t, value: inputs, rate: Inputs::default() };
        observe(self.model.as_ref(), &self.observer, &Conditions { inputs, ..conditions }, t, y)
    }
}

/// State and conditions at `t` in the last step, on this side of the events there.
fn state_at<'a>(
    integrator: &'a mut Integrator<Conditions>,
    model: &dyn MechanismModel,
    t: f64,
    side: Side,
) -> (&'a [f64], Conditions) {
    if side == Side::Before && t >= integrator.state().front().t {
        let StepPoint { y, discrete, .. } = integrator.state().end();
        return (y, *discrete);
    }
    integrator.state_at(model, t)
}

/// Shows each accepted step to the audit of intervals, if there is one.
fn watch<'a>(
    model: &'a dyn MechanismModel,
    observer: &'a Observer,
    audit: &'a mut Option<Box<IntervalAudit>>,
) -> impl FnMut(&mut Integrator<Conditions>) + 'a {
    move |integrator| {
        if let Some(audit) = audit {
            audit.step(&mut Examined { model, observer, integrator });
        }
    }
}

impl Motion for Run {
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError> {
        let Self { model, integrator, observer, audit, .. } = self;
        integrator.advance_watched(model.as_ref(), t, &mut watch(model.as_ref(), observer, audit))
    }

    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError> {
        let Self { model, integrator, observer, audit, .. } = self;
        integrator.advance_to_event_watched(model.as_ref(), after, t, &mut watch(model.as_ref(), observer, audit))
    }

    fn begin_interval(&mut self, t: f64) {
        self.integrator.begin_interval();
        self.integrator.for_each_discrete(|conditions| {
            conditions.touches.iter_mut().for_each(|touches| touches.begin_interval(t));
        });
        let Self { model, integrator, observer, audit, .. } = self;
        if let Some(audit) = audit {
            audit.begin(&mut Examined { model: model.as_ref(), observer, integrator }, t);
        }
    }

    fn phase(&mut self, t: f64) -> Phase {
        self.integrator.truncate(self.model.as_ref(), t);
        let (y, conditions) = self.integrator.state_at(self.model.as_ref(), t);
        let weighted = self.model.layout().weighted;
        let approach =
            conditions.contacts.iter().map(|contact| Some(contact.approach).filter(|_| contact.closed)).collect();
        Phase { time: t, states: y[..weighted].to_vec(), approach }
    }

    fn place(&mut self, t: f64, phase: &Phase) {
        // Sums since the start are no part of a phase: they are kept.
        let (y, mut conditions) = self.integrator.state_at(self.model.as_ref(), t);
        let mut y = y.to_vec();
        write(&phase.states, &mut y);
        let model = self.model.as_ref();
        for (place, (contact, approach)) in conditions.contacts.iter_mut().zip(&phase.approach).enumerate() {
            let closing = |approach: &f64| ContactState::closing(*approach, model.speed_floor(place));
            *contact = approach.as_ref().map_or(ContactState::default(), closing);
        }
        let at = Instant { model, conditions: &conditions, time: phase.time, states: &y };
        let due = self.watch.due(&at);
        if due.contains(&true) {
            conditions = model.reset(&conditions, phase.time, &mut y, &due).discrete;
        }
        self.integrator.place(model, phase.time, &y, conditions);
    }

    fn phase_scales(&self) -> PhaseScales {
        let weighted = self.model.layout().weighted;
        PhaseScales { states: self.model.scales()[..weighted].to_vec(), approach: self.approach_scale }
    }

    fn set_inputs(&mut self, inputs: InputSignal) {
        if inputs.continues(&self.integrator.state().front().discrete.inputs) {
            return;
        }
        self.integrator.truncate(self.model.as_ref(), inputs.at);
        let conditions = self.integrator.state().front().discrete;
        self.integrator.set_discrete(self.model.as_ref(), Conditions { inputs, ..conditions });
    }

    fn outputs(&mut self, t: f64, side: Side) -> Outputs {
        let (y, conditions) = state_at(&mut self.integrator, self.model.as_ref(), t, side);
        let mut outputs = observe(self.model.as_ref(), &self.observer, &conditions, t, y);
        // An instant earlier, the events at the end of the step do not count yet.
        let counted = if side == Side::Before { t.next_down() } else { t };
        let solver = self.integrator.state();
        outputs.solver = solver_outputs(solver.statistics_at(counted), &solver.account, self.relative);
        let Self { model, integrator, observer, audit, .. } = self;
        if let Some(audit) = audit {
            audit.set_outputs(&mut Examined { model: model.as_ref(), observer, integrator }, t, &mut outputs);
        }
        outputs
    }

    fn output_rates(&mut self, t: f64, side: Side) -> Outputs {
        let (y, conditions) = state_at(&mut self.integrator, self.model.as_ref(), t, side);
        let (mut rates, model, observer) = ([0.0; MAX_STATES], self.model.as_ref(), &self.observer);
        let rates = &mut rates[..y.len()];
        model.rates(&conditions, t, y, rates);
        let mut slopes = slopes(model, t, y, rates, &|t, y| observe(model, observer, &conditions, t, y));
        let evaluation = model.evaluation(&conditions, t, y);
        observer.set_known_rates(&evaluation, &mut slopes);
        if let Some(audit) = &self.audit {
            audit.set_rates(model.rubbing(&conditions.contacts, &evaluation.pose, y), &mut slopes);
        }
        slopes
    }

    fn output_sensitivity(&mut self, t: f64, seed: Inputs, side: Side) -> Outputs {
        sensitivity(seed, |inputs| self.observe_under(t, inputs, side))
    }

    fn contacts(&mut self, t: f64, side: Side) -> ContactReport {
        let solver = self.integrator.state();
        // Within the step nothing has changed since its start.
        let after = solver.front().discrete.contacts;
        let before = if t >= solver.front().t { solver.end().discrete.contacts } else { after };
        let model = self.model.as_ref();
        let (states, conditions) = state_at(&mut self.integrator, model, t, side);
        self.watch.report(&Instant { model, conditions: &conditions, time: t, states }, &before, &after)
    }

    fn write_states(&mut self, t: f64, states: &mut [f64; MAX_STATES], rates: &mut [f64; MAX_STATES]) -> usize {
        let (y, conditions) = self.integrator.state_at(self.model.as_ref(), t);
        states[..y.len()].copy_from_slice(y);
        self.model.rates(&conditions, t, y, &mut rates[..y.len()]);
        y.len()
    }

    fn size(&self) -> Size {
        let StateLayout { positions, states, .. } = self.model.layout();
        Size { degrees_of_freedom: positions, states, event_functions: self.model.event_count() }
    }

    fn evaluate(&self, times: usize) {
        let StepPoint { t, y, discrete, .. } = self.integrator.state().front();
        let mut rates = vec![0.0; y.len()];
        for _ in 0..times {
            self.model.rates(black_box(discrete), *t, black_box(y), &mut rates);
            black_box(&rates);
        }
    }

    fn equations(self: Box<Self>) -> Box<dyn Equations> {
        let StepPoint { y, discrete, .. } = self.integrator.state().front();
        Box::new(EquationSystem::new(self.model, self.observer, y.clone(), *discrete))
    }

    fn differentiate(&self, times: usize) {
        let StepPoint { t, y, discrete, .. } = self.integrator.state().front();
        let mut jacobian = Jacobian::new(y.len());
        for _ in 0..times {
            self.model.jacobian(black_box(discrete), *t, black_box(y), &mut jacobian);
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
        rates_at(self.model.as_ref(), &self.integrator.state().front().discrete, time, states)
    }

    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        linearization(self.model.as_ref(), &self.integrator.state().front().discrete, time, states)
    }

    fn save(&self, snapshot: &mut Snapshot) {
        record::save(self.integrator.state(), snapshot);
        self.integrator.method().save(snapshot);
        if let Some(audit) = &self.audit {
            audit.save(snapshot);
        }
    }

    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()> {
        let state = record::load(self.model.as_ref(), time, reader)?;
        self.integrator.set_state(self.model.as_ref(), state);
        self.integrator.load_method(reader)?;
        self.audit.as_mut().map_or(Some(()), |audit| audit.load(reader))
    }
}
