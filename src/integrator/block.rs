//! A step by its accelerations at several instants, which are computed together.
//!
//! In a step of `h` from t, positions and velocities follow from the accelerations a_j at the instants t + c_j·h as if those
//! were on a polynomial:
//!
//! v(t + c_i·h) = v + h·Σ A_ij·a_j,  q(t + c_i·h) = q + c_i·h·v + h²·Σ B_ij·a_j,
//! A_ij = ∫ ℓ_j over 0..c_i, B_ij = ∫∫ ℓ_j.
//!
//! The accelerations are first predicted by the polynomial of the last step and then computed at the states that follow, all
//! at once, which corrects the states. Two more such rounds, and the step is done; the first step of a motion, or after an
//! event, has nothing to go on from and takes more. A round gains two orders, since positions follow from accelerations
//! at one go. A step that failed predicts the shorter one after it; of one that is as long as the last the prediction takes
//! one table. (Block predictor-corrector methods of Runge-Kutta-Nyström type: N. H. Cong, K. Strehmel, R. Weiner, Adv. Comput.
//! Math. 10 (1999) 115.)
//!
//! A step is stable up to 2.3 over the frequency of an oscillation, and up to 1.2 over the rate of a decay.
//!
//! The rates at eight states together take little more time than at two: a single state leaves the processor waiting
//! for its own results.

use super::controller::is_kept;
use super::memory::Front;
use super::nodes::{AHEAD, INTEGRALS, MONOMIALS, NODES, POWERS, TOP, Tables};
use super::problem::{Extent, Problem};
use super::stages::Attempt;
use crate::math::{Fused, ROW, Real, Row, each};

/// Rounds after the prediction, where there is a step to predict from, and where there is none.
const ROUNDS: usize = 3;
const FIRST_ROUNDS: usize = 5;
/// A step this many times as long as the last is not predicted from it.
const FARTHEST: f64 = 2.5;
/// Two steps whose lengths differ by less than this share are as long as each other.
const ROUNDING: f64 = 1e-9;
/// How much of a step's error follows from what its end's rates moved by after the last round: what was left to correct grows
/// with a high power of the time in the step, and the rounds' own gain is the rest.
const LATE: [f64; 2] = [1.0 / 32.0, 1.0 / 288.0];
/// And from the part of degree eight in the accelerations: small, unless they have a kink.
const BENT: f64 = 0.02;

/// The rates in a step that was made so, or in an attempt that failed: what the next one is predicted from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past<const N: usize> {
    /// [s] When the step began.
    pub begin: f64,
    /// [s] When it ended; as `begin` where there is none.
    pub end: f64,
    /// Rates at its start.
    pub start: [f64; N],
    /// Rates at its nodes.
    pub nodes: [Row; N],
}

impl<const N: usize> Past<N> {
    /// None.
    pub const NONE: Self = Self { begin: 0.0, end: 0.0, start: [0.0; N], nodes: [Row::ZERO; N] };

    /// There is one.
    pub fn is_some(&self) -> bool {
        self.end > self.begin
    }

    /// Forgets it.
    pub fn forget(&mut self) {
        self.end = self.begin;
    }

    /// Where in it a step of `h` from `t` begins: at its start (0) or its end (1).
    fn origin(&self, t: f64, h: f64) -> Option<usize> {
        let length = self.end - self.begin;
        if length <= 0.0 || h > FARTHEST * length {
            None
        } else if t == self.end {
            Some(1)
        } else {
            (t == self.begin).then_some(0)
        }
    }

    /// Whether a run at `time` can have come to this.
    pub fn is_sound(&self, extent: Extent) -> bool {
        self.begin <= self.end && self.start.iter().take(extent.states).all(|rate| is_kept(*rate))
    }
}

/// The states at a step's nodes, as they follow from accelerations.
struct States<'a, const N: usize> {
    start: &'a [f64; N],
    extent: Extent,
    h: f64,
    y: [Row; N],
}

impl<const N: usize> States<'_, N> {
    /// From weights of columns for every velocity (and first-order state).
    #[inline(always)]
    fn follow(&mut self, tables: &Tables, weights: impl Fn(usize) -> (f64, Row)) {
        let Extent { positions: p, states, .. } = self.extent;
        for i in p..states {
            let (first, others) = weights(i);
            let numbers = others.numbers();
            // Even and odd columns apart: half as long to wait.
            let mut sums = [[tables[0][0] * first, Row::ZERO], [tables[1][0] * first, Row::ZERO]];
            each!(true, j < ROW => {
                let weight = Row::constant(numbers[j]);
                sums[0][j % 2] = tables[0][1 + j].times_plus(weight, sums[0][j % 2]);
                sums[1][j % 2] = tables[1][1 + j].times_plus(weight, sums[1][j % 2]);
            });
            let [once, twice] = sums.map(|[even, odd]| even + odd);
            self.place(i, once, twice);
        }
    }

    /// From rates that stay as they are at the start.
    fn go_on(&mut self, rates: &[f64; N]) {
        let Extent { positions: p, states, .. } = self.extent;
        let [once, twice] = [MONOMIALS[0][0], MONOMIALS[1][0]];
        for (i, rate) in rates.iter().enumerate().take(states).skip(p) {
            self.place(i, once * *rate, twice * *rate);
        }
    }

    /// Velocity `i` (or a first-order state) and its position by what the integrals add to them.
    #[inline(always)]
    fn place(&mut self, i: usize, once: Row, twice: Row) {
        let Self { start, h, y, extent: Extent { positions: p, .. }, .. } = self;
        y[i] = once.times_plus(*h, Row::constant(start[i]));
        if i < 2 * *p {
            let shift = Row::of(NODES) * *h;
            y[i - *p] = twice.times_plus(*h * *h, shift.times_plus(start[i], Row::constant(start[i - *p])));
        }
    }
}

impl<const N: usize> Past<N> {
    /// Coefficients of the polynomial of rate `i` about the `origin` of a step that is `ratio` times as long, in powers of
    /// its share: of 1, and of those from the first on.
    #[inline(always)]
    fn coefficients(&self, origin: usize, powers: Row, i: usize) -> (f64, Row) {
        let (first, at) = (self.start[i], self.nodes[i].numbers());
        let columns = &POWERS[origin];
        let mut sums = [columns[0] * first, Row::ZERO];
        each!(true, j < ROW => {
            sums[j % 2] = columns[1 + j].times_plus(at[j], sums[j % 2]);
        });
        (if origin == 0 { first } else { at[ROW - 1] }, (sums[0] + sums[1]) * powers)
    }
}

impl<const N: usize> Attempt<N> {
    /// Attempts a step of `h` from `start`, and tells how many evaluations of the rates it took.
    #[inline(never)]
    pub fn in_block<P: Problem<N> + ?Sized>(
        &mut self,
        problem: &P,
        start: &Front<N, P::Modes>,
        past: &Past<N>,
        h: f64,
    ) -> u64 {
        let extent = Extent::of(problem);
        let Extent { positions: p, states, .. } = extent;
        let t = Row::of(NODES).times_plus(h, Row::constant(start.t));
        let mut at_nodes = States { start: &start.y, extent, h, y: [Row::ZERO; N] };
        let rounds = if let Some(origin) = past.origin(start.t, h) {
            let ratio = h / (past.end - past.begin);
            if origin == 1 && (ratio - 1.0).abs() < ROUNDING {
                at_nodes.follow(&AHEAD, |i| (past.start[i], past.nodes[i]));
            } else {
                let mut powers = [ratio; ROW];
                each!(true, n in 1..ROW, ROW => {
                    powers[n] = powers[n - 1] * ratio;
                });
                let powers = Row::of(powers);
                at_nodes.follow(&MONOMIALS, |i| past.coefficients(origin, powers, i));
            }
            ROUNDS
        } else {
            at_nodes.go_on(&start.rates);
            FIRST_ROUNDS
        };
        for _ in 0..rounds {
            problem.rates_in_row(&start.modes, &t, &at_nodes.y, &mut self.nodes);
            at_nodes.follow(&INTEGRALS, |i| (start.rates[i], self.nodes[i]));
        }
        for (i, y) in at_nodes.y.iter().enumerate() {
            self.y[i] = y.last();
        }
        let Self { y, rates, guards, .. } = self;
        problem.rates_and_guards(&start.modes, start.t + h, y, rates, guards);
        for i in p..states {
            let (first, at) = (start.rates[i], self.nodes[i]);
            let late = (self.rates[i] - at.last()).abs();
            let top = BENT * TOP.0.times_plus(first, (TOP.1 * at).sum()).abs();
            self.error[i] = h * (late * LATE[0] + top);
            if i < 2 * p {
                self.error[i - p] = h * h * (late * LATE[1] + 0.3 * top);
            }
        }
        self.unseen = [0.0; N];
        (ROW * rounds) as u64 + 1
    }
}
