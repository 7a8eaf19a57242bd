//! One mechanism under one method.

use super::Size;
use super::derivatives::{sensitivity, slopes};
use super::equations::Linearization;
use super::phase::{Phase, PhaseScales};
use super::record;
use super::snapshot::{Reader, Snapshot};
use super::system::{Bare, Equations, write};
use crate::integrator::{Effort, Extent, Front, IntegrationError, Integrator, Jacobian, Method, Settings, Statistics};
use crate::model::contact::ContactMode;
use crate::model::drive::InputSignal;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::scales::Scale;
use crate::model::signals::{Inputs, Outputs, SolverOutputs};
use crate::model::start::StartPose;
use crate::model::state::Contacts;
use crate::scene::{Scene, Solver};
use std::hint::black_box;

/// A mechanism in motion, whatever its size.
pub trait Motion: Send {
    /// Steps until `t` lies within the last step.
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError>;
    /// Steps until `t` lies within the last step, or to an event after `after`, and tells when that was.
    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError>;
    /// The point of phase space at `t` in the last step.
    fn phase(&mut self, t: f64) -> Phase;
    /// Starts anew from such a point.
    fn place(&mut self, phase: &Phase);
    /// What size of difference is noticeable in a point of phase space.
    fn phase_scales(&self) -> PhaseScales;
    /// Inputs from the communication point `signal.at` on.
    fn set_signal(&mut self, signal: InputSignal);
    /// Outputs at `t` in the last step.
    fn outputs(&mut self, t: f64) -> Outputs;
    /// Their time derivatives.
    fn output_rates(&mut self, t: f64) -> Outputs;
    /// Their derivatives with respect to the inputs, along `seed`.
    fn output_sensitivity(&mut self, t: f64, seed: Inputs) -> Outputs;
    /// How large it is.
    fn size(&self) -> Size;
    /// Evaluates the right-hand side where the next step starts.
    fn evaluate(&self, times: usize);
    /// Its equations, from where the next step starts.
    fn equations(self: Box<Self>) -> Box<dyn Equations>;
    /// Evaluates its derivatives there.
    fn differentiate(&self, times: usize);
    /// Time and states there.
    fn front(&self) -> (f64, Vec<f64>);
    /// Rates of the right-hand side that holds there.
    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64>;
    /// The same, with derivatives.
    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization;
    /// Appends all that it remembers.
    fn save(&self, snapshot: &mut Snapshot);
    /// Takes back what `save` appended of a run at `time` [s]; `None` if it does not fit.
    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()>;
}

/// A mechanism of `N` states under the method `M`.
pub struct Run<const N: usize, M: Method> {
    plant: Box<dyn Plant<N>>,
    integrator: Integrator<N, Contacts, M>,
    settings: Settings,
    observer: Observer,
    /// [m/s] A noticeable difference of approach speeds.
    approach_scale: f64,
}

/// Where the scene sets no bound: seconds of computing for a communication step that leads nowhere, and several times
/// what any shipped scene needs.
const EFFORT: Effort = Effort { base: 20_000_000, per_second: 50_000_000 };

impl<const N: usize, M: Method> Run<N, M> {
    /// Starts `plant` at `time` from `pose`.
    pub fn start(scene: &Scene, time: f64, pose: &StartPose, plant: Box<dyn Plant<N>>) -> Self {
        let settings = settings(scene);
        let y = plant.start(pose);
        let contacts = plant.start_contacts(time, &y);
        let integrator = Integrator::start(plant.as_ref(), settings, time, y, contacts);
        let Scale { length, frequency, .. } = Scale::of(scene);
        Self { plant, integrator, settings, observer: Observer::new(scene), approach_scale: length * frequency }
    }

    fn observe(&self, contacts: &Contacts, t: f64, y: &[f64; N]) -> Outputs {
        let instant = self.plant.instant(contacts, t, y);
        let penetration = self.plant.penetration(&instant.pose);
        let torque = self.plant.signal().at(t).crank_torque;
        let mut outputs = self.observer.outputs(&instant, contacts, &penetration, torque);
        outputs.energy = self.plant.energies(contacts, &instant, y);
        outputs
    }

    /// Outputs under other inputs, the state held.
    fn observe_under(&mut self, t: f64, inputs: Inputs) -> Outputs {
        let signal = *self.plant.signal();
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        self.plant.set_signal(InputSignal { at: t, value: inputs, rate: Inputs::default() });
        let outputs = self.observe(&contacts, t, &y);
        self.plant.set_signal(signal);
        outputs
    }
}

impl<const N: usize, M: Method> Motion for Run<N, M> {
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError> {
        self.integrator.advance(self.plant.as_ref(), t)
    }

    fn advance_to_event(&mut self, after: f64, t: f64) -> Result<Option<f64>, IntegrationError> {
        self.integrator.advance_to_event(self.plant.as_ref(), after, t)
    }

    fn phase(&mut self, t: f64) -> Phase {
        self.integrator.rewind(self.plant.as_ref(), t);
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let weighed = Extent::of(self.plant.as_ref()).weighed;
        let approach = contacts.iter().map(|mode| Some(mode.approach).filter(|_| mode.closed)).collect();
        Phase { time: t, states: y[..weighed].to_vec(), approach }
    }

    fn place(&mut self, phase: &Phase) {
        let (mut y, mut contacts) = self.integrator.state_at(self.plant.as_ref(), phase.time);
        write(&phase.states, &mut y);
        for (mode, approach) in contacts.iter_mut().zip(&phase.approach) {
            *mode = approach.map_or(ContactMode::default(), |approach| ContactMode::closing(approach, approach));
        }
        self.integrator.place(self.plant.as_ref(), phase.time, y, contacts);
    }

    fn phase_scales(&self) -> PhaseScales {
        let weighed = Extent::of(self.plant.as_ref()).weighed;
        PhaseScales { states: self.plant.scales()[..weighed].to_vec(), approach: self.approach_scale }
    }

    fn set_signal(&mut self, signal: InputSignal) {
        if signal.continues(self.plant.signal()) {
            return;
        }
        self.integrator.rewind(self.plant.as_ref(), signal.at);
        self.plant.set_signal(signal);
        self.integrator.refresh(self.plant.as_ref());
    }

    fn outputs(&mut self, t: f64) -> Outputs {
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let mut outputs = self.observe(&contacts, t, &y);
        outputs.solver = solver_outputs(self.integrator.memory().statistics_at(t));
        outputs
    }

    fn output_rates(&mut self, t: f64) -> Outputs {
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let mut rates = [0.0; N];
        self.plant.rates(&contacts, t, &y, &mut rates);
        let mut slopes = slopes(self.plant.as_ref(), t, &y, &rates, |t, y| self.observe(&contacts, t, y));
        self.observer.set_known_rates(&self.plant.instant(&contacts, t, &y), &mut slopes);
        slopes
    }

    fn output_sensitivity(&mut self, t: f64, seed: Inputs) -> Outputs {
        sensitivity(seed, |inputs| self.observe_under(t, inputs))
    }

    fn size(&self) -> Size {
        let Extent { positions, states, .. } = Extent::of(self.plant.as_ref());
        Size { degrees_of_freedom: positions, states, event_functions: self.plant.guard_count() }
    }

    fn evaluate(&self, times: usize) {
        let Front { t, y, modes, .. } = &self.integrator.memory().front;
        let mut rates = [0.0; N];
        for _ in 0..times {
            self.plant.rates(black_box(modes), *t, black_box(y), &mut rates);
            black_box(&rates);
        }
    }

    fn equations(self: Box<Self>) -> Box<dyn Equations> {
        let start = self.integrator.memory().front;
        Box::new(Bare::new(self.plant, self.observer, start))
    }

    fn differentiate(&self, times: usize) {
        let Front { t, y, modes, .. } = &self.integrator.memory().front;
        let mut jacobian = Jacobian::ZERO;
        for _ in 0..times {
            self.plant.jacobian(black_box(modes), *t, black_box(y), &mut jacobian);
            black_box(&jacobian);
        }
    }

    fn front(&self) -> (f64, Vec<f64>) {
        let Front { t, y, .. } = &self.integrator.memory().front;
        (*t, y[..Extent::of(self.plant.as_ref()).states].to_vec())
    }

    fn rates_at(&self, time: f64, states: &[f64]) -> Vec<f64> {
        let mut rates = [0.0; N];
        self.plant.rates(&self.integrator.memory().front.modes, time, &filled(states), &mut rates);
        rates[..Extent::of(self.plant.as_ref()).states].to_vec()
    }

    fn linearization_at(&self, time: f64, states: &[f64]) -> Linearization {
        let modes = &self.integrator.memory().front.modes;
        linearization(self.plant.as_ref(), modes, time, &filled(states))
    }

    fn save(&self, snapshot: &mut Snapshot) {
        record::save(self.plant.as_ref(), self.integrator.memory(), snapshot);
    }

    fn load(&mut self, time: f64, reader: &mut Reader<'_>) -> Option<()> {
        let memory = record::load(self.plant.as_mut(), time, reader)?;
        self.integrator = Integrator::resume(self.plant.as_ref(), self.settings, memory);
        Some(())
    }
}

/// What a scene asks of its integrator.
pub fn settings(scene: &Scene) -> Settings {
    let Solver { tolerance, step, max_evaluations, .. } = scene.solver;
    let effort = match u64::try_from(max_evaluations) {
        Ok(base @ 1..) => Effort { base, per_second: 0 },
        _ => EFFORT,
    };
    Settings { tolerance, fixed_step: step, effort }
}

/// Counters as outputs.
pub fn solver_outputs(statistics: Statistics) -> SolverOutputs {
    let Statistics { steps, rejected, evaluations, events } = statistics;
    let count = |n: u64| i32::try_from(n).unwrap_or(i32::MAX);
    SolverOutputs {
        steps: count(steps),
        rejected: count(rejected),
        evaluations: count(evaluations),
        events: count(events),
    }
}

/// The equations of motion of `plant` near `y` and `time` [s].
pub fn linearization<const N: usize>(
    plant: &dyn Plant<N>,
    contacts: &Contacts,
    time: f64,
    y: &[f64; N],
) -> Linearization {
    let Extent { positions, states: count, .. } = Extent::of(plant);
    let (mut rates, mut jacobian) = ([0.0; N], Jacobian::ZERO);
    plant.rates(contacts, time, y, &mut rates);
    plant.jacobian(contacts, time, y, &mut jacobian);
    Linearization {
        time,
        states: y[..count].to_vec(),
        positions,
        rates: rates[..count].to_vec(),
        by_state: jacobian.state[..count].iter().map(|row| row[..count].to_vec()).collect(),
        by_time: jacobian.time[..count].to_vec(),
    }
}

/// A list in an array with room, or as much of it as has room.
#[inline(always)]
pub fn filled<const N: usize>(list: &[f64]) -> [f64; N] {
    let mut array = [0.0; N];
    for (place, value) in array.iter_mut().zip(list) {
        *place = *value;
    }
    array
}
