//! How long a step is: as its error and its kinks allow.

use super::controller;
use super::error::IntegrationError;
use super::kink;
use super::memory::Memory;
use super::method::{Character, Method};
use super::problem::Problem;
use super::regime::Manner;
use super::step::Integrator;

/// This share of the tolerance is for one step: the errors of many add up. Those in stiff motion fade.
const SHARE: f64 = 0.4;
/// The flight after an impact, and every impact after that, make its errors larger than those of a contact that stays:
/// only this share of what else is tolerable is for them.
const IMPACT_SHARE: f64 = 0.1;
/// A step that is predicted from the last is not made longer for an error above this: one that is as long is predicted with
/// less work, and can begin before the error is known.
const STEADY: f64 = 1e-2;
/// Most times that one step is cut short at a kink.
const CUTS: usize = 6;
/// After so many steps in a row that were cut, the motion creeps along a kink: it is passed over as any error is, until a
/// step does not fail.
pub(super) const CREEPING: u32 = 8;
/// After so many failed attempts at one step another of the method's manners takes over, if there is one: long before a step
/// comes down to a rounding of time.
const TOO_MANY: usize = 8;
/// A failed attempt with a larger error than this predicts nothing. Its accelerations are those of states that no motion
/// comes to, and states predicted from them can be worse: velocities enter accelerations as squares, so that rounds of
/// correction that begin far off run away, however short the step is. Accelerations that stay as they are at the start
/// lead to an attempt that is as good as it is short.
const PREDICTABLE: f64 = 1e4;
/// [roundings of time] No kink makes a step shorter than this.
const SHORTEST_CUT: f64 = 1e3;

impl<const N: usize, D: Copy, M: Method> Integrator<N, D, M> {
    /// The share of the next step at which a kink lies, where one is to be looked for.
    pub(super) fn foreseen_kink<P>(&self, problem: &P) -> Option<f64>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let Memory { start, front, step, cuts, crossings, .. } = &self.memory;
        let goes_on = (1..CREEPING).contains(cuts) && *crossings == 0 && front.t > start.t;
        goes_on.then(|| kink::foreseen(problem, start, front, step.min(problem.longest_step()))).flatten()
    }

    /// Attempts until the error is tolerable, and tells how long that step is. A step that fails time and again goes from one
    /// of the method's manners to the next; only where each of them has come down to a step that does not move time, there
    /// is none. A kink `foreseen` at a share of the step is where the first attempt ends.
    pub(super) fn accepted<P>(&mut self, problem: &P, foreseen: Option<f64>) -> Result<f64, IntegrationError>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let time = self.memory.start.t;
        // Forces that are gone may have left a step that no longer moves time.
        let least = time.next_up() - time;
        let first = if M::ADAPTIVE { self.memory.step.max(least) } else { self.settings.fixed_step };
        let own = self.memory.manner;
        let others = M::others(own);
        let mut shortest =
            match self.fitted(problem, first, foreseen, if others.is_empty() { usize::MAX } else { TOO_MANY }) {
                Ok(h) => return Ok(h),
                Err(shortest) => shortest,
            };
        let in_turn = others.iter().map(|other| (*other, first, TOO_MANY));
        let to_the_end = std::iter::once(&own).chain(others).map(|manner| (*manner, 0.0, usize::MAX));
        for (manner, wanted, failures) in in_turn.chain(to_the_end.filter(|_| !others.is_empty())) {
            self.memory.manner = manner;
            match self.fitted(problem, wanted.max(shortest), None, failures) {
                Ok(h) => {
                    self.memory.regime.hand_over(manner);
                    return Ok(h);
                }
                Err(reached) => shortest = shortest.min(reached),
            }
        }
        self.attempt(problem, shortest);
        let component = controller::worst_component(&self.made, problem);
        Err(IntegrationError::StepUnderflow { time, step: shortest, component })
    }

    /// Attempts a step that is as long as `wanted`, and shorter ones, until the error is tolerable: tells how long that step
    /// is, or, after so many `failures` or where time does not move, how long the next attempt would be. The end of an
    /// accepted step is looked at. One that fails because a kink lies in it ends at the kink, and the next is as long as this
    /// one should have been; so does one with a kink `foreseen` at that share.
    fn fitted<P>(&mut self, problem: &P, mut wanted: f64, foreseen: Option<f64>, failures: usize) -> Result<f64, f64>
    where
        P: Problem<N, Modes = D> + ?Sized,
    {
        let time = self.memory.start.t;
        let least = time.next_up() - time;
        let share = if self.memory.manner == Manner::Implicit { 1.0 } else { SHARE };
        let of_impact = if time < self.memory.start.impact_end { IMPACT_SHARE } else { 1.0 };
        let tolerance = of_impact * share * self.settings.tolerance;
        let (mut first, mut cuts, mut cut) = (None, 0, false);
        let creeping = self.memory.cuts >= CREEPING;
        let mut failed = None;
        if let Some(share) = foreseen.filter(|share| share * wanted > SHORTEST_CUT * least) {
            (first, cuts, cut) = (Some(wanted), 1, true);
            wanted = share * wanted.min(problem.longest_step());
        }
        for _ in 0..failures {
            // The step is what time really moves by: nothing drifts from its rounding.
            let h = time + wanted.min(problem.longest_step()) - time;
            if h <= 0.0 {
                break;
            }
            self.attempt(problem, h);
            let Character { error_power: full, predicts, .. } = M::character(self.memory.manner);
            let error = self.judged(problem, h, tolerance);
            if error <= 1.0 {
                let growth = || controller::growth(error, self.memory.last_error, full);
                self.memory.step = match first {
                    Some(first) if cut => first,
                    Some(_) => h * growth().min(1.0),
                    None if predicts && error > STEADY => wanted,
                    None => h * growth(),
                };
                self.memory.last_error = error.max(1e-4);
                self.memory.cuts = match (cut, failed) {
                    (true, _) => self.memory.cuts + 1,
                    (false, Some(_)) if creeping => CREEPING,
                    _ => 0,
                };
                return Ok(h);
            }
            if error < PREDICTABLE {
                // A shorter one goes over the same ground.
                self.predict_from_attempt(time + h);
            } else {
                self.memory.past.forget();
            }
            first.get_or_insert(h);
            self.memory.statistics.rejected += 1;
            let look = error.is_finite() && cuts < CUTS && !creeping;
            let kink =
                if look { kink::first(problem, &self.memory.start, &self.guards, h, &self.made.y) } else { None };
            // A kink that close is where the step starts.
            let kink = kink.filter(|share| share * h > SHORTEST_CUT * least);
            cut = kink.is_some();
            cuts += usize::from(cut);
            let power = failed.map_or(full, |before| controller::error_power([before, (h, error)], full));
            failed = Some((h, error));
            wanted = wanted.min(h) * kink.unwrap_or_else(|| controller::shrinkage(error, power));
        }
        Err(wanted)
    }

    /// The error of the attempted step of `h` over the tolerance; of one that is tolerable the end is looked at. One that is
    /// lost there is infinitely wrong, unless no shorter one is to be attempted.
    fn judged<P: Problem<N, Modes = D> + ?Sized>(&mut self, problem: &P, h: f64, tolerance: f64) -> f64 {
        if controller::lost_state(problem, &self.made.y).is_some() {
            return f64::INFINITY;
        }
        let error = controller::norm::<N, M, P>(&self.made, &self.memory.start.y, problem, tolerance);
        if error <= 1.0 {
            self.look_at_end_if_due(problem, self.memory.start.t + h);
            if M::ADAPTIVE && controller::lost_state(problem, &self.made.rates).is_some() {
                return f64::INFINITY;
            }
        }
        error
    }
}
