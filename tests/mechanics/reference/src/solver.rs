//! The motion through time: extrapolated steps, cut where a contact leaves its branch.

use crate::beam::mode_count;
use crate::bodies::Bodies;
use crate::constraints::Constraints;
use crate::contact::{Contact, contacts};
use crate::coordinates::{CONTACTS, COORDINATES, Motion, RIGID};
use crate::crossing::Crossing;
use crate::extrapolation::{State, Trial, step};
use crate::loads::{Loads, loads};
use crate::mechanism::Mechanism;
use crate::phase::Phase;
use crate::signals::Inputs;
use crate::start::start;

/// [s] Short against the ~1e-5 s of an impact, so that the rough states inside a step show a touch.
const LONGEST_STEP: f64 = 2e-5;
/// [s] First step after a crossing: a force that starts as δ^1.5 has no Taylor series there.
pub(crate) const STEP_AFTER_CROSSING: f64 = 1e-8;
/// [s] A converged step this short cannot fail but by a fault of ours.
const SHORTEST_STEP: f64 = 1e-16;

/// One mechanism on its way.
pub struct Reference {
    pub(crate) mechanism: Mechanism,
    pub(crate) bodies: Bodies,
    pub(crate) constraints: Constraints,
    pub(crate) contacts: [Option<Contact>; CONTACTS],
    pub(crate) phases: [Phase; CONTACTS],
    pub(crate) motion: Motion,
    pub(crate) time: f64,
    /// Inputs at `input_time` and their rates.
    inputs: (Inputs, Inputs),
    input_time: f64,
    tolerance: State,
    pub(crate) step: f64,
    /// [J] At the start.
    pub(crate) energy_start: f64,
    pub(crate) crossings: Vec<Crossing>,
    /// [s] The time before the last that was moved to.
    pub(crate) interval_start: f64,
}

impl Reference {
    /// At the start position, under constant inputs. `tolerance` bounds each step's error: 1e-3 m
    /// and 1e-2 rad times it in position, 1 m/s and 10 rad/s times it in velocity, a tenth of that
    /// in the rod's modes.
    pub fn start(mechanism: &Mechanism, time: f64, inputs: Inputs, tolerance: f64) -> Self {
        // Products of four shapes have up to 4·modes half waves. From the points where the sum meets
        // them at all, some more bring it to round-off.
        let points = 14 + 3 * mode_count(&mechanism.rod.flexible);
        Self::start_with(mechanism, time, inputs, tolerance, points)
    }

    /// With as many quadrature `points` along the rod.
    pub fn start_with(mechanism: &Mechanism, time: f64, inputs: Inputs, tolerance: f64, points: usize) -> Self {
        let bodies = Bodies::new(mechanism, points);
        let contacts = contacts(mechanism, &bodies);
        let motion = start(mechanism);
        let at_start = |contact: &Option<Contact>| match contact {
            Some(contact) => Phase::at_start(contact, &motion),
            None => Phase::open(),
        };
        let mut reference = Self {
            constraints: Constraints::new(mechanism, time),
            mechanism: mechanism.clone(),
            bodies,
            phases: contacts.each_ref().map(at_start),
            tolerance: tolerance * scales(&contacts),
            contacts,
            motion,
            time,
            inputs: (inputs, Inputs::default()),
            input_time: time,
            step: STEP_AFTER_CROSSING,
            energy_start: 0.0,
            crossings: Vec::new(),
            interval_start: time,
        };
        reference.energy_start = reference.energy();
        reference
    }

    /// From now on u(t) = `inputs` + `rates`·(t − now).
    pub fn set_inputs(&mut self, inputs: Inputs, rates: Inputs) {
        (self.inputs, self.input_time) = ((inputs, rates), self.time);
    }

    /// Openings and closings so far.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// u(t).
    pub fn inputs_at(&self, time: f64) -> Inputs {
        let (value, rate) = &self.inputs;
        let since = time - self.input_time;
        Inputs {
            crank_torque: value.crank_torque + rate.crank_torque * since,
            slider_load: value.slider_load + rate.slider_load * since,
        }
    }

    pub(crate) fn loads(&self, time: f64, motion: &Motion) -> Loads {
        loads(&self.mechanism, &self.bodies, &self.contacts, &self.phases, self.inputs_at(time), motion)
    }

    /// Moves to `end` exactly.
    pub fn advance_to(&mut self, end: f64) {
        self.interval_start = self.time;
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

    pub(crate) fn shorten(&mut self, length: f64) {
        assert!(length > SHORTEST_STEP, "no step converges at t = {}", self.time);
        self.step = length;
    }

    pub(crate) fn attempt(&self, length: f64) -> Option<Trial> {
        let rate = |time: f64, state: &State| {
            let motion = motion(state);
            let loads = self.loads(time, &motion);
            let solution = self.constraints.accelerate(&self.bodies, time, &motion, &loads.generalized);
            let account = self.powers(time, &motion, &loads, &solution);
            stack(&Motion { q: motion.v, v: solution.acceleration, bristles: loads.bristle_rates, account })
        };
        step(&rate, self.time, &stack(&self.motion), length, &self.tolerance)
    }

    pub(crate) fn after(&self, change: &State) -> Motion {
        let (now, change) = (&self.motion, motion(change));
        Motion {
            q: now.q + change.q,
            v: now.v + change.v,
            bristles: now.bristles + change.bristles,
            account: now.account + change.account,
        }
    }

    pub(crate) fn accept(&mut self, trial: &Trial, time: f64) {
        self.motion = self.constraints.project(&self.bodies, time, self.after(&trial.change));
        self.time = time;
    }
}

/// What the tolerance is of, for each component of the state.
fn scales(contacts: &[Option<Contact>; CONTACTS]) -> State {
    let mut scales = Motion::at_rest();
    for coordinate in 0..COORDINATES {
        (scales.q[coordinate], scales.v[coordinate]) = match (coordinate < RIGID, coordinate % 3 == 2) {
            (true, false) => (1e-3, 1.0),
            (true, true) => (1e-2, 10.0),
            (false, _) => (1e-4, 0.1),
        };
    }
    for (k, contact) in contacts.iter().enumerate() {
        // A bristle of 1/σ0 is friction as great as the normal force.
        scales.bristles[k] = contact.as_ref().map_or(1.0, |contact| 1.0 / contact.laws.friction.sigma0);
    }
    // [J]
    scales.account.fill(1.0);
    stack(&scales)
}

fn motion(state: &State) -> Motion {
    Motion {
        q: state.fixed_rows::<COORDINATES>(0).into_owned(),
        v: state.fixed_rows::<COORDINATES>(COORDINATES).into_owned(),
        bristles: state.fixed_rows::<CONTACTS>(2 * COORDINATES).into_owned(),
        account: state.fixed_rows::<6>(2 * COORDINATES + CONTACTS).into_owned(),
    }
}

fn stack(motion: &Motion) -> State {
    let mut state = State::zeros();
    state.fixed_rows_mut::<COORDINATES>(0).copy_from(&motion.q);
    state.fixed_rows_mut::<COORDINATES>(COORDINATES).copy_from(&motion.v);
    state.fixed_rows_mut::<CONTACTS>(2 * COORDINATES).copy_from(&motion.bristles);
    state.fixed_rows_mut::<6>(2 * COORDINATES + CONTACTS).copy_from(&motion.account);
    state
}
