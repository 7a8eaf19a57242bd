//! The last step and the operations on it: attempt, evaluate its end, commit, interpolate.

use super::deadline::{self, Deadline, stretch};
use super::dense_output::Correction;
use super::method::{Attempt, Method, MethodKind, Properties};
use super::state::{SolverState, StepPoint, first_invalid};
use super::step_control::Settings;
use super::system::{EventFunctions, StateLayout, System};

/// A method, the last step and the attempt at the next step.
pub struct Stepper<D> {
    pub(super) settings: Settings,
    /// The budget of evaluations, if there is one.
    pub(super) deadline: Option<Deadline>,
    pub(super) method: Box<dyn Method<D>>,
    /// Properties of the method's present kind.
    pub(super) properties: Properties,
    pub(super) layout: StateLayout,
    pub(super) state: SolverState<D>,
    /// The event functions at the front.
    pub(super) events: EventFunctions,
    pub(super) attempt: Attempt,
    correction: Correction,
    /// A state within the last step.
    inside: Vec<f64>,
}

impl<D: Copy> Stepper<D> {
    /// Resumes from a saved state.
    pub(super) fn new(
        system: &dyn System<Discrete = D>,
        method: Box<dyn Method<D>>,
        settings: Settings,
        state: SolverState<D>,
    ) -> Self {
        let n = state.front().y.len();
        let (attempt, correction) = (Attempt::new(n, settings.tolerance), Correction::new(n));
        let events = attempt.events;
        let (properties, layout) = (*method.properties(), system.layout());
        let mut stepper = Self {
            settings,
            deadline: None,
            method,
            properties,
            layout,
            state,
            events,
            attempt,
            correction,
            inside: vec![0.0; n],
        };
        stepper.update_events(system);
        stepper
    }

    /// Continues from another state.
    pub(super) fn set_state(&mut self, system: &dyn System<Discrete = D>, state: SolverState<D>) {
        self.state = state;
        self.correction.forget();
        self.update_events(system);
    }

    /// Changes the method and updates the copy of its properties.
    pub(super) fn with_method<R>(&mut self, work: impl FnOnce(&mut dyn Method<D>) -> R) -> R {
        let done = work(&mut *self.method);
        self.properties = *self.method.properties();
        done
    }

    /// Selects the kind of steps, if the method has more than one.
    pub(super) fn set_kind(&mut self, kind: MethodKind) {
        if kind != self.method.kind() {
            self.with_method(|method| method.set_kind(kind));
        }
    }

    fn update_events(&mut self, system: &dyn System<Discrete = D>) {
        let StepPoint { t, y, discrete, .. } = self.state.front();
        system.event_functions(discrete, *t, y, &mut self.events);
    }

    /// Opens the interval of the next step in the budget, and fits the next step to the tolerance that the budget allows.
    pub(super) fn begin_budget(&mut self) {
        let Some(deadline) = self.deadline else { return };
        let time = self.state.start().t;
        let before = self.state.account.looseness;
        let work = self.state.work();
        deadline.begin_step(&mut self.state.account, time, work);
        self.state.step *= stretch(self.looseness() / before, self.properties.error_power);
    }

    /// The tolerance of the present step over the nominal tolerance, as the budget allows it.
    pub(super) fn looseness(&mut self) -> f64 {
        let Some(deadline) = self.deadline else { return 1.0 };
        let (time, power) = (self.state.start().t, self.properties.error_power);
        let state = &mut self.state;
        state.account.looseness =
            deadline.looseness(&state.account, time, state.work(), self.settings.tolerance, power);
        state.account.looseness
    }

    /// The tolerance of the last step over the nominal tolerance; 1 without a budget.
    pub(super) fn allowed_looseness(&self) -> f64 {
        self.deadline.map_or(1.0, |_| self.state.account.looseness)
    }

    /// Attempts a step of length `h` [s] from the start of the present step, and counts its work.
    pub(super) fn attempt(&mut self, system: &dyn System<Discrete = D>, h: f64) {
        let evaluations = self.attempt_uncounted(system, h);
        self.state.statistics.evaluations += evaluations;
        self.state.account.jacobians += deadline::work_of(self.attempt.jacobians, self.layout.states);
    }

    /// As [`attempt`](Self::attempt), but counts nothing. Returns the number of evaluations.
    fn attempt_uncounted(&mut self, system: &dyn System<Discrete = D>, h: f64) -> u64 {
        self.attempt.tolerance = self.allowed_looseness() * self.settings.tolerance;
        self.attempt.jacobians = 0;
        let (start, end) = self.state.ends();
        self.method.attempt(system, start, h, end, &mut self.attempt)
    }

    /// Repeats the attempt at the last step so that it ends at `t`.
    pub(super) fn attempt_to(&mut self, system: &dyn System<Discrete = D>, t: f64) {
        let start = self.state.start().t;
        let h = t - start;
        self.attempt(system, h);
        // The end of a rounded step differs from `t`.
        if self.gives_end() && start + h != t {
            self.evaluate_end(system, t);
        }
    }

    /// Whether an attempt computes the rates and event functions at its end.
    pub(super) fn gives_end(&self) -> bool {
        self.properties.gives_end
    }

    /// Computes the rates and event functions at the end of the attempt, at `t`.
    pub(super) fn evaluate_end(&mut self, system: &dyn System<Discrete = D>, t: f64) {
        let (start, StepPoint { y, rates, .. }) = self.state.ends();
        system.rates_and_event_functions(&start.discrete, t, y, rates, &mut self.attempt.events);
        self.state.statistics.evaluations += 1;
    }

    /// Computes the rates and event functions at the end of the attempt, unless the method has computed them.
    pub(super) fn evaluate_end_if_missing(&mut self, system: &dyn System<Discrete = D>, t: f64) {
        if !self.gives_end() {
            self.evaluate_end(system, t);
        }
    }

    /// Makes the attempt, with rates and event functions at its end, the step that ends at `t`.
    pub(super) fn commit(&mut self, t: f64) {
        self.events = self.attempt.events;
        self.state.commit(t);
        self.correction.forget();
        self.predict_from_attempt(t);
    }

    /// Makes the last attempt, which ends at `t`, the history of the next prediction, if the method predicts.
    pub(super) fn predict_from_attempt(&mut self, t: f64) {
        if self.properties.predicts {
            self.method.remember(self.state.start(), t);
        }
    }

    /// Replaces the discrete state at the front.
    pub(super) fn set_discrete(&mut self, system: &dyn System<Discrete = D>, discrete: D) {
        self.state.front_mut().discrete = discrete;
        self.refresh(system);
    }

    /// Computes rates and event functions at the front after a change of its discrete state.
    pub(super) fn refresh(&mut self, system: &dyn System<Discrete = D>) {
        self.method.forget();
        let StepPoint { t, y, rates, discrete, .. } = self.state.front_mut();
        system.rates(discrete, *t, y, rates);
        system.event_functions(discrete, *t, y, &mut self.events);
        self.state.statistics.evaluations += 1;
    }

    /// Makes the state at `t` in the last step, as [`state_at`](Self::state_at) reports it, the end of the attempt.
    pub(super) fn attempt_interpolated(&mut self, system: &dyn System<Discrete = D>, t: f64) {
        if !self.is_inside(t) {
            if self.is_attempted_at(system, t) {
                return;
            }
            self.interpolate(system, t);
        }
        self.state.ends().1.y.copy_from_slice(&self.inside);
    }

    /// State and discrete state at `t` in the last step.
    pub(super) fn state_at(&mut self, system: &dyn System<Discrete = D>, t: f64) -> (&[f64], D) {
        if t >= self.state.front().t {
            let front = self.state.front();
            return (&front.y, front.discrete);
        }
        let discrete = self.state.start().discrete;
        if self.is_inside(t) {
            return (&self.inside, discrete);
        }
        if self.is_attempted_at(system, t) {
            return (&self.state.attempt().y, discrete);
        }
        self.interpolate(system, t);
        (&self.inside, discrete)
    }

    /// Writes the state at `t` in the last step by the method's own polynomial. Returns whether there is one.
    fn is_inside(&mut self, t: f64) -> bool {
        let Self { method, state, layout, inside, .. } = self;
        method.inside(&state.last_step(*layout), t, inside)
    }

    /// For a method that does not interpolate, attempts a step to `t` within the last one. Returns whether its end is
    /// valid.
    fn is_attempted_at(&mut self, system: &dyn System<Discrete = D>, t: f64) -> bool {
        if self.properties.interpolates || t <= self.state.start().t {
            return false;
        }
        self.attempt_uncounted(system, t - self.state.start().t);
        first_invalid(&self.state.attempt().y).is_none()
    }

    /// Interpolates the state at `t` within the last step.
    fn interpolate(&mut self, system: &dyn System<Discrete = D>, t: f64) {
        let step = self.state.last_step(self.layout);
        self.correction.find(&step, system, &self.state.start().discrete, self.settings.tolerance);
        step.state((t - step.t) / step.h, self.correction.coefficients(), &mut self.inside);
    }
}
