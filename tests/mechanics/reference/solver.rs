//! The motion through time: extrapolated steps, cut where a contact leaves its branch.

use super::bodies::{Bodies, Motion, Nine};
use super::constraints::Constraints;
use super::contact::{Contact, Touch, contacts};
use super::extrapolation::{State, Trial, step};
use super::loads::{Loads, loads};
use super::phase::{CONDITIONS, Condition, Phase};
use super::start::start;
use slidercrank::model::signals::Inputs;
use slidercrank::scene::Scene;

/// [s] Short against the ~1e-5 s of an impact, so that the rough states inside a step show a touch.
const LONGEST_STEP: f64 = 2e-5;
/// [s] First step after a crossing: a force that starts as δ^1.5 has no Taylor series there.
const STEP_AFTER_CROSSING: f64 = 1e-8;
/// [s] A converged step this short cannot fail but by a fault of ours.
const SHORTEST_STEP: f64 = 1e-16;

/// A contact that opened or closed.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// [s]
    pub time: f64,
    /// A, B, C, then the corners.
    pub contact: usize,
    pub closed: bool,
    /// [m/s] δ̇ at the crossing.
    pub rate: f64,
    /// [m] What is left of the gap there.
    pub gap: f64,
}

/// One mechanism on its way.
pub struct Reference {
    pub(super) scene: Scene,
    pub(super) bodies: Bodies,
    pub(super) constraints: Constraints,
    pub(super) contacts: [Option<Contact>; 7],
    pub(super) phases: [Phase; 7],
    pub(super) motion: Motion,
    pub(super) time: f64,
    /// Inputs at `input_time` and their rates.
    inputs: (Inputs, Inputs),
    input_time: f64,
    tolerance: State,
    step: f64,
    crossings: Vec<Crossing>,
}

/// Which contact left its branch, and how.
type Departure = (usize, Condition);

/// Where in a step conditions are first seen not to hold.
struct Departed {
    /// Share of the step at which all still held.
    held: f64,
    /// Share of the step at which these did not.
    share: f64,
    departures: Vec<Departure>,
}

impl Reference {
    /// At the start position, under constant inputs. `tolerance` bounds each step's error: 1e-3 m
    /// and 1e-2 rad times it in position, 1 m/s and 10 rad/s times it in velocity.
    pub fn start(scene: &Scene, time: f64, inputs: Inputs, tolerance: f64) -> Self {
        let bodies = Bodies::new(scene);
        let contacts = contacts(scene, &bodies);
        let motion = start(scene);
        let phases = [0, 1, 2, 3, 4, 5, 6].map(|k| match &contacts[k] {
            Some(contact) => Phase::at_start(&contact.laws, &contact.touch(&motion)),
            None => Phase::open(),
        });
        let scale = |coordinate: usize| match (coordinate < 9, coordinate % 3 == 2) {
            (true, false) => 1e-3,
            (true, true) => 1e-2,
            (false, false) => 1.0,
            (false, true) => 10.0,
        };
        Self {
            constraints: Constraints::new(scene, time),
            scene: scene.clone(),
            bodies,
            contacts,
            phases,
            motion,
            time,
            inputs: (inputs, Inputs::default()),
            input_time: time,
            tolerance: State::from_fn(|row, _| tolerance * scale(row)),
            step: STEP_AFTER_CROSSING,
            crossings: Vec::new(),
        }
    }

    /// From now on u(t) = `inputs` + `rates`·(t − now).
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        (self.inputs, self.input_time) = ((inputs, rates), self.time);
    }

    /// Openings and closings so far.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    pub fn inputs_at(&self, time: f64) -> Inputs {
        let (value, rate) = &self.inputs;
        let since = time - self.input_time;
        Inputs {
            crank_torque: value.crank_torque + rate.crank_torque * since,
            slider_load: value.slider_load + rate.slider_load * since,
        }
    }

    pub(super) fn loads(&self, time: f64, motion: &Motion) -> Loads {
        loads(&self.scene, &self.bodies, &self.contacts, &self.phases, self.inputs_at(time), motion)
    }

    /// Moves to `end` exactly.
    pub fn advance_to(&mut self, end: f64) {
        while self.time < end {
            let left = end - self.time;
            // No sliver is left for a last step.
            let length = if self.step.min(LONGEST_STEP) > 0.999 * left { left } else { self.step.min(LONGEST_STEP) };
            let Some(trial) = self.attempt(length) else {
                self.shorten(length / 2.0);
                continue;
            };
            match self.first_departures(&trial) {
                None => {
                    self.step = length * trial.growth();
                    self.accept(&trial, if length == left { end } else { self.time + length });
                }
                Some(departed) => self.cross(length, &departed),
            }
        }
    }

    fn shorten(&mut self, length: f64) {
        assert!(length > SHORTEST_STEP, "no step converges at t = {}", self.time);
        self.step = length;
    }

    fn attempt(&self, length: f64) -> Option<Trial> {
        let rate = |time: f64, state: &State| {
            let motion = motion(state);
            let loads = self.loads(time, &motion);
            let solution = self.constraints.accelerate(&self.bodies, time, &motion, &loads.generalized);
            stack(&motion.v, &solution.acceleration)
        };
        step(&rate, self.time, &stack(&self.motion.q, &self.motion.v), length, &self.tolerance)
    }

    fn after(&self, change: &State) -> Motion {
        let change = motion(change);
        Motion { q: self.motion.q + change.q, v: self.motion.v + change.v }
    }

    fn accept(&mut self, trial: &Trial, time: f64) {
        self.motion = self.constraints.project(&self.bodies, time, self.after(&trial.change));
        self.time = time;
    }

    fn touch(&self, contact: usize, motion: &Motion) -> Option<(&Contact, Touch)> {
        self.contacts[contact].as_ref().map(|c| (c, c.touch(motion)))
    }

    fn margin(&self, (contact, condition): Departure, motion: &Motion) -> Option<f64> {
        let (pair, touch) = self.touch(contact, motion)?;
        self.phases[contact].margin(condition, &pair.laws, &touch)
    }

    /// Conditions that do not hold after `change`.
    fn departures(&self, change: &State) -> Vec<Departure> {
        let motion = self.after(change);
        (0..7)
            .flat_map(|contact| CONDITIONS.map(|condition| (contact, condition)))
            .filter(|&departure| self.margin(departure, &motion).is_some_and(|margin| margin < 0.0))
            .collect()
    }

    /// Where in the step some conditions first do not hold.
    fn first_departures(&self, trial: &Trial) -> Option<Departed> {
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
    fn cross(&mut self, length: f64, departed: &Departed) {
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
        let beyond = self.phases[contact].beyond(condition, &pair.laws, &touch);
        self.phases[contact] = beyond;
        self.step = STEP_AFTER_CROSSING;
        if condition == Condition::Gap {
            let Touch { rate, penetration, .. } = touch;
            self.crossings.push(Crossing { time: self.time, contact, closed: beyond.closed, rate, gap: -penetration });
        }
    }

    /// The step length between `low` and `high` at which the margin of `departure` is 0: regula
    /// falsi of Illinois, each trial a step from the same start.
    fn locate(&self, departure: Departure, mut low: f64, mut high: f64) -> Option<f64> {
        let margin_at = |length: f64| -> Option<f64> {
            let trial = self.attempt(length)?;
            self.margin(departure, &self.after(&trial.change))
        };
        let mut above = if low > 0.0 { margin_at(low)? } else { self.margin(departure, &self.motion)? };
        let mut below = margin_at(high)?;
        // A branch just entered may miss its own bound by round-off.
        if above <= 0.0 && low == 0.0 {
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

fn motion(state: &State) -> Motion {
    Motion { q: state.fixed_rows::<9>(0).into_owned(), v: state.fixed_rows::<9>(9).into_owned() }
}

fn stack(q: &Nine, v: &Nine) -> State {
    let mut state = State::zeros();
    state.fixed_rows_mut::<9>(0).copy_from(q);
    state.fixed_rows_mut::<9>(9).copy_from(v);
    state
}
