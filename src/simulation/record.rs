//! Conversion between the memory of a run and a snapshot.

use crate::integrator::{Account, Impulses, Pace, Reader, Snapshot, SolverState, Statistics, StepPoint};
use crate::model::contact::ContactState;
use crate::model::drive::InputSignal;
use crate::model::mechanism_model::MechanismModel;
use crate::model::signals::Inputs;
use crate::model::state::{CONTACTS, Conditions, Contacts};
use crate::model::touches::{JOINTS, Touches};

/// The discrete part of a state in a snapshot.
pub trait Discrete: Copy {
    /// Appends the discrete state of a system with `states` states.
    fn save(&self, states: usize, snapshot: &mut Snapshot);
    /// Reads a discrete state; `None` if it does not fit.
    fn load(states: usize, reader: &mut Reader<'_>) -> Option<Self>;
}

impl Discrete for InputSignal {
    fn save(&self, _: usize, snapshot: &mut Snapshot) {
        let Self { at, value, rate } = self;
        snapshot.reals.extend([*at, value.crank_torque, value.slider_load, rate.crank_torque, rate.slider_load]);
    }

    fn load(_: usize, reader: &mut Reader<'_>) -> Option<Self> {
        let [at, torque, load, torque_rate, load_rate] = reader.reals()?;
        let value = Inputs { crank_torque: torque, slider_load: load };
        let rate = Inputs { crank_torque: torque_rate, slider_load: load_rate };
        Some(Self { at, value, rate })
    }
}

impl Discrete for Conditions {
    fn save(&self, states: usize, snapshot: &mut Snapshot) {
        self.inputs.save(states, snapshot);
        snapshot.reals.extend(self.contacts.iter().map(|contact| contact.approach));
        snapshot.integers.extend(self.contacts.iter().map(|contact| u64::from(contact.closed)));
        for touches in &self.touches {
            let (reals, count) = touches.parts();
            snapshot.reals.extend(reals);
            snapshot.integers.push(u64::from(count));
        }
    }

    fn load(states: usize, reader: &mut Reader<'_>) -> Option<Self> {
        let inputs = InputSignal::load(states, reader)?;
        let approach = reader.reals::<CONTACTS>()?;
        let mut contacts = Contacts::default();
        for (contact, approach) in contacts.iter_mut().zip(approach) {
            if reader.integer()? != 0 {
                *contact = ContactState::closing(approach, approach);
            }
        }
        let mut touches = [Touches::default(); JOINTS];
        for touches in &mut touches {
            *touches = Touches::from_parts(reader.reals()?, reader.integer()?.try_into().ok()?)?;
        }
        Some(Self { contacts, inputs, touches })
    }
}

impl Discrete for Impulses {
    fn save(&self, states: usize, snapshot: &mut Snapshot) {
        snapshot.reals.push(self.t);
        snapshot.reals.extend(&self.y[..states]);
        snapshot.reals.extend(self.forces.as_flattened());
        snapshot.integers.extend(self.closed.map(u64::from));
    }

    fn load(states: usize, reader: &mut Reader<'_>) -> Option<Self> {
        let mut impulses = Self::none(reader.real()?, &[]);
        reader.fill(&mut impulses.y[..states])?;
        for forces in &mut impulses.forces {
            *forces = reader.reals()?;
        }
        for closed in &mut impulses.closed {
            *closed = reader.integer()? != 0;
        }
        Some(impulses)
    }
}

/// Appends the memory of the integrator.
pub fn save<D: Discrete>(state: &SolverState<D>, snapshot: &mut Snapshot) {
    let SolverState { step, last_error, cuts, crossings, statistics, account, .. } = state;
    let states = state.front().y.len();
    snapshot.integers.push(states as u64);
    let Account { interval, jacobians, before, counted, recent, mean, looseness, hits, error } = *account;
    snapshot.reals.extend([*step, *last_error, looseness, error]);
    snapshot.reals.extend([recent, mean].iter().flat_map(|pace| [pace.work, pace.covered]));
    for StepPoint { t, y, rates, discrete, impact_end } in [state.start(), state.end(), state.front()] {
        snapshot.reals.extend([*t, *impact_end]);
        snapshot.reals.extend(y.iter().chain(rates));
        discrete.save(states, snapshot);
    }
    let Statistics { steps, rejected, evaluations, events } = *statistics;
    snapshot.integers.extend([u64::from(*cuts), *crossings, steps, rejected, evaluations, events]);
    snapshot.integers.extend([interval, jacobians, before, counted, hits]);
}

/// Reads what [`save`] appended in a run of `model` at `time` [s]; `None` if no run can have produced it.
pub fn load<D: Discrete>(model: &dyn MechanismModel, time: f64, reader: &mut Reader<'_>) -> Option<SolverState<D>> {
    let states = model.layout().states;
    if reader.integer()? != states as u64 {
        return None;
    }
    let [step, last_error, looseness, error] = reader.reals()?;
    let [recent, mean] = [reader.reals()?, reader.reals()?].map(|[work, covered]| Pace { work, covered });
    let points = [take_point(states, reader)?, take_point(states, reader)?, take_point(states, reader)?];
    let mut state = SolverState::of(points, step);
    state.last_error = last_error;
    state.cuts = reader.integer()?.try_into().ok()?;
    state.crossings = reader.integer()?;
    state.statistics = Statistics {
        steps: reader.integer()?,
        rejected: reader.integer()?,
        evaluations: reader.integer()?,
        events: reader.integer()?,
    };
    state.account = Account {
        interval: reader.integer()?,
        jacobians: reader.integer()?,
        before: reader.integer()?,
        counted: reader.integer()?,
        recent,
        mean,
        looseness,
        hits: reader.integer()?,
        error,
    };
    state.is_sound(time, model.longest_step()).then_some(state)
}

fn take_point<D: Discrete>(states: usize, reader: &mut Reader<'_>) -> Option<StepPoint<D>> {
    let [t, impact_end] = reader.reals()?;
    let (mut y, mut rates) = (vec![0.0; states], vec![0.0; states]);
    reader.fill(&mut y)?;
    reader.fill_any(&mut rates)?;
    Some(StepPoint { t, y, rates, discrete: D::load(states, reader)?, impact_end })
}
