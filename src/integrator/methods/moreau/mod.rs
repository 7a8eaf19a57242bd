//! Moreau's midpoint rule: time stepping for rigid contacts, with Newton restitution and Coulomb friction (J. J.
//! Moreau, in Nonsmooth Mechanics and Applications, CISM 302, Springer 1988; M. Jean, Comput. Methods Appl. Mech. Eng.
//! 177 (1999) 235; for a slider-crank: P. Flores, R. Leine, C. Glocker, Multibody Syst. Dyn. 23 (2010) 165).
//!
//! A step of length h starts at (q_A, u_A) and ends at (q_E, u_E):
//!
//! ```text
//! A ──── q_M = q_A + (h/2)·u_A ────> M ──── q_E = q_M + (h/2)·u_E ────> E
//!                                    │
//!    M(q_M)·(u_E − u_A) = h·f + W_N·Λ_N + W_T·Λ_T
//!    ξ_N = γ_NE + e_N·γ_NA ≥ 0  ⟂  Λ_N ≥ 0,    −Λ_T ∈ μ·Λ_N·Sgn(γ_TE)    for all closed contacts
//! ```
//!
//! A contact is closed if its gap vanishes by the midpoint M. γ_N and γ_T are relative velocities of the contact
//! surfaces, Λ impulses, e_N restitution, μ friction. Impacts are not located: a step may contain several, and a
//! lasting contact is an impact in every step.
//!
//! Three terms are of second order in h here that are usually of first order. They arise because minimal coordinates
//! are curvilinear:
//! - Forces f that depend on velocity are evaluated half-way between u_A and u_E (known from a first pass), not at u_A.
//! - γ_A and γ_E are the relative velocities at the start and at the end of the step, not those of u_A and u_E at q_M.
//!   They differ by (h/2)·Ẇᵀu (taken from the step without contacts), which is as much as the relative velocities of a
//!   lasting contact. Hence a journal does not leave its bearing along the tangent, and chatter comes to rest.
//! - A contact is closed if gap + (h/2)·γ_A ≤ 0 at the start, for the same reason.
//!
//! The rule is of order 2 without contacts and in lasting contacts. Through an impact it is of order 1, because the
//! impact happens up to one step early or late.
//!
//! Penetration: an impact penetrates as far as the bodies approach in a step, h·|γ_NA|. In a lasting contact, every
//! step corrects a tenth of the penetration that exceeds h·|γ_N| of the step, by the shift of positions with the least
//! kinetic norm. The penetration that an impact leaves decays, and the rest is of order h². Contacts that separate are
//! not corrected, because that would add energy. A step that ends deeper in penetration than the clearance has lost the
//! contact, whose surfaces are curved or have another opposite, and is refused.
//!
//! Newton restitution with friction can add energy if an impact reverses the sliding and restitution is near 1 (T. R.
//! Kane, D. A. Levinson, Dynamics: Theory and Applications, McGraw-Hill 1985). Without friction and with equal
//! restitution in all contacts it never does.

mod attempt;
mod closed_contacts;
mod midpoint;

use crate::integrator::error::IntegrationError;
use crate::integrator::event_location::Search;
use crate::integrator::state::{SolverState, StepPoint};
use crate::integrator::step_control::Settings;
use crate::integrator::system::{EventFunctions, System};
use crate::integrator::unilateral::{Impulses, MAX_RIGID_CONTACT_STATES, Unilateral, padded};
use attempt::{AttemptedStep, attempt};

/// Time stepping by Moreau's midpoint rule with a fixed step.
pub struct Moreau<D> {
    settings: Settings,
    /// The discrete state of the system with every contact open.
    open: D,
    state: SolverState<Impulses>,
    /// A state within the last step.
    inside: Vec<f64>,
}

impl<D: Copy> Moreau<D> {
    /// Starts from the state `y` at `t`; `open` is the discrete state of the system with every contact open.
    pub fn start(settings: Settings, t: f64, y: &[f64], open: D) -> Self {
        assert!(
            y.len() <= MAX_RIGID_CONTACT_STATES,
            "a system with rigid contacts has at most MAX_RIGID_CONTACT_STATES states"
        );
        // The method does not use rates.
        let point = StepPoint::new(t, y, Impulses::none(t, y));
        let mut state = SolverState::new(&point, settings.fixed_step);
        state.last_error = 0.0;
        Self::resume(settings, state, open)
    }

    /// Resumes from a saved state.
    pub fn resume(settings: Settings, state: SolverState<Impulses>, open: D) -> Self {
        let inside = state.front().y.clone();
        Self { settings, open, state, inside }
    }

    /// The discrete state of the system with every contact open.
    pub fn open(&self) -> &D {
        &self.open
    }

    /// Replaces the discrete state with every contact open, from the next step on. The present time must be the front.
    pub fn set_open(&mut self, open: D) {
        self.open = open;
    }

    /// The solver's state: all that a later [`resume`](Self::resume) needs.
    pub fn state(&self) -> &SolverState<Impulses> {
        &self.state
    }

    /// Steps until `t` lies within the last step.
    ///
    /// # Errors
    /// See [`IntegrationError`]; the state at the error's time is intact.
    pub fn advance(&mut self, system: &dyn Unilateral<Discrete = D>, t: f64) -> Result<(), IntegrationError> {
        let longest = self.settings.fixed_step.min(system.longest_step());
        self.settings.effort.check(self.state.front().t, t, longest)?;
        self.march(system, t, |_| false)
    }

    /// Steps until `t` lies within the last step, or until a step that ends after `after` has closed or opened
    /// contacts. Returns the time [s] at which that step ended, if it did by `t`.
    ///
    /// # Errors
    /// As [`Moreau::advance`].
    pub fn advance_to_event(
        &mut self,
        system: &dyn Unilateral<Discrete = D>,
        after: f64,
        t: f64,
    ) -> Result<Option<f64>, IntegrationError> {
        let happened = |state: &SolverState<Impulses>| state.crossings > 0 && state.front().t > after;
        self.march(system, t, happened)?;
        Ok(Some(self.state.front().t).filter(|&event| happened(&self.state) && event <= t))
    }

    /// Restarts from the state `y` at `t`.
    pub fn place(&mut self, t: f64, y: &[f64]) {
        let statistics = self.state.statistics;
        *self = Self::start(self.settings, t, y, self.open);
        self.state.statistics = statistics;
    }

    /// Steps until `t` lies within the last step or `done` holds.
    fn march(
        &mut self,
        system: &dyn Unilateral<Discrete = D>,
        t: f64,
        done: impl Fn(&SolverState<Impulses>) -> bool,
    ) -> Result<(), IntegrationError> {
        let before = self.state.statistics.evaluations;
        let work_limit = self.settings.effort.over(t - self.state.front().t);
        while self.state.front().t < t && !done(&self.state) {
            let time = self.state.front().t;
            let evaluations = self.state.statistics.evaluations - before;
            if evaluations > work_limit {
                return Err(IntegrationError::TooMuchWork { time, evaluations });
            }
            // The step is the difference of two representable times, so that rounding does not accumulate.
            let step = self.settings.fixed_step;
            let end = time + step.min(system.longest_step());
            if end <= time {
                return Err(IntegrationError::StepUnderflow { time, step, component: 0 });
            }
            let made = attempt(system, self.open, self.state.front(), end - time)
                .map_err(|error| self.dead_end_ahead(system, end - time).unwrap_or(error))?;
            if let Some(event) = self.dead_end(system, end, &made.y[..self.inside.len()]) {
                return Err(IntegrationError::DeadEnd { time, event });
            }
            self.state.begin_step();
            self.commit(end, &made);
        }
        Ok(())
    }

    /// State at `t` in the last step and the impulses of the step. Velocities are interpolated linearly within a step,
    /// across impacts, too.
    pub fn state_at(&mut self, system: &dyn System<Discrete = D>, t: f64) -> (&[f64], Impulses) {
        let (start, end, front) = (self.state.start(), self.state.end(), self.state.front());
        if t >= front.t {
            return (&front.y, front.discrete);
        }
        interpolate([start.t, end.t], [&start.y, &end.y], system.layout().positions, t, &mut self.inside);
        (&self.inside, end.discrete)
    }

    /// The dead end at the front that the motion reaches within `h` [s] if it goes on as there. Behind it there is no motion.
    fn dead_end_ahead(&self, system: &dyn Unilateral<Discrete = D>, h: f64) -> Option<IntegrationError> {
        let (front, mut events) = (self.state.front(), EventFunctions::default());
        system.event_functions(&self.open, front.t, &front.y, &mut events);
        let is_ahead =
            |event: &usize| system.is_dead_end(*event) && events[*event].value + h * events[*event].rate < 0.0;
        let event = (0..system.event_count()).find(is_ahead)?;
        Some(IntegrationError::DeadEnd { time: front.t, event })
    }

    /// The dead end that the motion passes on its way from the front to the state `y` at `end`.
    fn dead_end(&self, system: &dyn Unilateral<Discrete = D>, end: f64, y: &[f64]) -> Option<usize> {
        if system.event_count() == 0 || !system.is_dead_end(0) {
            return None;
        }
        let (start, positions) = (self.state.front(), system.layout().positions);
        let h = end - start.t;
        let functions = |share: f64| {
            let (mut inside, mut events) = (padded(y), EventFunctions::default());
            let t = start.t + share * h;
            interpolate([start.t, end], [&start.y, y], positions, t, &mut inside[..y.len()]);
            system.event_functions(&self.open, t, &inside[..y.len()], &mut events);
            events
        };
        let (before, after) = (functions(0.0), functions(1.0));
        (0..system.event_count()).filter(|&event| system.is_dead_end(event)).find(|&event| {
            let search = Search { h, inside: &|share| functions(share)[event] };
            after[event].value < 0.0 || search.fall([before[event], after[event]], false).is_some()
        })
    }

    /// Shortens the last step so that it ends at `t`: by a new step, or by interpolation if that step fails. The
    /// contact forces remain those of the whole step, because the impulses of a short step divided by its length may be
    /// arbitrarily large.
    pub fn truncate(&mut self, system: &dyn Unilateral<Discrete = D>, t: f64) {
        let (start, end) = (self.state.start().t, self.state.end().discrete);
        if t >= self.state.front().t {
            return;
        }
        self.state.statistics = self.state.statistics_at(t);
        self.state.statistics.steps -= 1;
        self.state.crossings = 0;
        if t <= start {
            self.state.take_back();
            return;
        }
        let made = attempt(system, self.open, self.state.start(), t - start).unwrap_or_else(|_| {
            let closed = self.state.start().discrete.closed;
            let (y, impulses) = self.state_at(system, t);
            AttemptedStep { y: padded(y), impulses: Impulses { closed, ..impulses }, evaluations: 0 }
        });
        let impulses = Impulses { closed: made.impulses.closed, ..end };
        self.commit(t, &AttemptedStep { impulses, ..made });
    }

    /// Makes the step in `made`, which ends at `t`, the last step.
    fn commit(&mut self, t: f64, made: &AttemptedStep) {
        let AttemptedStep { y, impulses, evaluations } = made;
        let (start, end) = self.state.ends();
        let changes =
            impulses.closed.iter().zip(start.discrete.closed).filter(|(now, before)| **now != *before).count();
        end.y.copy_from_slice(&y[..self.inside.len()]);
        self.state.commit_with(t, *impulses, t);
        self.state.crossings = changes as u64;
        self.state.statistics.evaluations += evaluations;
        self.state.statistics.events += changes as u64;
    }
}

/// Writes the state at `t` between the states at both ends of a step: positions as parabolas that begin at the rates there, rates
/// as straight lines, the rest as it is at the end.
fn interpolate([start, end]: [f64; 2], [from, to]: [&[f64]; 2], positions: usize, t: f64, y: &mut [f64]) {
    let (span, passed) = (end - start, t - start);
    let share = passed / span;
    y.copy_from_slice(to);
    for i in 0..positions {
        let (q, u) = (from[i], from[positions + i]);
        y[i] = q + passed * u + share * share * (to[i] - q - span * u);
        y[positions + i] = u + share * (to[positions + i] - u);
    }
}
