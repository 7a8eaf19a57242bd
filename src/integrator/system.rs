//! Interface between the integrator and a hybrid system: traits, each with one duty.
//!
//! States are slices of [`StateLayout::states`] numbers, at most [`MAX_STATES`]. The first [`StateLayout::positions`]
//! are positions, as many velocities follow, and then first-order states.

use super::tableau::Tableau;
use crate::math::F64x8;

/// Maximum number of states.
pub const MAX_STATES: usize = 64;

/// Maximum number of event functions.
pub const MAX_EVENTS: usize = 8;

/// The value of an event function at one instant. The event happens when `value` falls through zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventFunction {
    /// Distance to the event; positive before it.
    pub value: f64,
    /// Time derivative of `value`.
    pub rate: f64,
}

/// All event functions at one instant.
pub type EventFunctions = [EventFunction; MAX_EVENTS];

/// For each event function, whether it fell through zero at the present instant.
pub type Triggered = [bool; MAX_EVENTS];

/// The result of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reset<D> {
    /// The discrete state after the event.
    pub discrete: D,
    /// [s] Duration of the impact that begins with the event; `None` without an impact.
    pub impact: Option<f64>,
}

/// Maximum number of functions whose zeros are derivative discontinuities.
pub const MAX_DISCONTINUITIES: usize = 45;

/// Functions whose zeros are derivative discontinuities: the slope of a rate jumps there.
#[derive(Clone, Copy, Debug)]
pub struct Discontinuities {
    values: [f64; MAX_DISCONTINUITIES],
    count: usize,
}

impl Discontinuities {
    /// An empty list.
    pub const NONE: Self = Self { values: [0.0; MAX_DISCONTINUITIES], count: 0 };

    /// Adds the value of one function.
    pub fn push(&mut self, value: f64) {
        self.values[self.count] = value;
        self.count += 1;
    }

    /// The values of all functions, in the order in which they were added.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// Number and kinds of the states of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateLayout {
    /// Number of positions, which come first. As many velocities follow, and then first-order states.
    pub positions: usize,
    /// Number of leading positions whose rounding disturbs the rates of all. Behind them stand modal coordinates, which are
    /// small against the places of the bodies: forces on a body follow from both.
    pub places: usize,
    /// Number of leading states in the error norm; the other states depend on them.
    pub weighted: usize,
    /// Number of all states.
    pub states: usize,
}

impl StateLayout {
    /// The layout of `states` states: positions and their velocities.
    pub const fn second_order(states: usize) -> Self {
        Self { positions: states / 2, places: states / 2, weighted: states, states }
    }

    /// Whether there are only positions and their velocities.
    pub fn is_second_order(self) -> bool {
        self.states == 2 * self.positions
    }
}

/// Derivatives of the rates with respect to the states and to time.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    states: usize,
    elements: Vec<f64>,
    /// [unit of state i / s²] ∂ẏ_i/∂t at constant states; empty where nobody asks for it.
    pub time: Vec<f64>,
}

impl Jacobian {
    /// A Jacobian of zeros for `states` states.
    pub fn new(states: usize) -> Self {
        Self { time: vec![0.0; states], ..Self::by_states(states) }
    }

    /// As [`new`](Self::new), without the derivatives with respect to time.
    pub fn by_states(states: usize) -> Self {
        Self { states, elements: vec![0.0; states * states], time: vec![] }
    }

    /// [1/s · unit of state i / unit of state j] ∂ẏ_i/∂y_j for all j.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.elements[i * self.states..][..self.states]
    }

    /// The row [`row`](Self::row) for writing.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.elements[i * self.states..][..self.states]
    }
}

/// Ordinary differential equations of second order in the positions, with additional first-order states.
pub trait Ode {
    /// The discrete state. It is constant within a step.
    type Discrete: Copy;

    /// Number and kinds of the states.
    fn layout(&self) -> StateLayout;

    /// Writes the rates of the state `y` at time `t`: the velocities, then the accelerations, then the
    /// rates of first-order states.
    fn rates(&self, discrete: &Self::Discrete, t: f64, y: &[f64], rates: &mut [f64]);

    /// [unit of each state] Scales of the error norm: an error of `tolerance` times the scale is just tolerable in one
    /// step.
    fn scales(&self) -> &[f64];

    /// [s] Upper bound of a step.
    fn longest_step(&self) -> f64;

    /// Writes the rates at the inner stages of an explicit method, those after the first and before the end, for a step
    /// of `h` [s] from the state `y` at time `t`. The rates of stage i occupy places i·n to (i + 1)·n of `k`, where n
    /// is the number of states; those of stage 0 are given. A system whose n is known at compile time can compute the
    /// sums and rates of all stages in one function. Returns `false` if the system does not implement this.
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
    /// Number of event functions, at most [`MAX_EVENTS`].
    fn event_count(&self) -> usize {
        0
    }

    /// Writes all event functions. Their values depend only on positions and on the discrete state.
    fn event_functions(&self, _discrete: &Self::Discrete, _t: f64, _y: &[f64], _functions: &mut EventFunctions) {}

    /// Writes rates and event functions, for a system that computes both at lower cost together.
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

    /// Adds the functions whose zeros are derivative discontinuities of the rates. Their number and order depend only
    /// on the discrete state. They suggest where a step should end: omitting one costs steps, not accuracy.
    fn discontinuities(&self, _discrete: &Self::Discrete, _t: f64, _y: &[f64], _functions: &mut Discontinuities) {}

    /// Whether the event is a dead end: the equations are singular where its function falls through zero, and a motion
    /// does not continue from a tenth of the event scale before it. Every method locates dead ends.
    fn is_dead_end(&self, _event: usize) -> bool {
        false
    }

    /// Values of the event functions above which the equations do not hold. A motion in steps of a fixed length ends there.
    fn highest_events(&self) -> &[f64; MAX_EVENTS] {
        &[f64::INFINITY; MAX_EVENTS]
    }

    /// [unit of the event functions] An error of `tolerance` times this is just tolerable in an event function.
    fn event_scale(&self) -> f64 {
        1.0
    }

    /// The discrete state after the events in `triggered` at `t`; first-order states in `y` may be reset.
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

/// A system whose rates have derivatives. The default implementation takes finite differences.
pub trait Linearizable: Ode {
    /// Writes the derivatives of the rates at `t` and `y`. At a corner of a rate the derivative is that of the branch
    /// that `rates` takes.
    fn jacobian(&self, discrete: &Self::Discrete, t: f64, y: &[f64], jacobian: &mut Jacobian) {
        by_differences(self, discrete, t, y, jacobian);
    }

    /// Whether the rates take so little time that an implicit step spends most of its own on the Jacobian and linear algebra.
    fn rates_are_cheap(&self) -> bool {
        true
    }
}

/// A system that computes the rates at several instants together. The default implementation computes one after the
/// other.
pub trait SeveralInstants: Ode {
    /// Writes the rates of eight states, each at its own time.
    fn rates_in_row(&self, discrete: &Self::Discrete, t: &F64x8, y: &[F64x8], rates: &mut [F64x8]) {
        one_by_one(&|t, y, rates| self.rates(discrete, t, y, rates), t, y, rates);
    }

    /// Whether rates at eight states take so little more time than at one that steps in blocks pay; see
    /// [`block`](super::methods::block).
    fn suits_blocks(&self) -> bool {
        false
    }
}

/// A hybrid system: the union of these traits.
pub trait System: Events + Linearizable + SeveralInstants {}

impl<S: Events + Linearizable + SeveralInstants + ?Sized> System for S {}

/// Writes the rates of a state at a time [s].
pub type RatesAt<'a> = dyn Fn(f64, &[f64], &mut [f64]) + 'a;

/// [`SeveralInstants::rates_in_row`] by one evaluation per state: `of` writes the rates of one state at its time. Written out
/// for each place and each caller, the copies would take 30 kB of code each.
#[inline(never)]
pub fn one_by_one(of: &RatesAt<'_>, t: &F64x8, y: &[F64x8], rates: &mut [F64x8]) {
    let (mut at, mut found) = ([0.0; MAX_STATES], [0.0; MAX_STATES]);
    let (at, found) = (&mut at[..y.len()], &mut found[..y.len()]);
    for (node, t) in t.numbers().into_iter().enumerate() {
        take(node, y, at);
        of(t, at, found);
        put(node, found, rates);
    }
}

/// Reads the numbers at one place of the rows.
#[inline(never)]
fn take(place: usize, rows: &[F64x8], numbers: &mut [f64]) {
    for (number, row) in numbers.iter_mut().zip(rows) {
        *number = row.number(place);
    }
}

/// Writes the numbers at one place of the rows.
#[inline(never)]
fn put(place: usize, numbers: &[f64], rows: &mut [F64x8]) {
    for (row, number) in rows.iter_mut().zip(numbers) {
        row.set(place, *number);
    }
}

/// [`Linearizable::jacobian`] by central differences over a thousandth of each state's scale; the rates must be smooth
/// there.
pub fn by_differences<S: Ode + ?Sized>(system: &S, discrete: &S::Discrete, t: f64, y: &[f64], jacobian: &mut Jacobian) {
    /// [s] Half the time interval of a difference.
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
