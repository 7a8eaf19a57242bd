//! Attempt, judge, locate, commit.

use super::block::Past;
use super::controller::{self, Settings};
use super::dense_output::Correction;
use super::error::IntegrationError;
use super::event;
use super::memory::{Front, Memory};
use super::method::{Method, Room};
use super::problem::{Extent, GUARDS, Guard, Problem};
use super::stages::Attempt;
use super::statistics::Statistics;

/// Most events without time passing.
pub(super) const STANDSTILL: usize = 64;

/// A one-step integrator with event location.
pub struct Integrator<const N: usize, D, M: Method> {
    pub(super) settings: Settings,
    pub(super) memory: Memory<N, D>,
    pub(super) guards: [Guard; GUARDS],
    correction: Option<Correction<N>>,
    pub(super) made: Attempt<N>,
    room: M::Room<N>,
}

impl<const N: usize, D: Copy, M: Method> Integrator<N, D, M> {
    /// Starts from the state `y` at `t`.
    pub fn start<P>(problem: &P, settings: Settings, t: f64, y: [f64; N], modes: D) -> Self
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let mut front = Front { t, y, rates: [0.0; N], modes, impact_end: t };
        problem.rates(&modes, t, &y, &mut front.rates);
        let statistics = Statistics { evaluations: 1, ..Statistics::default() };
        let step = controller::first_step(problem, &front);
        let (last_error, cuts) = (1e-4, 0);
        let regime = M::regime(problem);
        let manner = regime.manner;
        let past = Past::NONE;
        let (end, crossings) = (front, 0);
        let memory =
            Memory { start: front, end, front, manner, regime, step, last_error, cuts, crossings, past, statistics };
        Self::resume(problem, settings, memory)
    }

    /// Goes on from a saved state.
    pub fn resume<P>(problem: &P, settings: Settings, memory: Memory<N, D>) -> Self
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let mut guards = [Guard::default(); GUARDS];
        let front = &memory.front;
        problem.guards(&front.modes, front.t, &front.y, &mut guards);
        Self { settings, memory, guards, correction: None, made: Attempt::NONE, room: Room::NEW }
    }

    /// All that is needed to go on.
    pub fn memory(&self) -> &Memory<N, D> {
        &self.memory
    }

    /// Steps until `t` lies within the last step.
    ///
    /// # Errors
    /// See [`IntegrationError`]; the state at the error's time is intact.
    pub fn advance<P>(&mut self, problem: &P, t: f64) -> Result<(), IntegrationError>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        // Most communication points lie within the last step.
        if t <= self.memory.front.t {
            return Ok(());
        }
        let longest = problem.longest_step();
        let longest = if M::ADAPTIVE { longest } else { self.settings.fixed_step.min(longest) };
        self.settings.effort.check(self.memory.front.t, t, longest)?;
        self.march(problem, t, |_| false)
    }

    /// Steps until `t` lies within the last step, or until a step has ended with an event after `after`, and tells
    /// when that was.
    ///
    /// # Errors
    /// As [`Integrator::advance`].
    pub fn advance_to_event<P>(&mut self, problem: &P, after: f64, t: f64) -> Result<Option<f64>, IntegrationError>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let happened = |memory: &Memory<N, D>| memory.crossings > 0 && memory.front.t > after;
        self.march(problem, t, happened)?;
        Ok(Some(self.memory.front.t).filter(|&event| happened(&self.memory) && event <= t))
    }

    /// Starts anew from the state `y` at `t`, with the step that it had.
    pub fn place<P>(&mut self, problem: &P, t: f64, y: [f64; N], modes: D)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let Memory { step, statistics, .. } = self.memory;
        *self = Self::start(problem, self.settings, t, y, modes);
        self.memory.step = step;
        self.memory.statistics = statistics;
        self.memory.statistics.evaluations += 1;
    }

    /// Steps until `t` lies within the last step, or `done` is so.
    fn march<P>(&mut self, problem: &P, t: f64, done: impl Fn(&Memory<N, D>) -> bool) -> Result<(), IntegrationError>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let mut standing = 0;
        let before = self.memory.statistics.evaluations;
        let most = self.settings.effort.over(t - self.memory.front.t);
        while self.memory.front.t < t && !done(&self.memory) {
            let front = self.memory.front.t;
            let evaluations = self.memory.statistics.evaluations - before;
            if evaluations > most {
                return Err(IntegrationError::TooMuchWork { time: front, evaluations });
            }
            self.settle(problem)?;
            self.step(problem)?;
            standing = if self.memory.front.t > front { 0 } else { standing + 1 };
            if standing == STANDSTILL {
                return Err(IntegrationError::events_accumulate(front, &self.guards[..problem.guard_count()]));
            }
        }
        Ok(())
    }

    /// State and modes at `t` in the last step.
    pub fn state_at<P>(&mut self, problem: &P, t: f64) -> ([f64; N], D)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let Memory { start, front, manner, past, .. } = &self.memory;
        if t >= front.t {
            return (front.y, front.modes);
        }
        if !M::character(*manner).interpolates && t > start.t {
            M::attempt(&mut self.made, &mut self.room, problem, start, past, t - start.t, *manner);
            if controller::lost_state(problem, &self.made.y).is_none() {
                return (self.made.y, start.modes);
            }
        }
        let step = self.memory.last_step(Extent::of(problem));
        let tolerance = self.settings.tolerance;
        let correction = self.correction.get_or_insert_with(|| step.correction(problem, &start.modes, tolerance));
        (step.state((t - step.t) / step.h, correction), start.modes)
    }

    /// Attempts a step of `h` from the start of the last one.
    pub(super) fn attempt<P>(&mut self, problem: &P, h: f64)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let Memory { start, manner, past, statistics, .. } = &mut self.memory;
        statistics.evaluations += M::attempt(&mut self.made, &mut self.room, problem, start, past, h, *manner);
    }

    /// To be called when the problem has changed at the front: rates and guards are taken anew.
    pub fn refresh<P: Problem<N, Modes = D> + ?Sized>(&mut self, problem: &P) {
        self.memory.past.forget();
        let front = &mut self.memory.front;
        problem.rates(&front.modes, front.t, &front.y, &mut front.rates);
        problem.guards(&front.modes, front.t, &front.y, &mut self.guards);
        self.memory.statistics.evaluations += 1;
    }

    /// One accepted step, up to the first event in it.
    fn step<P>(&mut self, problem: &P) -> Result<(), IntegrationError>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let Front { t, rates, .. } = &self.memory.front;
        if let Some(component) = controller::lost_state(problem, rates) {
            return Err(IntegrationError::NotFinite { time: *t, component });
        }
        let kink = self.foreseen_kink(problem);
        let Memory { start: earlier, manner: earlier_manner, .. } = self.memory;
        self.memory.start = self.memory.front;
        self.memory.manner = self.memory.regime.manner;
        let h = match self.accepted(problem, kink) {
            Ok(h) => h,
            Err(error) => {
                (self.memory.start, self.memory.manner) = (earlier, earlier_manner);
                self.memory.past.forget();
                return Err(error);
            }
        };
        let before = self.guards;
        self.commit(self.memory.start.t + h);
        if let Some(component) = controller::lost_state(problem, &self.memory.end.rates) {
            return self.take_back(before, h, component);
        }
        M::choose(&self.made, &mut self.room, problem, &mut self.memory);
        if problem.guard_count() == 0 {
            return Ok(());
        }
        // A state beyond a dead end is none, not even between two communication points.
        if !M::LOCATES && !(0..problem.guard_count()).any(|guard| problem.is_dead_end(guard)) {
            self.notice(problem);
            return Ok(());
        }
        let step = self.memory.last_step(Extent::of(problem));
        if let Some((share, guard)) = event::first(problem, &self.memory.start.modes, &step, &before, &self.guards) {
            self.land(problem, h, share, guard);
            // The shorter step up to the event was not judged.
            if let Some(component) = controller::lost_state(problem, &self.memory.front.y) {
                return self.take_back(before, h, component);
            }
        }
        Ok(())
    }

    /// Takes back the last step, of `h` from where the guards were `guards`: this `component` was lost in it.
    fn take_back(&mut self, guards: [Guard; GUARDS], h: f64, component: usize) -> Result<(), IntegrationError> {
        let Memory { start, end, front, manner, step, past, crossings, statistics, .. } = &mut self.memory;
        (*end, *front) = (*start, *start);
        statistics.steps -= 1;
        statistics.events -= *crossings;
        *crossings = 0;
        past.forget();
        self.guards = guards;
        if M::ADAPTIVE {
            // Nothing had estimated the error of what was lost: a shorter step may end before that.
            statistics.rejected += 1;
            *step = controller::shrinkage(f64::INFINITY, M::character(*manner).error_power) * h;
            return Ok(());
        }
        // Without an error estimate a step may have led anywhere.
        Err(IntegrationError::NotFinite { time: start.t, component })
    }

    /// An attempt has given rates and guards at its end.
    pub(super) fn gives_end(&self) -> bool {
        M::character(self.memory.manner).gives_end
    }

    /// Takes rates and guards at the end of the attempt, at `t`.
    pub(super) fn look_at_end<P: Problem<N, Modes = D> + ?Sized>(&mut self, problem: &P, t: f64) {
        let Attempt { y, rates, guards, .. } = &mut self.made;
        problem.rates_and_guards(&self.memory.start.modes, t, y, rates, guards);
        self.memory.statistics.evaluations += 1;
    }

    /// The same, if the attempt has not given them.
    pub(super) fn look_at_end_if_due<P: Problem<N, Modes = D> + ?Sized>(&mut self, problem: &P, t: f64) {
        if !self.gives_end() {
            self.look_at_end(problem, t);
        }
    }

    /// Makes the attempt, whose end has been looked at, the step that ends at `t`.
    pub(super) fn commit(&mut self, t: f64) {
        let Front { modes, impact_end, .. } = self.memory.start;
        let Attempt { y, rates, guards, .. } = &self.made;
        let end = Front { t, y: *y, rates: *rates, modes, impact_end };
        self.guards = *guards;
        self.memory.statistics.steps += 1;
        self.memory.end = end;
        self.memory.front = end;
        self.memory.crossings = 0;
        self.correction = None;
        self.predict_from_attempt(t);
    }

    /// Predicts the next attempt from the last one, which ends at `t`, if the method predicts any.
    pub(super) fn predict_from_attempt(&mut self, t: f64) {
        if M::character(self.memory.manner).predicts {
            let start = &self.memory.start;
            self.memory.past = Past { begin: start.t, end: t, start: start.rates, nodes: self.made.nodes };
        }
    }
}
