//! A run's memory in a snapshot.

use crate::integrator::{Impulses, Reader, Snapshot, SolverState, Statistics, StepPoint};
use crate::model::contact::ContactMode;
use crate::model::drive::InputSignal;
use crate::model::plant::Plant;
use crate::model::signals::Inputs;
use crate::model::state::{CONTACTS, Contacts};

/// The discrete part of a state.
pub trait Discrete: Copy {
    /// Appends it, beside so many states.
    fn save(&self, states: usize, snapshot: &mut Snapshot);
    /// Takes it back; `None` if it does not fit.
    fn load(states: usize, reader: &mut Reader<'_>) -> Option<Self>;
}

impl Discrete for Contacts {
    fn save(&self, _: usize, snapshot: &mut Snapshot) {
        snapshot.reals.extend(self.iter().map(|mode| mode.approach));
        snapshot.integers.extend(self.iter().map(|mode| u64::from(mode.closed)));
    }

    fn load(_: usize, reader: &mut Reader<'_>) -> Option<Self> {
        let approach = reader.reals::<CONTACTS>()?;
        let mut modes = Self::default();
        for (mode, approach) in modes.iter_mut().zip(approach) {
            if reader.integer()? != 0 {
                *mode = ContactMode::closing(approach, approach);
            }
        }
        Some(modes)
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

/// Appends the inputs in force and what the integrator remembers.
pub fn save<D: Discrete>(plant: &dyn Plant, state: &SolverState<D>, snapshot: &mut Snapshot) {
    let SolverState { step, last_error, cuts, crossings, statistics, .. } = state;
    let InputSignal { at, value, rate } = plant.signal();
    let inputs = [*at, value.crank_torque, value.slider_load, rate.crank_torque, rate.slider_load];
    let states = state.front().y.len();
    snapshot.integers.push(states as u64);
    snapshot.reals.extend(inputs);
    snapshot.reals.extend([plant.start_time(), *step, *last_error]);
    for StepPoint { t, y, rates, discrete, impact_end } in [state.start(), state.end(), state.front()] {
        snapshot.reals.extend([*t, *impact_end]);
        snapshot.reals.extend(y.iter().chain(rates));
        discrete.save(states, snapshot);
    }
    let Statistics { steps, rejected, evaluations, events } = *statistics;
    snapshot.integers.extend([u64::from(*cuts), *crossings, steps, rejected, evaluations, events]);
}

/// Takes back what [`save`] appended of a run at `time` [s]: the plant gets its inputs, what the integrator remembers is
/// returned.
pub fn load<D: Discrete>(plant: &mut dyn Plant, time: f64, reader: &mut Reader<'_>) -> Option<SolverState<D>> {
    let states = plant.extent().states;
    if reader.integer()? != states as u64 {
        return None;
    }
    let [at, torque, load, torque_rate, load_rate] = reader.reals()?;
    let value = Inputs { crank_torque: torque, slider_load: load };
    let rate = Inputs { crank_torque: torque_rate, slider_load: load_rate };
    let [start_time, step, last_error] = reader.reals()?;
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
    plant.set_signal(InputSignal { at, value, rate });
    plant.set_start_time(start_time);
    state.is_sound(time, plant.longest_step()).then_some(state)
}

fn take_point<D: Discrete>(states: usize, reader: &mut Reader<'_>) -> Option<StepPoint<D>> {
    let [t, impact_end] = reader.reals()?;
    let (mut y, mut rates) = (vec![0.0; states], vec![0.0; states]);
    reader.fill(&mut y)?;
    reader.fill_any(&mut rates)?;
    Some(StepPoint { t, y, rates, discrete: D::load(states, reader)?, impact_end })
}
