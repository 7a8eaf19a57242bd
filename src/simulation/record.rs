//! A run's memory in a snapshot.

use super::snapshot::{Reader, Snapshot};
use crate::integrator::{Extent, Front, Impulses, Manner, Memory, Past, Regime, Statistics};
use crate::math::{Real, Row};
use crate::model::contact::ContactMode;
use crate::model::drive::InputSignal;
use crate::model::plant::Plant;
use crate::model::signals::Inputs;
use crate::model::state::{CONTACTS, Contacts};

/// The discrete part of a state.
pub trait Discrete: Sized {
    /// Appends it.
    fn save(&self, snapshot: &mut Snapshot);
    /// Takes it back; `None` if it does not fit.
    fn load(reader: &mut Reader<'_>) -> Option<Self>;
}

impl Discrete for Contacts {
    fn save(&self, snapshot: &mut Snapshot) {
        snapshot.reals.extend(self.iter().map(|mode| mode.approach));
        snapshot.integers.extend(self.iter().map(|mode| u64::from(mode.closed)));
    }

    fn load(reader: &mut Reader<'_>) -> Option<Self> {
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

impl<const N: usize> Discrete for Impulses<N> {
    fn save(&self, snapshot: &mut Snapshot) {
        snapshot.reals.push(self.t);
        snapshot.reals.extend(self.y);
        snapshot.reals.extend(self.forces.as_flattened());
        snapshot.integers.extend(self.closed.map(u64::from));
    }

    fn load(reader: &mut Reader<'_>) -> Option<Self> {
        let mut impulses = Self::none(reader.real()?, reader.reals()?);
        for forces in &mut impulses.forces {
            *forces = reader.reals()?;
        }
        for closed in &mut impulses.closed {
            *closed = reader.integer()? != 0;
        }
        Some(impulses)
    }
}

/// Appends the inputs in force and the integrator's memory.
pub fn save<const N: usize, D: Discrete>(plant: &dyn Plant<N>, memory: &Memory<N, D>, snapshot: &mut Snapshot) {
    let Memory { start, end, front, manner, regime, step, last_error, cuts, crossings, past, statistics } = memory;
    let InputSignal { at, value, rate } = plant.signal();
    let inputs = [*at, value.crank_torque, value.slider_load, rate.crank_torque, rate.slider_load];
    snapshot.reals.extend(inputs);
    snapshot.reals.extend([plant.start_time(), *step, *last_error, regime.block]);
    for Front { t, y, rates, modes, impact_end } in [start, end, front] {
        snapshot.reals.extend([*t, *impact_end]);
        snapshot.reals.extend(y.iter().chain(rates));
        modes.save(snapshot);
    }
    let Statistics { steps, rejected, evaluations, events } = *statistics;
    snapshot.integers.extend([u64::from(*cuts), *crossings, steps, rejected, evaluations, events]);
    snapshot.integers.extend([*manner as u64, regime.manner as u64]);
    snapshot.integers.extend([regime.steps, regime.patience, regime.unpaid].map(u64::from));
    snapshot.integers.extend([N as u64, u64::from(past.is_some())]);
    if past.is_some() {
        snapshot.reals.extend([past.begin, past.end]);
        snapshot.reals.extend(past.start);
        snapshot.reals.extend(past.nodes.iter().flat_map(|row| row.numbers()));
    }
}

/// Takes back what [`save`] appended of a run at `time` [s]: the plant gets its inputs, the integrator's memory is
/// returned.
pub fn load<const N: usize, D: Discrete>(
    plant: &mut dyn Plant<N>,
    time: f64,
    reader: &mut Reader<'_>,
) -> Option<Memory<N, D>> {
    let [at, torque, load, torque_rate, load_rate] = reader.reals()?;
    let value = Inputs { crank_torque: torque, slider_load: load };
    let rate = Inputs { crank_torque: torque_rate, slider_load: load_rate };
    let [start_time, step, last_error, block] = reader.reals()?;
    let (start, end, front) = (take_front(reader)?, take_front(reader)?, take_front(reader)?);
    let cuts = reader.integer()?.try_into().ok()?;
    let crossings = reader.integer()?;
    let statistics = Statistics {
        steps: reader.integer()?,
        rejected: reader.integer()?,
        evaluations: reader.integer()?,
        events: reader.integer()?,
    };
    let manner = take_manner(reader)?;
    let regime = Regime {
        manner: take_manner(reader)?,
        steps: reader.integer()?.try_into().ok()?,
        patience: reader.integer()?.try_into().ok()?,
        unpaid: reader.integer()?.try_into().ok()?,
        block,
    };
    if reader.integer()? != N as u64 {
        return None;
    }
    let past = if reader.integer()? == 0 { Past::NONE } else { take_past(reader)? };
    plant.set_signal(InputSignal { at, value, rate });
    plant.set_start_time(start_time);
    let memory = Memory { start, end, front, manner, regime, step, last_error, cuts, crossings, past, statistics };
    memory.is_sound(time, Extent::of(plant), plant.longest_step()).then_some(memory)
}

fn take_manner(reader: &mut Reader<'_>) -> Option<Manner> {
    let place = usize::try_from(reader.integer()?).ok()?;
    Manner::ALL.get(place).copied()
}

fn take_past<const N: usize>(reader: &mut Reader<'_>) -> Option<Past<N>> {
    let [begin, end] = reader.reals()?;
    let start = reader.reals()?;
    let mut nodes = [Row::ZERO; N];
    for row in &mut nodes {
        *row = Row::of(reader.reals()?);
    }
    Some(Past { begin, end, start, nodes })
}

fn take_front<const N: usize, D: Discrete>(reader: &mut Reader<'_>) -> Option<Front<N, D>> {
    let [t, impact_end] = reader.reals()?;
    Some(Front { t, y: reader.reals()?, rates: reader.any_reals()?, modes: D::load(reader)?, impact_end })
}
