//! What the integrator asks of a hybrid system.

use super::stages::in_registers;
use super::tableau::{STAGES, Tableau};
use crate::math::{ROW, Real, Row};

/// Most event functions that a problem may have.
pub const GUARDS: usize = 8;

/// An event function at one instant. The event happens when `value` falls through zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Guard {
    /// Distance to the event, positive before it.
    pub value: f64,
    /// Its time derivative.
    pub rate: f64,
}

/// Which guards fell through zero at the same instant.
pub type Crossed = [bool; GUARDS];

/// What holds after an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reset<D> {
    /// The modes from now on.
    pub modes: D,
    /// [s] How long the impact lasts that begins here, where one does.
    pub impact: Option<f64>,
}

/// Most kinks that a problem may have.
const KINKS: usize = 42;

/// Functions whose zeros are kinks of the rates: there a rate goes on with another slope.
#[derive(Clone, Copy, Debug)]
pub struct Kinks {
    values: [f64; KINKS],
    count: usize,
}

impl Kinks {
    /// None yet.
    pub const NONE: Self = Self { values: [0.0; KINKS], count: 0 };

    /// Adds one function by its value.
    pub fn push(&mut self, value: f64) {
        self.values[self.count] = value;
        self.count += 1;
    }

    /// Their values, in the order in which they came.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// From this `N` on, the arrays of a problem are room for states and [`Problem::extent`] tells how
/// many there are; a smaller `N` is their exact number, known to the compiler.
pub const ROOM: usize = 32;

/// How many states a problem has, and of which kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// Positions, which come first; as many rates of theirs follow, and then first-order states.
    pub positions: usize,
    /// Leading states that the error norm weighs; the others follow from them.
    pub weighed: usize,
    /// All states.
    pub states: usize,
}

impl Extent {
    /// `states` states: positions and their rates.
    pub const fn second_order(states: usize) -> Self {
        Self { positions: states / 2, weighed: states, states }
    }

    /// There are no states but positions and their rates.
    pub fn is_second_order(self) -> bool {
        self.states == 2 * self.positions
    }

    /// Of a problem, as a constant where it is one.
    #[inline(always)]
    pub fn of<const N: usize, P: Problem<N> + ?Sized>(problem: &P) -> Self {
        if N < ROOM { Self::second_order(N) } else { problem.extent() }
    }
}

/// How the rates of a problem depend on its states and on time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian<const N: usize> {
    /// [1/s · unit of state i / unit of state j] ∂ẏ_i/∂y_j in row i, column j.
    pub state: [[f64; N]; N],
    /// [unit of state i / s²] ∂ẏ_i/∂t at constant states.
    pub time: [f64; N],
}

impl<const N: usize> Jacobian<N> {
    /// Of rates that depend on nothing.
    pub const ZERO: Self = Self { state: [[0.0; N]; N], time: [0.0; N] };
}

/// A hybrid system of second order in its positions, with first-order states beside them where it has
/// room for more than `ROOM` states.
pub trait Problem<const N: usize> {
    /// The discrete state. It is constant within a step.
    type Modes: Copy;

    /// How many states there are. An `N` below [`ROOM`] does not ask.
    fn extent(&self) -> Extent {
        Extent::second_order(N)
    }

    /// Writes the rates of the state `y` at time `t`: the velocities, then the accelerations, then the
    /// rates of first-order states.
    fn rates(&self, modes: &Self::Modes, t: f64, y: &[f64; N], rates: &mut [f64; N]);

    /// Writes the rates of eight states at their times.
    fn rates_in_row(&self, modes: &Self::Modes, t: &Row, y: &[Row; N], rates: &mut [Row; N]) {
        one_by_one(self, modes, t, y, rates);
    }

    /// Whether rates at eight states take so little more time than at one that steps are best made in blocks, see
    /// [`block`](super::block).
    fn suits_blocks(&self) -> bool {
        false
    }

    /// Writes the rates at the stages of a method after its first and before its end is known into their places in `k`,
    /// for a step of `h` from the state `y` at time `t`; `k[0]` has the rates there. Compiled for a problem of at most
    /// [`IN_REGISTERS`](super::stages::IN_REGISTERS) states, with its rates inside; larger ones are not asked.
    fn stages(&self, tableau: &Tableau, modes: &Self::Modes, t: f64, y: &[f64; N], h: f64, k: &mut [[f64; N]; STAGES]) {
        in_registers(tableau, t, y, h, k, |t, y, rates| self.rates(modes, t, y, rates));
    }

    /// Writes the exact derivatives of the rates at `t` and `y` into the rows and columns of the
    /// problem's states; what lies beyond keeps its value. Where a rate has a corner, the derivative is
    /// that of the branch that `rates` takes.
    fn jacobian(&self, modes: &Self::Modes, t: f64, y: &[f64; N], jacobian: &mut Jacobian<N>);

    /// [unit of each state] An error of `tolerance` times this is just tolerable in one step.
    fn scales(&self) -> &[f64; N];

    /// [s] No step is longer.
    fn longest_step(&self) -> f64;

    /// How many guards there are, at most [`GUARDS`].
    fn guard_count(&self) -> usize;

    /// Writes all guards. Only positions and modes decide `value`.
    fn guards(&self, modes: &Self::Modes, t: f64, y: &[f64; N], guards: &mut [Guard; GUARDS]);

    /// Both rates and guards, for a problem that has them cheaper together.
    fn rates_and_guards(
        &self,
        modes: &Self::Modes,
        t: f64,
        y: &[f64; N],
        rates: &mut [f64; N],
        guards: &mut [Guard; GUARDS],
    ) {
        self.rates(modes, t, y, rates);
        self.guards(modes, t, y, guards);
    }

    /// Adds the functions whose zeros are kinks of the rates; their number and order depend on the modes alone. They
    /// only tell where a step may end with advantage: one that is left out costs steps, not accuracy.
    fn kinks(&self, _modes: &Self::Modes, _t: f64, _y: &[f64; N], _kinks: &mut Kinks) {}

    /// No motion leads beyond the fall of this guard, nor goes on from a tenth of the guards' scale before it. Every
    /// method locates it.
    fn is_dead_end(&self, _guard: usize) -> bool {
        false
    }

    /// [unit of the guards] An error of `tolerance` times this in a guard is just tolerable.
    fn guard_scale(&self) -> f64;

    /// The modes after the guards in `crossed` fell through zero at `t`; may reset first-order states.
    fn cross(&self, modes: &Self::Modes, t: f64, y: &mut [f64; N], crossed: &Crossed) -> Reset<Self::Modes>;
}

/// [`Problem::rates_in_row`] by the rates of four states at a time.
#[inline(always)]
pub fn by_halves<const N: usize>(
    t: &Row,
    y: &[Row; N],
    rates: &mut [Row; N],
    of: impl Fn(Row<1>, &[Row<1>; N], &mut [Row<1>; N]),
) {
    let (mut own, mut found) = ([Row::ZERO; N], [Row::ZERO; N]);
    for half in [0, 1] {
        for (own, all) in own.iter_mut().zip(y) {
            *own = all.half(half);
        }
        of(t.half(half), &own, &mut found);
        for (rate, found) in rates.iter_mut().zip(&found) {
            rate.set_half(half, *found);
        }
    }
}

/// [`Problem::rates_in_row`] by the rates of each state.
pub fn one_by_one<const N: usize, P: Problem<N> + ?Sized>(
    problem: &P,
    modes: &P::Modes,
    t: &Row,
    y: &[Row; N],
    rates: &mut [Row; N],
) {
    let (times, states) = (t.numbers(), y.map(Row::numbers));
    let mut found = [[0.0; ROW]; N];
    for node in 0..ROW {
        let mut own = [0.0; N];
        problem.rates(modes, times[node], &std::array::from_fn(|i| states[i][node]), &mut own);
        for (found, own) in found.iter_mut().zip(own) {
            found[node] = own;
        }
    }
    *rates = found.map(Row::of);
}
