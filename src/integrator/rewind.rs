//! The last step made anew, shorter.

use super::controller;
use super::memory::Memory;
use super::method::Method;
use super::problem::Problem;
use super::step::Integrator;

impl<const N: usize, D: Copy, M: Method> Integrator<N, D, M> {
    /// Takes back what lies beyond `t` in the last step: the front is at `t` again, reached by a
    /// step of its own. To be called with the problem that made the step.
    pub fn rewind<P>(&mut self, problem: &P, t: f64)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let start = self.memory.start;
        if t >= self.memory.front.t {
            return;
        }
        self.memory.statistics = self.memory.statistics_at(t);
        self.memory.statistics.steps -= 1;
        self.memory.cuts = 0;
        if t <= start.t {
            self.memory.crossings = 0;
            self.memory.front = start;
            self.memory.end = start;
        } else {
            self.attempt_to(problem, t);
            self.keep(problem, t);
            self.look_at_end_if_due(problem, t);
            self.commit(t);
        }
    }

    /// A shorter step to `t` was not judged. Where it is lost, what was told of this instant takes its place, and where
    /// that is lost, too, the straight line between the longer step's ends, which are not.
    fn keep<P>(&mut self, problem: &P, t: f64)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        if controller::lost_state(problem, &self.made.y).is_none() {
            return;
        }
        self.made.y = self.state_at(problem, t).0;
        if controller::lost_state(problem, &self.made.y).is_some() {
            let Memory { start, end, .. } = &self.memory;
            let share = (t - start.t) / (end.t - start.t);
            self.made.y = std::array::from_fn(|i| (1.0 - share) * start.y[i] + share * end.y[i]);
        }
        if self.gives_end() {
            self.look_at_end(problem, t);
        }
    }

    /// Attempts the last step anew, up to `t`.
    pub(super) fn attempt_to<P>(&mut self, problem: &P, t: f64)
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let start = self.memory.start.t;
        let h = t - start;
        self.attempt(problem, h);
        // Where the step is rounded, its end is not quite at `t`.
        if self.gives_end() && start + h != t {
            self.look_at_end(problem, t);
        }
    }
}
