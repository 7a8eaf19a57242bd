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
//! at one go. (Block predictor-corrector methods of Runge-Kutta-Nyström type: N. H. Cong, K. Strehmel, R. Weiner, Adv. Comput.
//! Math. 10 (1999) 115.)
//!
//! A step is stable up to 2.3 over the frequency of an oscillation, and up to 1.2 over the rate of a decay.
//!
//! The rates at eight states together take little more time than at two: a single state leaves the processor waiting
//! for its own results.

use super::controller::is_kept;
use super::memory::Front;
use super::nodes::{INTEGRALS, MONOMIALS, NODES, POINTS, POWERS, TOP};
use super::problem::{Extent, Problem};
use super::stages::Attempt;
use crate::math::{Fused, ROW, Real, Row, each};

/// Rounds after the prediction, where there is a step to predict from, and where there is none.
const ROUNDS: usize = 3;
const FIRST_ROUNDS: usize = 5;
/// A step this many times as long as the last is not predicted from it.
const FARTHEST: f64 = 2.5;
/// How much of a step's error follows from what its end's rates moved by after the last round: what was left to correct grows
/// with a high power of the time in the step, and the rounds' own gain is the rest.
const LATE: [f64; 2] = [1.0 / 32.0, 1.0 / 288.0];
/// And from the part of degree eight in the accelerations: small, unless they have a kink.
const BENT: f64 = 0.02;

/// Two tables by columns: of velocities and of positions.
type Tables = [[[f64; ROW]; POINTS]; 2];

/// The rates in a step that was made so: what the next one goes on from.
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

/// Quantities whose sums over a table are computed at a time: those wait for themselves alone, and a table is read once.
const TOGETHER: usize = 2;

/// The states at a step's nodes, as they follow from accelerations.
struct States<'a, const N: usize> {
    y0: &'a [f64; N],
    extent: Extent,
    h: f64,
    y: [Row; N],
}

impl<const N: usize> States<'_, N> {
    /// Takes the weights of columns for every velocity (and first-order state), and writes what follows from their sums.
    #[inline(always)]
    fn follow(&mut self, tables: &Tables, weights: impl Fn(usize) -> (f64, [f64; ROW])) {
        let forced = self.extent.states - self.extent.positions;
        let mut i = 0;
        while i + TOGETHER <= forced {
            self.follow_some::<TOGETHER>(tables, i, &weights);
            i += TOGETHER;
        }
        while i < forced {
            self.follow_some::<1>(tables, i, &weights);
            i += 1;
        }
    }

    #[inline(always)]
    fn follow_some<const W: usize>(&mut self, tables: &Tables, i: usize, weights: impl Fn(usize) -> (f64, [f64; ROW])) {
        let Self { y0, h, y, extent: Extent { positions: p, .. } } = self;
        let weights: [(f64, [f64; ROW]); W] = std::array::from_fn(|w| weights(i + w));
        let mut sums = [[Row::ZERO; 2]; W];
        each!(true, w < W => {
            sums[w] = [Row::of(tables[0][0]) * weights[w].0, Row::of(tables[1][0]) * weights[w].0];
        });
        each!(true, j < ROW => {
            let (once, twice) = (Row::of(tables[0][1 + j]), Row::of(tables[1][1 + j]));
            each!(true, w < W => {
                let [speed, place] = sums[w];
                let weight = Row::constant(weights[w].1[j]);
                sums[w] = [once.times_plus(weight, speed), twice.times_plus(weight, place)];
            });
        });
        let shift = Row::of(NODES) * *h;
        each!(true, w < W => {
            let (place, [once, twice]) = (i + w, sums[w]);
            y[*p + place] = once.times_plus(*h, Row::constant(y0[*p + place]));
            if place < *p {
                y[place] = twice.times_plus(*h * *h, shift.times_plus(y0[*p + place], Row::constant(y0[place])));
            }
        });
    }
}

impl<const N: usize> Past<N> {
    /// Coefficients of the polynomial of rate `i` about the `origin` of a step that is `ratio` times as long, in powers of
    /// its share: of 1, and of those from the first on.
    #[inline(always)]
    fn coefficients(&self, origin: usize, powers: Row, i: usize) -> (f64, [f64; ROW]) {
        let (first, at) = (self.start[i], self.nodes[i].numbers());
        let columns = &POWERS[origin];
        let mut sums = [Row::of(columns[0]) * first, Row::ZERO];
        each!(true, j < ROW => {
            sums[j % 2] = Row::of(columns[1 + j]).times_plus(at[j], sums[j % 2]);
        });
        (if origin == 0 { first } else { at[ROW - 1] }, ((sums[0] + sums[1]) * powers).numbers())
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
        let mut at_nodes = States { y0: &start.y, extent, h, y: [Row::ZERO; N] };
        let rounds = if let Some(origin) = past.origin(start.t, h) {
            let ratio = h / (past.end - past.begin);
            let mut powers = [ratio; ROW];
            each!(true, n in 1..ROW, ROW => {
                powers[n] = powers[n - 1] * ratio;
            });
            let powers = Row::of(powers);
            at_nodes.follow(&MONOMIALS, |i| past.coefficients(origin, powers, p + i));
            ROUNDS
        } else {
            at_nodes.follow(&MONOMIALS, |i| (start.rates[p + i], [0.0; ROW]));
            FIRST_ROUNDS
        };
        for _ in 0..rounds {
            problem.rates_in_row(&start.modes, &t, &at_nodes.y, &mut self.nodes);
            let nodes = &self.nodes;
            at_nodes.follow(&INTEGRALS, |i| (start.rates[p + i], nodes[p + i].numbers()));
        }
        for (i, y) in at_nodes.y.iter().enumerate() {
            self.y[i] = y.last();
        }
        let Self { y, rates, guards, .. } = self;
        problem.rates_and_guards(&start.modes, start.t + h, y, rates, guards);
        for i in 0..states - p {
            let (first, at) = (start.rates[p + i], self.nodes[p + i].numbers());
            let late = (self.rates[p + i] - at[ROW - 1]).abs();
            let mut top = TOP[0] * first;
            each!(true, j < ROW => {
                top = TOP[1 + j].times_plus(at[j], top);
            });
            let top = BENT * top.abs();
            self.error[p + i] = h * (late * LATE[0] + top);
            if i < p {
                self.error[i] = h * h * (late * LATE[1] + 0.3 * top);
            }
        }
        self.unseen = [0.0; N];
        (ROW * rounds) as u64 + 1
    }
}
