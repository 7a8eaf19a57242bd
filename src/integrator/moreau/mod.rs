//! Moreau's midpoint rule: time stepping for rigid contacts, with Newton's restitution and Coulomb's friction (J. J.
//! Moreau, in Nonsmooth Mechanics and Applications, CISM 302, Springer 1988; M. Jean, Comput. Methods Appl. Mech. Eng.
//! 177 (1999) 235; for a slider-crank: P. Flores, R. Leine, C. Glocker, Multibody Syst. Dyn. 23 (2010) 165).
//!
//! A step of h from (q_A, u_A): q_M = q_A + (h/2)·u_A; the contacts whose gap is gone by then are closed;
//! M(q_M)·(u_E − u_A) = h·f + W_N·Λ_N + W_T·Λ_T, where ξ_N = γ_NE + e_N·γ_NA ≥ 0 is complementary to Λ_N ≥ 0 and
//! −Λ_T ∈ μ·Λ_N·Sgn(γ_TE); q_E = q_M + (h/2)·u_E. Impacts are not located: a step may hold several, and a lasting
//! contact is an impact in every step.
//!
//! Three things are of the second order in h here that are usually of the first, all because minimal coordinates are
//! curved:
//! - Forces f that depend on velocity are taken half-way between u_A and u_E (as known from a first pass), not at u_A.
//! - γ_A and γ_E are the velocities where the step starts and where it ends, not those that u_A and u_E would have at
//!   q_M: they differ by (h/2)·Ẇᵀu (taken from the step without contacts), as much as the velocities of a lasting
//!   contact. So a journal in its bearing leaves no step along the tangent, and chatter comes to rest.
//! - A contact is closed if gap + (h/2)·γ_A ≤ 0 at the start, for the same reason.
//!
//! So the rule is of order 2 where nothing touches or contacts last, and of order 1 through an impact, which errs by
//! what is passed in a step.
//!
//! Penetration: an impact goes as deep as its approach in a step, h·|γ_NA|. In a lasting contact, a tenth of what is
//! deeper than the h·|γ_N| of the step is taken back in every step, by the shift of positions of least kinetic
//! distance; so what an impact leaves behind fades, and what stays is of order h². Contacts that part are left alone:
//! lifting them would add energy.
//!
//! Newton's restitution with friction may add energy too, where an impact turns the sliding about and restitution is
//! near 1 (T. R. Kane, D. A. Levinson, Dynamics: Theory and Applications, McGraw-Hill 1985). Without friction and with
//! one restitution it never does.

mod attempt;
mod closed;

use super::block::Past;
use super::controller::Settings;
use super::error::IntegrationError;
use super::memory::{Front, Memory};
use super::problem::{Extent, GUARDS, Guard, Problem};
use super::regime::{Manner, Regime};
use super::statistics::Statistics;
use super::unilateral::{Impulses, Unilateral};
use attempt::{Made, attempt};

/// Time stepping with a fixed step.
pub struct Moreau<const N: usize> {
    settings: Settings,
    memory: Memory<N, Impulses<N>>,
}

impl<const N: usize> Moreau<N> {
    /// Starts from the state `y` at `t`.
    pub fn start(settings: Settings, t: f64, y: [f64; N]) -> Self {
        // Rates are of no use to it.
        let front = Front { t, y, rates: [0.0; N], modes: Impulses::none(t, y), impact_end: t };
        let statistics = Statistics::default();
        let memory = Memory {
            past: Past::NONE,
            start: front,
            end: front,
            front,
            manner: Manner::Explicit,
            regime: Regime::LOOSE,
            step: settings.fixed_step,
            last_error: 0.0,
            cuts: 0,
            crossings: 0,
            statistics,
        };
        Self::resume(settings, memory)
    }

    /// Goes on from a saved state.
    pub fn resume(settings: Settings, memory: Memory<N, Impulses<N>>) -> Self {
        Self { settings, memory }
    }

    /// All that is needed to go on.
    pub fn memory(&self) -> &Memory<N, Impulses<N>> {
        &self.memory
    }

    /// Steps until `t` lies within the last step.
    ///
    /// # Errors
    /// See [`IntegrationError`]; the state at the error's time is intact.
    pub fn advance<P>(&mut self, problem: &P, t: f64) -> Result<(), IntegrationError>
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let longest = self.settings.fixed_step.min(problem.longest_step());
        self.settings.effort.check(self.memory.front.t, t, longest)?;
        self.march(problem, t, |_| false)
    }

    /// Steps until `t` lies within the last step, or until a step has ended after `after` that closed or opened
    /// contacts, and tells when that was.
    ///
    /// # Errors
    /// As [`Moreau::advance`].
    pub fn advance_to_event<P>(&mut self, problem: &P, after: f64, t: f64) -> Result<Option<f64>, IntegrationError>
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let happened = |memory: &Memory<N, Impulses<N>>| memory.crossings > 0 && memory.front.t > after;
        self.march(problem, t, happened)?;
        Ok(Some(self.memory.front.t).filter(|&event| happened(&self.memory) && event <= t))
    }

    /// Starts anew from the state `y` at `t`.
    pub fn place(&mut self, t: f64, y: [f64; N]) {
        let statistics = self.memory.statistics;
        *self = Self::start(self.settings, t, y);
        self.memory.statistics = statistics;
    }

    /// Steps until `t` lies within the last step, or `done` is so.
    fn march<P>(
        &mut self,
        problem: &P,
        t: f64,
        done: impl Fn(&Memory<N, Impulses<N>>) -> bool,
    ) -> Result<(), IntegrationError>
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let before = self.memory.statistics.evaluations;
        let most = self.settings.effort.over(t - self.memory.front.t);
        while self.memory.front.t < t && !done(&self.memory) {
            let start = self.memory.front;
            let evaluations = self.memory.statistics.evaluations - before;
            if evaluations > most {
                return Err(IntegrationError::TooMuchWork { time: start.t, evaluations });
            }
            // The step is what time really moves by: nothing drifts from its rounding.
            let step = self.settings.fixed_step;
            let end = start.t + step.min(problem.longest_step());
            if end <= start.t {
                return Err(IntegrationError::StepUnderflow { time: start.t, step, component: 0 });
            }
            let made = attempt(problem, &start, end - start.t)?;
            if let Some(guard) = dead_end(problem, end, &made.y) {
                return Err(IntegrationError::DeadEnd { time: start.t, guard });
            }
            self.memory.start = start;
            self.commit(end, made);
        }
        Ok(())
    }

    /// State at `t` in the last step, and the step's impulses. Velocities change evenly within a step, at
    /// impacts too.
    pub fn state_at<P>(&self, problem: &P, t: f64) -> ([f64; N], Impulses<N>)
    where
        P: Unilateral<N> + ?Sized,
    {
        let Memory { start, end, front, .. } = &self.memory;
        if t >= front.t {
            return (front.y, front.modes);
        }
        let (span, passed) = (end.t - start.t, t - start.t);
        let share = passed / span;
        let mut y = end.y;
        let p = Extent::of(problem).positions;
        for i in 0..p {
            let (q, u) = (start.y[i], start.y[p + i]);
            y[i] = q + passed * u + share * share * (end.y[i] - q - span * u);
            y[p + i] = u + share * (end.y[p + i] - u);
        }
        (y, end.modes)
    }

    /// Takes back what lies beyond `t` in the last step: the front is at `t` again, reached by a step of its own, or
    /// by interpolation should that step fail. Contact forces stay those of the whole step: the impulses of a part
    /// over its length may be of any size. To be called with the problem that made the step.
    pub fn rewind<P>(&mut self, problem: &P, t: f64)
    where
        P: Unilateral<N, Modes: Default> + ?Sized,
    {
        let Memory { start, end, front, .. } = self.memory;
        if t >= front.t {
            return;
        }
        self.memory.statistics = self.memory.statistics_at(t);
        self.memory.statistics.steps -= 1;
        self.memory.crossings = 0;
        if t <= start.t {
            (self.memory.front, self.memory.end) = (start, start);
            return;
        }
        let made = attempt(problem, &start, t - start.t).unwrap_or_else(|_| {
            let (y, impulses) = self.state_at(problem, t);
            Made { y, impulses: Impulses { closed: start.modes.closed, ..impulses }, evaluations: 0 }
        });
        let impulses = Impulses { closed: made.impulses.closed, ..end.modes };
        self.commit(t, Made { impulses, ..made });
    }

    /// Makes `made` the step that ends at `t`.
    fn commit(&mut self, t: f64, made: Made<N>) {
        let Made { y, impulses, evaluations } = made;
        let before = self.memory.start.modes.closed;
        let changes = impulses.closed.iter().zip(before).filter(|(now, before)| **now != *before).count();
        let end = Front { t, y, rates: [0.0; N], modes: impulses, impact_end: t };
        self.memory.end = end;
        self.memory.front = end;
        self.memory.crossings = changes as u64;
        let statistics = &mut self.memory.statistics;
        statistics.steps += 1;
        statistics.evaluations += evaluations;
        statistics.events += changes as u64;
    }
}

/// The dead end that `y` lies beyond. Like impacts, dead ends are not located: a step may pass one.
fn dead_end<const N: usize, P>(problem: &P, t: f64, y: &[f64; N]) -> Option<usize>
where
    P: Problem<N, Modes: Default> + ?Sized,
{
    let mut guards = [Guard::default(); GUARDS];
    if problem.guard_count() == 0 || !problem.is_dead_end(0) {
        return None;
    }
    problem.guards(&P::Modes::default(), t, y, &mut guards);
    (0..problem.guard_count()).find(|&i| problem.is_dead_end(i) && guards[i].value < 0.0)
}
