//! What the integrator asks of a hybrid system: traits, each with one duty.
//!
//! States are slices of [`StateLayout::states`] numbers, at most [`MAX_STATES`].

use super::tableau::Tableau;
use crate::math::F64x8;

/// Most states that a system may have.
pub const MAX_STATES: usize = 64;

/// Most event functions that a system may have.
pub const MAX_EVENTS: usize = 8;

/// An event function at one instant. The event happens when `value` falls through zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventFunction {
    /// Distance to the event, positive before it.
    pub value: f64,
    /// Its time derivative.
    pub rate: f64,
}

/// All event functions at one instant.
pub type EventFunctions = [EventFunction; MAX_EVENTS];

/// Which event functions fell through zero at the same instant.
pub type Triggered = [bool; MAX_EVENTS];

/// What holds after an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reset<D> {
    /// The discrete state from now on.
    pub discrete: D,
    /// [s] How long the impact lasts that begins here, where one does.
    pub impact: Option<f64>,
}

/// Most functions whose zeros are discontinuities of a derivative.
const MAX_DISCONTINUITIES: usize = 42;

/// Functions whose zeros are derivative discontinuities: there a rate goes on with another slope.
#[derive(Clone, Copy, Debug)]
pub struct Discontinuities {
    values: [f64; MAX_DISCONTINUITIES],
    count: usize,
}

impl Discontinuities {
    /// An empty list.
    pub const NONE: Self = Self { values: [0.0; MAX_DISCONTINUITIES], count: 0 };

    /// Adds one function by its value.
    pub fn push(&mut self, value: f64) {
        self.values[self.count] = value;
        self.count += 1;
    }

    /// The values of all functions, in the order in which they were added.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// How many states a system has, and of which kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateLayout {
    /// Positions, which come first; as many rates of the positions follow, and then first-order states.
    pub positions: usize,
    /// Leading states that the error norm weighs; the others follow from the weighted ones.
    pub weighted: usize,
    /// All states.
    pub states: usize,
}

impl StateLayout {
    /// `states` states: positions and their rates.
    pub const fn second_order(states: usize) -> Self {
        Self { positions: states / 2, weighted: states, states }
    }

    /// There are no states but positions and their rates.
    pub fn is_second_order(self) -> bool {
        self.states == 2 * self.positions
    }
}

/// How the rates of a system depend on its states and on time.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    states: usize,
    elements: Vec<f64>,
    /// [unit of state i / s²] ∂ẏ_i/∂t at constant states.
    pub time: Vec<f64>,
}

impl Jacobian {
    /// All zeros, of so many states.
    pub fn new(states: usize) -> Self {
        Self { states, elements: vec![0.0; states * states], time: vec![0.0; states] }
    }

    /// [1/s · unit of state i / unit of state j] ∂ẏ_i/∂y_j for all j.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.elements[i * self.states..][..self.states]
    }

    /// The same, to be written.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.elements[i * self.states..][..self.states]
    }
}

/// Ordinary differential equations of second order in the positions, with first-order states beside them.
pub trait Ode {
    /// The discrete state. It is constant within a step.
    type Discrete: Copy;

    /// How many states there are.
    fn layout(&self) -> StateLayout;

    /// Writes the rates of the state `y` at time `t`: the velocities, then the accelerations, then the
    /// rates of first-order states.
    fn rates(&self, discrete: &Self::Discrete, t: f64, y: &[f64], rates: &mut [f64]);

    /// [unit of each state] An error of `tolerance` times this is just tolerable in one step.
    fn scales(&self) -> &[f64];

    /// [s] No step is longer.
    fn longest_step(&self) -> f64;

    /// Writes the rates at the stages of a method after its first and before its end is known, for a step of `h` from
    /// the state `y` at time `t`. The rates of stage i have the place i·n to (i + 1)·n in `k`, where n is the number of
    /// states; the first n are known. A system that knows n when it is compiled can do so with the stages' sums and its
    /// rates in one function; `false` means that it has not.
    fn stages(
        &self,
        _tableau: &Tableau,
        _discrete: &Self::Discrete,
        _t: f64,
        _y: &[f64],
        _h: f64,
        _k: &mut [f64],
    ) -> bool {
        false
    }
}

/// The events of a system.
pub trait Events: Ode {
    /// How many event functions there are, at most [`MAX_EVENTS`].
    fn event_count(&self) -> usize {
        0
    }

    /// Writes all event functions. Only positions and the discrete state decide `value`.
    fn event_functions(&self, _discrete: &Self::Discrete, _t: f64, _y: &[f64], _functions: &mut EventFunctions) {}

    /// Both rates and event functions, for a system that computes them cheaper together.
    fn rates_and_event_functions(
        &self,
        discrete: &Self::Discrete,
        t: f64,
        y: &[f64],
        rates: &mut [f64],
        functions: &mut EventFunctions,
    ) {
        self.rates(discrete, t, y, rates);
        self.event_functions(discrete, t, y, functions);
    }

    /// Adds the functions whose zeros are derivative discontinuities of the rates; their number and order depend on the
    /// discrete state alone. They only tell where a step may end with advantage: one that is left out costs steps, not
    /// accuracy.
    fn discontinuities(&self, _discrete: &Self::Discrete, _t: f64, _y: &[f64], _functions: &mut Discontinuities) {}

    /// No motion leads beyond the fall of this event function, nor goes on from a tenth of the event scale before it.
    /// Every method locates it.
    fn is_dead_end(&self, _event: usize) -> bool {
        false
    }

    /// [unit of the event functions] An error of `tolerance` times this in an event function is just tolerable.
    fn event_scale(&self) -> f64 {
        1.0
    }

    /// The discrete state after the event functions in `triggered` fell through zero at `t`; may reset first-order
    /// states.
    fn reset(
        &self,
        discrete: &Self::Discrete,
        _t: f64,
        _y: &mut [f64],
        _triggered: &Triggered,
    ) -> Reset<Self::Discrete> {
        Reset { discrete: *discrete, impact: None }
    }
}

/// A system whose rates have derivatives. The default takes differences.
pub trait Linearizable: Ode {
    /// Writes the derivatives of the rates at `t` and `y`. Where a rate has a corner, the derivative is that of the
    /// branch that `rates` takes.
    fn jacobian(&self, discrete: &Self::Discrete, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        by_differences(self, discrete, t, y, jacobian);
    }
}

/// A system that computes the rates of several instants together. The default computes one after the other.
pub trait SeveralInstants: Ode {
    /// Writes the rates of eight states at their times.
    fn rates_in_row(&self, discrete: &Self::Discrete, t: &F64x8, y: &[F64x8], rates: &mut [F64x8]) {
        one_by_one(self, discrete, t, y, rates);
    }

    /// Whether rates at eight states take so little more time than at one that steps are best made in blocks, see
    /// [`block`](super::methods::block).
    fn suits_blocks(&self) -> bool {
        false
    }
}

/// A hybrid system: all of these.
pub trait System: Events + Linearizable + SeveralInstants {}

impl<S: Events + Linearizable + SeveralInstants + ?Sized> System for S {}

/// [`SeveralInstants::rates_in_row`] by the rates of each state.
pub fn one_by_one<S: Ode + ?Sized>(system: &S, discrete: &S::Discrete, t: &F64x8, y: &[F64x8], rates: &mut [F64x8]) {
    let n = y.len();
    let (mut at, mut found) = ([0.0; MAX_STATES], [0.0; MAX_STATES]);
    for (node, t) in t.numbers().into_iter().enumerate() {
        for (at, y) in at.iter_mut().zip(y) {
            *at = y.numbers()[node];
        }
        system.rates(discrete, t, &at[..n], &mut found[..n]);
        for (rates, found) in rates.iter_mut().zip(&found) {
            let mut numbers = rates.numbers();
            numbers[node] = *found;
            *rates = F64x8::of(numbers);
        }
    }
}

/// [`Linearizable::jacobian`] by differences over the scale of each state: for rates that are smooth over so much.
pub fn by_differences<S: Ode + ?Sized>(system: &S, discrete: &S::Discrete, t: f64, y: &[f64], jacobian: &mut Jacobian) {
    /// [s] Half the interval of time.
    const INSTANT: f64 = 1e-7;
    let n = y.len();
    let (mut at, mut before, mut after) = ([0.0; MAX_STATES], [0.0; MAX_STATES], [0.0; MAX_STATES]);
    at[..n].copy_from_slice(y);
    for j in 0..n {
        let half = 1e-3 * system.scales().get(j).copied().unwrap_or(1.0);
        at[j] = y[j] - half;
        system.rates(discrete, t, &at[..n], &mut before[..n]);
        at[j] = y[j] + half;
        system.rates(discrete, t, &at[..n], &mut after[..n]);
        let width = at[j] - (y[j] - half);
        at[j] = y[j];
        for i in 0..n {
            jacobian.row_mut(i)[j] = (after[i] - before[i]) / width;
        }
    }
    system.rates(discrete, t - INSTANT, y, &mut before[..n]);
    system.rates(discrete, t + INSTANT, y, &mut after[..n]);
    for (slope, (before, after)) in jacobian.time.iter_mut().zip(before.iter().zip(&after)) {
        *slope = (after - before) / (2.0 * INSTANT);
    }
}
