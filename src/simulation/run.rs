//! One mechanism under one method.

use super::Size;
use super::equations::Linearization;
use super::snapshot::{Reader, Snapshot};
use super::system::{Bare, Equations};
use crate::integrator::{Extent, Front, IntegrationError, Integrator, Jacobian, Memory, Method, Settings, Statistics};
use crate::model::contact::ContactMode;
use crate::model::drive::InputSignal;
use crate::model::outputs::Observer;
use crate::model::plant::Plant;
use crate::model::signals::{Inputs, Outputs, SolverOutputs};
use crate::model::start::StartPose;
use crate::model::state::{CONTACTS, Contacts};
use crate::scene::Scene;
use std::hint::black_box;

/// A mechanism in motion, whatever its size.
pub trait Motion: Send {
    /// Steps until `t` lies within the last step.
    fn advance(&mut self, t: f64) -> Result<(), IntegrationError>;
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
    /// Takes back what `save` appended; `None` if it does not fit.
    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()>;
}

/// A mechanism of `N` states under the method `M`.
pub struct Run<const N: usize, M: Method> {
    plant: Box<dyn Plant<N>>,
    integrator: Integrator<N, Contacts, M>,
    settings: Settings,
    observer: Observer,
}

/// [s] Half the interval over which an output's derivative is taken.
const DIFFERENCE: f64 = 1e-8;

impl<const N: usize, M: Method> Run<N, M> {
    /// Starts `plant` at `time` from `pose`.
    pub fn start(scene: &Scene, time: f64, pose: &StartPose, plant: Box<dyn Plant<N>>) -> Self {
        let settings = Settings { tolerance: scene.solver.tolerance, fixed_step: scene.solver.step };
        let y = plant.start(pose);
        let contacts = plant.start_contacts(time, &y);
        let integrator = Integrator::start(plant.as_ref(), settings, time, y, contacts);
        Self { plant, integrator, settings, observer: Observer::new(scene) }
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
        let Statistics { steps, rejected, evaluations, events } = self.integrator.memory().statistics_at(t);
        let count = |n: u64| i32::try_from(n).unwrap_or(i32::MAX);
        outputs.solver = SolverOutputs {
            steps: count(steps),
            rejected: count(rejected),
            evaluations: count(evaluations),
            events: count(events),
        };
        outputs
    }

    fn output_rates(&mut self, t: f64) -> Outputs {
        let (y, contacts) = self.integrator.state_at(self.plant.as_ref(), t);
        let mut rates = [0.0; N];
        self.plant.rates(&contacts, t, &y, &mut rates);
        let along = |shift: f64| std::array::from_fn(|i| y[i] + shift * rates[i]);
        let (before, after) = (t - DIFFERENCE, t + DIFFERENCE);
        let first = self.observe(&contacts, before, &along(before - t));
        let second = self.observe(&contacts, after, &along(after - t));
        let mut slopes = second.combined(&first, |second, first| (second - first) / (after - before));
        self.observer.set_known_rates(&self.plant.instant(&contacts, t, &y), &mut slopes);
        slopes
    }

    fn output_sensitivity(&mut self, t: f64, seed: Inputs) -> Outputs {
        // Outputs are affine in the inputs: any difference is the derivative.
        let one = self.observe_under(t, seed);
        let other = self.observe_under(t, Inputs { crank_torque: -seed.crank_torque, slider_load: -seed.slider_load });
        one.combined(&other, |one, other| 0.5 * (one - other))
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
        let Extent { positions, states: count, .. } = Extent::of(self.plant.as_ref());
        let y = filled(states);
        let mut jacobian = Jacobian::ZERO;
        self.plant.jacobian(&self.integrator.memory().front.modes, time, &y, &mut jacobian);
        Linearization {
            time,
            states: y[..count].to_vec(),
            positions,
            rates: self.rates_at(time, states),
            by_state: jacobian.state[..count].iter().map(|row| row[..count].to_vec()).collect(),
            by_time: jacobian.time[..count].to_vec(),
        }
    }

    fn save(&self, snapshot: &mut Snapshot) {
        let Memory { start, end, front, step, last_error, crossings, statistics } = self.integrator.memory();
        let InputSignal { at, value, rate } = self.plant.signal();
        let inputs = [*at, value.crank_torque, value.slider_load, rate.crank_torque, rate.slider_load];
        snapshot.reals.extend(inputs);
        snapshot.reals.extend([self.plant.start_time(), *step, *last_error]);
        for Front { t, y, rates, modes } in [start, end, front] {
            snapshot.reals.push(*t);
            snapshot.reals.extend(y.iter().chain(rates));
            snapshot.reals.extend(modes.iter().map(|mode| mode.approach));
            snapshot.integers.extend(modes.iter().map(|mode| u64::from(mode.closed)));
        }
        let Statistics { steps, rejected, evaluations, events } = *statistics;
        snapshot.integers.extend([*crossings, steps, rejected, evaluations, events]);
        snapshot.integers.push(N as u64);
    }

    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        let [at, torque, load, torque_rate, load_rate] = reader.reals()?;
        let value = Inputs { crank_torque: torque, slider_load: load };
        let rate = Inputs { crank_torque: torque_rate, slider_load: load_rate };
        let [start_time, step, last_error] = reader.reals()?;
        let (start, end, front) = (front(reader)?, front(reader)?, front(reader)?);
        let crossings = reader.integer()?;
        let statistics = Statistics {
            steps: reader.integer()?,
            rejected: reader.integer()?,
            evaluations: reader.integer()?,
            events: reader.integer()?,
        };
        if reader.integer()? != N as u64 {
            return None;
        }
        self.plant.set_signal(InputSignal { at, value, rate });
        self.plant.set_start_time(start_time);
        let memory = Memory { start, end, front, step, last_error, crossings, statistics };
        self.integrator = Integrator::resume(self.plant.as_ref(), self.settings, memory);
        Some(())
    }
}

/// A list in an array with room, or as much of it as has room.
fn filled<const N: usize>(list: &[f64]) -> [f64; N] {
    let mut array = [0.0; N];
    for (place, value) in array.iter_mut().zip(list) {
        *place = *value;
    }
    array
}

fn front<const N: usize>(reader: &mut Reader<'_>) -> Option<Front<N, Contacts>> {
    let t = reader.real()?;
    let y = reader.reals()?;
    let rates = reader.reals()?;
    let approach = reader.reals::<CONTACTS>()?;
    let mut modes = Contacts::default();
    for (mode, approach) in modes.iter_mut().zip(approach) {
        if reader.integer()? != 0 {
            *mode = ContactMode::closing(approach, approach);
        }
    }
    Some(Front { t, y, rates, modes })
}
