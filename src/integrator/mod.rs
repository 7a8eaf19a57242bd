//! The integrator: advances a hybrid system in time. It knows no mechanism, only [`System`].
//!
//! A hybrid system has a continuous state, which follows its rates, and a discrete state, which is constant in a step
//! and changes only at events. [`Integrator::advance`] attempts a step, judges its error, locates the first event in
//! it, repeats the step up to that event and commits it. Steps do not depend on communication points:
//! [`Integrator::state_at`] interpolates back into the last step, so that the sequence of steps is the same for any
//! communication intervals.
//!
//! States are slices and methods are values behind [`Method`], so that this code is compiled once. An integrator does
//! not allocate after it has been started.

pub mod complementarity;
mod deadline;
pub mod dense_output;
mod derivative_discontinuity;
mod error;
mod event_location;
mod linear;
pub mod method;
pub mod methods;
pub mod root;
mod second_order;
mod snapshot;
mod state;
mod statistics;
mod step_acceptance;
mod step_control;
mod stepper;
pub mod system;
mod tableau;
pub mod tangent;
mod truncate;
mod unilateral;

pub use deadline::{Account, Deadline, Pace};
pub use error::IntegrationError;
pub use method::{Method, MethodKind, Properties, StepWork};
pub use methods::moreau::Moreau;
pub use snapshot::{Reader, Snapshot};
pub use state::{SolverState, StepPoint};
pub use statistics::Statistics;
pub use step_control::{Settings, WorkLimit};
pub use system::{
    Discontinuities, EventFunction, EventFunctions, Events, Jacobian, Linearizable, MAX_DISCONTINUITIES, MAX_EVENTS,
    MAX_STATES, Ode, Reset, SeveralInstants, StateLayout, System, Triggered,
};
pub use tableau::{MAX_STAGES, Tableau};
pub use unilateral::{ContactLaw, Impulses, Relative, Unilateral};

use state::first_invalid;
use stepper::Stepper;

/// An integrator with event location.
pub struct Integrator<D> {
    stepper: Stepper<D>,
}

impl<D: Copy> Integrator<D> {
    /// Starts a motion from the state `y` at `t`.
    pub fn start(
        system: &dyn System<Discrete = D>,
        mut method: Box<dyn Method<D>>,
        settings: Settings,
        t: f64,
        y: &[f64],
        discrete: D,
    ) -> Self {
        method.begin(system);
        Self { stepper: Stepper::new(system, method, settings, state_of_start(system, t, y, discrete)) }
    }

    /// Resumes from a saved state, with a method whose memory was saved with it.
    pub fn resume(
        system: &dyn System<Discrete = D>,
        method: Box<dyn Method<D>>,
        settings: Settings,
        state: SolverState<D>,
    ) -> Self {
        Self { stepper: Stepper::new(system, method, settings, state) }
    }

    /// The same integrator with a budget of evaluations.
    #[must_use]
    pub fn with_deadline(mut self, deadline: Option<Deadline>) -> Self {
        self.stepper.deadline = deadline;
        self
    }

    /// The solver's state: all that a later [`resume`](Self::resume) needs apart from the method's memory.
    pub fn state(&self) -> &SolverState<D> {
        &self.stepper.state
    }

    /// The method and its memory.
    pub fn method(&self) -> &dyn Method<D> {
        &*self.stepper.method
    }

    /// Writes the state at `t` in the last step by the method's own polynomial. Returns whether there is one.
    pub fn inside(&self, t: f64, y: &mut [f64]) -> bool {
        self.stepper.method.inside(&self.state().last_step(self.stepper.layout), t, y)
    }

    /// Restores the memory of the method from a snapshot; `None` if no run can have produced it.
    pub fn load_method(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        self.stepper.with_method(|method| method.load(reader))
    }

    /// Continues from another state.
    pub fn set_state(&mut self, system: &dyn System<Discrete = D>, state: SolverState<D>) {
        self.stepper.set_state(system, state);
    }

    /// Steps until `t` lies within the last step.
    ///
    /// # Errors
    /// See [`IntegrationError`]; the state at the error's time is intact.
    pub fn advance(&mut self, system: &dyn System<Discrete = D>, t: f64) -> Result<(), IntegrationError> {
        self.advance_watched(system, t, &mut |_| ())
    }

    /// As [`advance`](Self::advance); `watch` sees each step that was accepted.
    ///
    /// # Errors
    /// As [`Integrator::advance`].
    pub fn advance_watched(
        &mut self,
        system: &dyn System<Discrete = D>,
        t: f64,
        watch: &mut dyn FnMut(&mut Self),
    ) -> Result<(), IntegrationError> {
        // Most communication points lie within the last step.
        let Stepper { settings, properties, state, .. } = &self.stepper;
        if t <= state.front().t {
            return Ok(());
        }
        let longest = system.longest_step();
        let longest = if properties.adaptive { longest } else { settings.fixed_step.min(longest) };
        settings.effort.check(state.front().t, t, longest)?;
        self.march(system, t, None, watch)
    }

    /// Steps until `t` lies within the last step, or until a step has ended with an event later than `after`.
    /// Returns the time [s] of that event, if it happened by `t`.
    ///
    /// # Errors
    /// As [`Integrator::advance`].
    pub fn advance_to_event(
        &mut self,
        system: &dyn System<Discrete = D>,
        after: f64,
        t: f64,
    ) -> Result<Option<f64>, IntegrationError> {
        self.advance_to_event_watched(system, after, t, &mut |_| ())
    }

    /// As [`advance_to_event`](Self::advance_to_event); `watch` sees each step that was accepted.
    ///
    /// # Errors
    /// As [`Integrator::advance`].
    pub fn advance_to_event_watched(
        &mut self,
        system: &dyn System<Discrete = D>,
        after: f64,
        t: f64,
        watch: &mut dyn FnMut(&mut Self),
    ) -> Result<Option<f64>, IntegrationError> {
        self.march(system, t, Some(after), watch)?;
        Ok(Some(self.state().front().t).filter(|&event| self.has_crossed(after) && event <= t))
    }

    /// Restarts from the state `y` at `t`, with the present step size and statistics.
    pub fn place(&mut self, system: &dyn System<Discrete = D>, t: f64, y: &[f64], discrete: D) {
        let SolverState { step, mut statistics, account, .. } = *self.state();
        statistics.evaluations += 1;
        self.stepper.with_method(|method| method.begin(system));
        let mut state = state_of_start(system, t, y, discrete);
        (state.step, state.statistics, state.account) = (step, statistics, account);
        self.stepper.set_state(system, state);
    }

    /// Whether the last step ended with an event after the time `after`.
    fn has_crossed(&self, after: f64) -> bool {
        self.state().crossings > 0 && self.state().front().t > after
    }

    /// Steps until `t` lies within the last step, or until a step has ended with an event after the time `after`.
    fn march(
        &mut self,
        system: &dyn System<Discrete = D>,
        t: f64,
        after: Option<f64>,
        watch: &mut dyn FnMut(&mut Self),
    ) -> Result<(), IntegrationError> {
        let mut stalled_steps = 0;
        let before = self.state().statistics.evaluations;
        let work_limit = self.stepper.settings.effort.over(t - self.state().front().t);
        while self.state().front().t < t && !after.is_some_and(|after| self.has_crossed(after)) {
            let front = self.state().front().t;
            let evaluations = self.state().statistics.evaluations - before;
            if evaluations > work_limit {
                return Err(IntegrationError::TooMuchWork { time: front, evaluations });
            }
            event_location::settle(&mut self.stepper, system)?;
            self.step(system)?;
            watch(self);
            // A step that nothing has judged may have led anywhere.
            if !self.stepper.properties.adaptive
                && let Some(event) = self.highest_exceeded(system)
            {
                return Err(IntegrationError::OutOfRange { time: self.state().front().t, event });
            }
            stalled_steps = if self.state().front().t > front { 0 } else { stalled_steps + 1 };
            if stalled_steps == event_location::MAX_EVENTS_AT_ONE_TIME {
                let events = &self.stepper.events[..system.event_count()];
                return Err(IntegrationError::events_accumulate(front, events));
            }
        }
        Ok(())
    }

    /// The event function that is higher at the front than the equations hold.
    fn highest_exceeded(&self, system: &dyn System<Discrete = D>) -> Option<usize> {
        let highest = system.highest_events();
        (0..system.event_count()).find(|&event| self.stepper.events[event].value > highest[event])
    }

    /// Makes one accepted step, up to the first event in it.
    fn step(&mut self, system: &dyn System<Discrete = D>) -> Result<(), IntegrationError> {
        let stepper = &mut self.stepper;
        let StepPoint { t, rates, .. } = stepper.state.front();
        if let Some(component) = first_invalid(rates) {
            return Err(IntegrationError::NotFinite { time: *t, component });
        }
        // Attempt and judge.
        let predicted = step_acceptance::predicted_discontinuity(stepper, system);
        let earlier_kind = stepper.method.kind();
        let evaluations = stepper.state.statistics.evaluations;
        stepper.state.begin_step();
        stepper.begin_budget();
        stepper.set_kind(stepper.method.next_kind());
        let h = match step_acceptance::accepted(stepper, system, predicted) {
            Ok(h) => h,
            Err(error) => {
                stepper.state.give_up_step();
                stepper.set_kind(earlier_kind);
                stepper.method.forget();
                return Err(error);
            }
        };
        // Commit.
        let before = stepper.events;
        stepper.commit(stepper.state.start().t + h);
        if let Some(component) = first_invalid(&stepper.state.end().rates) {
            return self.take_back(before, h, component);
        }
        let SolverState { statistics, step, .. } = &stepper.state;
        let work = StepWork { evaluations: statistics.evaluations - evaluations, next: *step };
        let advice = stepper.method.accepted(system, stepper.state.start(), stepper.state.end(), work);
        stepper.state.step = stepper.state.step.min(advice.longest_step);
        stepper.state.statistics.evaluations += advice.evaluations;
        if system.event_count() == 0 {
            return Ok(());
        }
        // The state behind a dead end is invalid, even between two communication points: every method locates dead
        // ends.
        if !stepper.properties.locates && !(0..system.event_count()).any(|event| system.is_dead_end(event)) {
            event_location::notice(stepper, system);
            return Ok(());
        }
        // Locate the first event, and commit the step that ends at it.
        if let Some((share, event)) = event_location::first(stepper, system, &before) {
            event_location::land(stepper, system, h, share, event);
            // The error of the shorter step to the event was not judged.
            if let Some(component) = first_invalid(&stepper.state.front().y) {
                return self.take_back(before, h, component);
            }
        }
        Ok(())
    }

    /// Discards the last step, of length `h`, because state `component` became invalid in it. `events` are the event
    /// functions where it started.
    fn take_back(&mut self, events: EventFunctions, h: f64, component: usize) -> Result<(), IntegrationError> {
        let Stepper { state, method, properties, events: at_front, .. } = &mut self.stepper;
        state.take_back();
        state.statistics.steps -= 1;
        state.statistics.events -= state.crossings;
        state.crossings = 0;
        method.forget();
        *at_front = events;
        if properties.adaptive {
            // The error estimate did not include the invalid rates: a shorter step may end before them.
            state.statistics.rejected += 1;
            state.step = step_control::shrinkage(f64::INFINITY, properties.error_power) * h;
            return Ok(());
        }
        // A step without an error estimate may have ended anywhere.
        Err(IntegrationError::NotFinite { time: state.start().t, component })
    }

    /// State and discrete state at the time `t` in the last step.
    pub fn state_at(&mut self, system: &dyn System<Discrete = D>, t: f64) -> (&[f64], D) {
        self.stepper.state_at(system, t)
    }

    /// Shortens the last step so that it ends at `t`, by a new step.
    pub fn truncate(&mut self, system: &dyn System<Discrete = D>, t: f64) {
        truncate::truncate(&mut self.stepper, system, t);
    }

    /// Changes the discrete state at the ends of the last step, in parts that have no influence on the motion.
    pub fn for_each_discrete(&mut self, change: impl FnMut(&mut D)) {
        self.stepper.state.for_each_discrete(change);
    }

    /// Begins a communication step: the errors of later steps are counted from here.
    pub fn begin_interval(&mut self) {
        self.stepper.state.account.error = 0.0;
    }

    /// Replaces the discrete state at the front; rates and event functions are computed again.
    pub fn set_discrete(&mut self, system: &dyn System<Discrete = D>, discrete: D) {
        self.stepper.set_discrete(system, discrete);
    }
}

/// The solver's state at the start of a motion.
fn state_of_start<D: Copy>(system: &dyn System<Discrete = D>, t: f64, y: &[f64], discrete: D) -> SolverState<D> {
    let mut point = StepPoint::new(t, y, discrete);
    system.rates(&discrete, t, y, &mut point.rates);
    let mut state = SolverState::new(&point, step_control::first_step(system, &point));
    state.statistics.evaluations = 1;
    state
}
