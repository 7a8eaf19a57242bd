//! Events at the end of a step: landing on one, and crossing it.

use super::error::IntegrationError;
use super::method::Method;
use super::problem::{Crossed, Guard, Problem};
use super::step::{Integrator, STANDSTILL};

/// Most times that a landing is repeated to bring the guard closer to zero.
const LANDINGS: usize = 3;
/// Share of an impact's duration for the first step into it.
const ONSET: f64 = 0.03;
/// A guard this share of a tolerable error away from zero has been landed on.
const LANDED: f64 = 0.1;

impl<const N: usize, D: Copy, M: Method> Integrator<N, D, M> {
    /// Handles the guards that are at or below zero and falling where the next step starts.
    ///
    /// # Errors
    /// `DeadEnd` if one of them is a dead end, `EventsAccumulate` if there is no end of them.
    pub(super) fn settle<P: Problem<N, Modes = D> + ?Sized>(&mut self, problem: &P) -> Result<(), IntegrationError> {
        let count = problem.guard_count();
        let near = LANDED * problem.guard_scale();
        let ended = |i: &usize| self.guards[*i].value <= near && self.guards[*i].rate < 0.0 && problem.is_dead_end(*i);
        if let Some(guard) = (0..count).find(ended) {
            return Err(IntegrationError::DeadEnd { time: self.memory.front.t, guard });
        }
        for _ in 0..STANDSTILL {
            let Some(guard) = (0..count).find(|&i| has_fallen(&self.guards[i])) else {
                return Ok(());
            };
            self.cross_with(problem, guard, 0.0);
        }
        Err(IntegrationError::events_accumulate(self.memory.front.t, &self.guards[..count]))
    }

    /// Crosses the events of all guards that are below zero at the front.
    pub(super) fn notice<P>(&mut self, problem: &P)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let below = |guard: &Guard| guard.value < 0.0;
        let crossed: Crossed = std::array::from_fn(|i| i < problem.guard_count() && below(&self.guards[i]));
        if crossed.contains(&true) {
            self.cross(problem, &crossed);
        }
    }

    /// Repeats the step up to the event at `share` of it and crosses the event, if anything lies beyond it.
    pub(super) fn land<P>(&mut self, problem: &P, h: f64, share: f64, guard: usize)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let start = self.memory.start;
        // The step that was too long is made anew, shorter.
        self.memory.statistics.steps -= 1;
        let close = LANDED * self.settings.tolerance * problem.guard_scale();
        let mut t = start.t + share * h;
        for landing in 1..=LANDINGS {
            if t <= start.t {
                self.memory.end = start;
                self.memory.front = start;
                self.refresh(problem);
                break;
            }
            self.attempt_to(problem, t);
            if !self.gives_end() {
                problem.guards(&start.modes, t, &self.made.y, &mut self.made.guards);
            }
            let Guard { value, rate } = self.made.guards[guard];
            let better = t - value / rate;
            let useful = rate < 0.0 && better < start.t + h && better != t;
            if landing == LANDINGS || value.abs() <= close || !useful {
                self.look_at_end_if_due(problem, t);
                self.commit(t);
                break;
            }
            t = better;
        }
        if !problem.is_dead_end(guard) {
            self.cross_with(problem, guard, close);
        }
    }

    /// Crosses the event of `guard` at the front, and of all guards that have fallen with it: those
    /// within `close` of zero.
    fn cross_with<P>(&mut self, problem: &P, guard: usize, close: f64)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let with = |i: usize| i == guard || (self.guards[i].value <= close && self.guards[i].rate < 0.0);
        let crossed: Crossed = std::array::from_fn(|i| i < problem.guard_count() && with(i));
        self.cross(problem, &crossed);
    }

    fn cross<P>(&mut self, problem: &P, crossed: &Crossed)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let count = crossed.iter().map(|&crossed| u64::from(crossed)).sum::<u64>();
        self.memory.crossings += count;
        self.memory.statistics.events += count;
        let front = &mut self.memory.front;
        let reset = problem.cross(&front.modes, front.t, &mut front.y, crossed);
        front.modes = reset.modes;
        if let Some(duration) = reset.impact {
            front.impact_end = front.impact_end.max(front.t + duration.min(problem.longest_step()));
            self.memory.step = self.memory.step.min(ONSET * duration);
        }
        self.refresh(problem);
    }
}

fn has_fallen(guard: &Guard) -> bool {
    guard.value <= 0.0 && guard.rate < 0.0
}
