//! Where a contact leaves its branch: found between the rough states inside a step, located by
//! steps from the same start.

use crate::contact::{Contact, Touch};
use crate::coordinates::{CONTACTS, Motion};
use crate::extrapolation::{State, Trial};
use crate::mechanism::Surface;
use crate::phase::{CONDITIONS, Condition};
use crate::solver::{Reference, STEP_AFTER_CROSSING};

/// A contact that opened or closed.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// [s]
    pub time: f64,
    /// A, B, C, then the corners.
    pub contact: usize,
    /// It closed; else it opened.
    pub closed: bool,
    /// The whole contact closed: for a face the first of its corners.
    pub begins: bool,
    /// [m/s] δ̇ at the crossing; of a face the greater of its corners'.
    pub approach: f64,
    /// [m/s] δ̇ at the crossing.
    pub rate: f64,
    /// [m] What is left of the gap there.
    pub gap: f64,
}

/// Which contact left its branch, and how.
type Departure = (usize, Condition);

/// Where in a step conditions are first seen not to hold.
pub(crate) struct Departed {
    /// Share of the step at which all still held.
    held: f64,
    /// Share of the step at which these did not.
    share: f64,
    departures: Vec<Departure>,
}

impl Reference {
    fn touch(&self, contact: usize, motion: &Motion) -> Option<(&Contact, Touch)> {
        self.contacts[contact].as_ref().map(|c| (c, c.touch(motion, &self.phases[contact])))
    }

    fn margin(&self, (contact, condition): Departure, motion: &Motion) -> Option<f64> {
        let (pair, touch) = self.touch(contact, motion)?;
        self.phases[contact].margin(condition, &pair.laws, &touch)
    }

    /// Conditions that do not hold after `change`.
    fn departures(&self, change: &State) -> Vec<Departure> {
        let motion = self.after(change);
        (0..CONTACTS)
            .flat_map(|contact| CONDITIONS.map(|condition| (contact, condition)))
            .filter(|&departure| self.margin(departure, &motion).is_some_and(|margin| margin < 0.0))
            .collect()
    }

    /// Where in the step some conditions first do not hold.
    pub(crate) fn first_departures(&self, trial: &Trial) -> Option<Departed> {
        let inside = &trial.samples[..trial.samples.len() - 1];
        let end = (1.0, trial.change);
        let mut held = 0.0;
        for (share, change) in inside.iter().chain([&end]) {
            let departures = self.departures(change);
            if !departures.is_empty() {
                return Some(Departed { held, share: *share, departures });
            }
            held = *share;
        }
        None
    }

    /// Steps to where the first condition fails, and goes over to the branch beyond.
    pub(crate) fn cross(&mut self, length: f64, departed: &Departed) {
        let (low, high) = (departed.held * length, departed.share * length);
        let located: Option<Vec<(f64, Departure)>> = departed
            .departures
            .iter()
            .map(|&departure| self.locate(departure, low, high).map(|at| (at, departure)))
            .collect();
        let first = located.and_then(|all| all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)));
        let step = first.and_then(|(at, departure)| self.attempt(at).map(|trial| (at, departure, trial)));
        let Some((at, departure, trial)) = step else {
            self.shorten(high / 2.0);
            return;
        };
        self.accept(&trial, self.time + at);
        self.leave(departure);
    }

    fn leave(&mut self, (contact, condition): Departure) {
        let motion = self.motion;
        let Some((pair, touch)) = self.touch(contact, &motion) else { return };
        let before = self.phases[contact];
        let beyond = before.beyond(condition, pair, &motion);
        self.phases[contact] = beyond;
        self.step = STEP_AFTER_CROSSING;
        if !beyond.closed() {
            self.motion.bristles[contact] = 0.0;
        }
        let mut begins = !before.closed() && beyond.closed();
        for corner in (0..2).filter(|&corner| beyond.inside[corner] != before.inside[corner]) {
            self.crossings.push(Crossing {
                time: self.time,
                contact: self.named(contact, corner),
                closed: beyond.inside[corner],
                begins: std::mem::take(&mut begins),
                approach: touch.rates[0].max(touch.rates[1]),
                rate: touch.rates[corner],
                gap: -touch.depths[corner],
            });
        }
    }

    /// A, B, C, then the corners, those of faces too.
    fn named(&self, contact: usize, corner: usize) -> usize {
        match self.mechanism.joint.t.surface {
            Surface::Foundation if contact >= 3 => 3 + 2 * (contact - 3) + corner,
            _ => contact,
        }
    }

    /// The step length between `low` and `high` at which the margin of `departure` is 0: regula
    /// falsi of Illinois, each trial a step from the same start.
    fn locate(&self, departure: Departure, mut low: f64, mut high: f64) -> Option<f64> {
        let margin_at = |length: f64| -> Option<f64> {
            let trial = self.attempt(length)?;
            self.margin(departure, &self.after(&trial.change))
        };
        let start = self.margin(departure, &self.motion)?;
        let mut above = if low > 0.0 { margin_at(low)? } else { start };
        let mut below = margin_at(high)?;
        // A branch just entered may miss its own bound by round-off.
        if above <= 0.0 && start <= 0.0 {
            return Some(0.0);
        }
        // Rough states judge rough.
        if above <= 0.0 || below >= 0.0 {
            return None;
        }
        let mut kept = Kept::Neither;
        for _ in 0..100 {
            let guess = low + (high - low) * above / (above - below);
            // Time resolves 1e-17 s near 0.1 s.
            if high - low <= 1e-17 || guess <= low || guess >= high {
                break;
            }
            let margin = margin_at(guess)?;
            if margin == 0.0 {
                return Some(guess);
            }
            // An end that is kept twice counts half.
            if margin > 0.0 {
                (low, above) = (guess, margin);
                below *= if kept == Kept::High { 0.5 } else { 1.0 };
                kept = Kept::High;
            } else {
                (high, below) = (guess, margin);
                above *= if kept == Kept::Low { 0.5 } else { 1.0 };
                kept = Kept::Low;
            }
        }
        Some(high)
    }
}

/// The end of the bracket that the last guess left in place.
#[derive(PartialEq)]
enum Kept {
    Neither,
    Low,
    High,
}
