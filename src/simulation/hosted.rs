//! A mechanism whose time and states a host's integrator moves.
//!
//! [`System`](super::System) is the same for a caller that keeps states and contacts together itself; here the mechanism
//! remembers both, as hosts of model exchange expect.
//!
//! Contacts change in [`HostedMechanism::update`] alone, with the hysteresis of their event indicators
//! ([`contacts`](super::contacts)).
//!
//! Discontinuities of a derivative have no indicators: an event makes a host's integrator start anew, which costs more
//! than the steps that an error estimate rejects there.

use super::assemble::model;
use super::contacts::{ContactReport, ContactWatch, Instant};
use super::derivatives::{sensitivity, slopes};
use super::error::SimulationError;
use super::observation::{observe, with_settings};
use super::record::Discrete;
use super::start::pose;
use super::variation::line::Line;
use crate::integrator::{MAX_STATES, Reader, Snapshot};
use crate::math::Real;
use crate::model::drive::InputSignal;
use crate::model::mechanism_model::MechanismModel;
use crate::model::outputs::Observer;
use crate::model::scalar::Tangent;
use crate::model::signals::{Inputs, Outputs};
use crate::model::state::Conditions;
use crate::scene::{Method, Scene};

/// First integer of a snapshot, which no other kind of run begins with: its first is a number of states.
const MARK: u64 = 0x005D_EFED;
/// [J] Nominal value of an audit's sums, which no error norm of ours weighs.
const NOMINAL_ENERGY: f64 = 1.0;

/// A mechanism at a time and in a state that its host decides.
pub struct HostedMechanism {
    model: Box<dyn MechanismModel>,
    observer: Observer,
    watch: ContactWatch,
    time: f64,
    states: Vec<f64>,
    nominals: Vec<f64>,
    conditions: Conditions,
}

/// What an update of the discrete state came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Update {
    /// States have other values now: bristles of a contact that has opened are straight.
    pub states_changed: bool,
    /// The motion leads no further.
    pub dead_end: bool,
}

/// A direction in which a derivative is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Along the states, as many as there are.
    pub states: Vec<f64>,
    /// Along the inputs.
    pub inputs: Inputs,
}

impl HostedMechanism {
    /// The mechanism of `scene` in its start position at time 0, under constant `inputs`.
    ///
    /// # Errors
    /// `Scene` if the start position does not close the loop or the method has rigid contacts, which have no equations of
    /// motion.
    pub fn start(scene: &Scene, inputs: Inputs) -> Result<Self, SimulationError> {
        if scene.solver.method == Method::Moreau {
            return Err(SimulationError::Scene(
                "solver.method = moreau steps over rigid contacts, which have no equations for another integrator"
                    .into(),
            ));
        }
        let (pose, model) = (pose(scene)?, model(scene));
        let mut states = vec![0.0; model.layout().states];
        model.write_start(&pose, &mut states);
        let inputs = InputSignal { at: 0.0, value: inputs, rate: Inputs::default() };
        let conditions = Conditions::new(model.start_contacts(0.0, &states), inputs);
        Ok(Self {
            nominals: nominals_of(model.as_ref()),
            observer: Observer::new(scene),
            watch: ContactWatch::new(scene),
            time: 0.0,
            states,
            conditions,
            model,
        })
    }

    /// [s] Time, counted from the start.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets the time [s], forward or back.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// The states: positions, their rates, bristles, sums of an audit.
    pub fn states(&self) -> &[f64] {
        &self.states
    }

    /// The same, to be set.
    pub fn states_mut(&mut self) -> &mut [f64] {
        &mut self.states
    }

    /// What size of error is just noticeable in each state, over the tolerance.
    pub fn nominals(&self) -> &[f64] {
        &self.nominals
    }

    /// Number of event indicators.
    pub fn indicators(&self) -> usize {
        self.watch.indicators()
    }

    /// Sets the inputs, which stay.
    pub fn set_inputs(&mut self, inputs: Inputs) {
        self.conditions.inputs.value = inputs;
    }

    /// Writes the rates of the states.
    pub fn write_rates(&self, rates: &mut [f64]) {
        self.model.rates(&self.conditions, self.time, &self.states, rates);
    }

    /// Writes the event indicators.
    pub fn write_indicators(&self, indicators: &mut [f64]) {
        self.watch.write_indicators(&self.now(), indicators);
    }

    /// Its contacts; those change that the next update closes or opens.
    pub fn contacts(&self) -> ContactReport {
        self.watch.report_due(&self.now())
    }

    /// Whether a contact is open or closed although its indicator says otherwise, or the motion leads no further.
    pub fn update_is_due(&self) -> bool {
        self.watch.leads_no_further(&self.now()) || self.watch.due(&self.now()).contains(&true)
    }

    /// Closes and opens contacts as their indicators say. One that closes remembers its approach speed.
    pub fn update(&mut self) -> Update {
        let (triggered, dead_end) = (self.watch.due(&self.now()), self.watch.leads_no_further(&self.now()));
        let mut before = [0.0; MAX_STATES];
        let before = &mut before[..self.states.len()];
        before.copy_from_slice(&self.states);
        if triggered.contains(&true) {
            self.conditions.touches.iter_mut().for_each(|touches| touches.begin_interval(self.time));
            self.conditions = self.model.reset(&self.conditions, self.time, &mut self.states, &triggered).discrete;
        }
        Update { states_changed: before != self.states, dead_end }
    }

    /// Outputs; the integrator's counters and tolerance stay at 0.
    pub fn outputs(&self) -> Outputs {
        with_settings(self.observe(&self.states, &self.conditions), 0.0)
    }

    /// Their time derivatives along the motion.
    pub fn output_rates(&self) -> Outputs {
        let Self { model, observer, conditions, time, states, .. } = self;
        let mut rates = [0.0; MAX_STATES];
        let rates = &mut rates[..states.len()];
        self.write_rates(rates);
        let mut slopes =
            slopes(model.as_ref(), *time, states, rates, &|t, y| observe(model.as_ref(), observer, conditions, t, y));
        observer.set_known_rates(&model.evaluation(conditions, *time, states), &mut slopes);
        slopes
    }

    /// Their derivative with respect to the inputs along `seed`.
    pub fn output_sensitivity(&self, seed: Inputs) -> Outputs {
        sensitivity(seed, |inputs| {
            let inputs = InputSignal { at: self.time, value: inputs, rate: Inputs::default() };
            self.observe(&self.states, &Conditions { inputs, ..self.conditions })
        })
    }

    /// Their derivative along a direction: exact in the inputs, a difference in the states.
    pub fn outputs_along(&self, direction: &Direction) -> Outputs {
        let Self { model, observer, conditions, time, states, .. } = self;
        let model = model.as_ref();
        let line = Line { model, conditions, t: *time, y: states, direction: &direction.states, levels: None };
        let by_inputs = self.output_sensitivity(direction.inputs);
        line.fitted().outputs(observer).combined(&by_inputs, |states, inputs| states + inputs)
    }

    /// Writes the derivative of the rates along a direction: exact, by the equations' own code.
    pub fn write_rates_along(&self, direction: &Direction, along: &mut [f64]) {
        let Direction { states, inputs } = direction;
        // Inputs that grow at the rate of their direction are, differentiated by time, that direction.
        let moving = *inputs != Inputs::default();
        let all = self.rates_slope(states, f64::from(u8::from(moving)), *inputs);
        let by_time = if moving { self.rates_slope(&[], 1.0, Inputs::default()) } else { [0.0; MAX_STATES] };
        for (along, (all, by_time)) in along.iter_mut().zip(all.into_iter().zip(by_time)) {
            *along = all - by_time;
        }
    }

    /// Derivative of the rates along `states` (0 where there is none) and `time` [s], under inputs that grow at `growth`.
    fn rates_slope(&self, states: &[f64], time: f64, growth: Inputs) -> [f64; MAX_STATES] {
        let tangent = |value: f64, slope: f64| {
            let mut tangent = Tangent::constant(value);
            tangent.slope[0] = slope;
            tangent
        };
        let n = self.states.len();
        let (mut at, mut rates) = ([Tangent::ZERO; MAX_STATES], [Tangent::ZERO; MAX_STATES]);
        let slopes = states.iter().copied().chain(std::iter::repeat(0.0));
        for ((at, state), slope) in at.iter_mut().zip(&self.states).zip(slopes) {
            *at = tangent(*state, slope);
        }
        let inputs = InputSignal { at: self.time, rate: growth, ..self.conditions.inputs };
        let conditions = Conditions { inputs, ..self.conditions };
        self.model.tangent_rates(&conditions, tangent(self.time, time), &at[..n], &mut rates[..n]);
        rates.map(|rate| rate.slope[0])
    }

    /// All that is needed to go on from here.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        snapshot.integers.extend([MARK, self.states.len() as u64]);
        snapshot.reals.push(self.time);
        snapshot.reals.extend(&self.states);
        self.conditions.save(self.states.len(), &mut snapshot);
        snapshot
    }

    /// A mechanism of `scene` that goes on where `snapshot` was taken.
    ///
    /// # Errors
    /// `Snapshot` if it is not one of a hosted mechanism with as many states; `Scene` as in [`HostedMechanism::start`].
    pub fn restore(scene: &Scene, snapshot: &Snapshot) -> Result<Self, SimulationError> {
        let mut mechanism = Self::start(scene, Inputs::default())?;
        let mut reader = Reader::new(snapshot);
        match mechanism.load(&mut reader) {
            Some(()) if reader.is_at_end() => Ok(mechanism),
            _ => Err(SimulationError::Snapshot(
                "the saved state is not one of these joints under another integrator".into(),
            )),
        }
    }

    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        if [reader.integer()?, reader.integer()?] != [MARK, self.states.len() as u64] {
            return None;
        }
        self.time = reader.real()?;
        reader.fill(&mut self.states)?;
        self.conditions = Conditions::load(self.states.len(), reader)?;
        Some(())
    }

    fn observe(&self, states: &[f64], conditions: &Conditions) -> Outputs {
        observe(self.model.as_ref(), &self.observer, conditions, self.time, states)
    }

    fn now(&self) -> Instant<'_> {
        let Self { model, conditions, time, states, .. } = self;
        Instant { model: model.as_ref(), conditions, time: *time, states }
    }
}

/// The nominal values of a scene's states: what size of error is just noticeable in each, over the tolerance.
pub fn nominals(scene: &Scene) -> Vec<f64> {
    nominals_of(model(scene).as_ref())
}

fn nominals_of(model: &dyn MechanismModel) -> Vec<f64> {
    let nominal = |scale: &f64| if *scale > 0.0 { *scale } else { NOMINAL_ENERGY };
    model.scales()[..model.layout().states].iter().map(nominal).collect()
}
