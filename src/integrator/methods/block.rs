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

mod nodes;

use crate::integrator::method::{Attempt, ERROR_SHARE, Method, MethodKind, Properties};
use crate::integrator::snapshot::{Reader, Snapshot};
use crate::integrator::state::{StepPoint, is_kept};
use crate::integrator::system::{StateLayout, System};
use crate::math::{F64x8, Fused, ROW, Real, unroll};
use nodes::{AHEAD, INTEGRALS, MONOMIALS, NODES, POWERS, TOP, Tables};

const PROPERTIES: Properties = Properties {
    name: "cong8",
    order: 9,
    adaptive: true,
    coarse: false,
    locates: true,
    error_power: 12.0,
    interpolates: true,
    gives_end: true,
    predicts: true,
    error_share: ERROR_SHARE,
    others: &[],
};
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
/// And from the part of degree eight in the accelerations: small, unless they have a discontinuity.
const BENT: f64 = 0.02;

/// The rates in a step that was made so, or in an attempt that failed: what the next one is predicted from.
#[derive(Clone, Debug, PartialEq)]
struct BlockHistory {
    /// [s] When the step began.
    begin: f64,
    /// [s] When it ended; as `begin` where there is none.
    end: f64,
    /// Rates at its start.
    start: Vec<f64>,
    /// Rates at its nodes.
    nodes: Vec<F64x8>,
}

impl BlockHistory {
    fn new(states: usize) -> Self {
        Self { begin: 0.0, end: 0.0, start: vec![0.0; states], nodes: vec![F64x8::ZERO; states] }
    }

    /// There is one.
    fn is_some(&self) -> bool {
        self.end > self.begin
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

    /// Coefficients of the polynomial of rate `i` about the `origin` of a step that is `ratio` times as long, in powers of
    /// its share: of 1, and of those from the first on.
    #[inline(always)]
    fn coefficients(&self, origin: usize, powers: F64x8, i: usize) -> (f64, F64x8) {
        let (first, at) = (self.start[i], self.nodes[i].numbers());
        let columns = &POWERS[origin];
        let mut sums = [columns[0] * first, F64x8::ZERO];
        unroll!(true, j < ROW => {
            sums[j % 2] = columns[1 + j].multiply_add(at[j], sums[j % 2]);
        });
        (if origin == 0 { first } else { at[ROW - 1] }, (sums[0] + sums[1]) * powers)
    }
}

/// The method of eight nodes at a time.
#[derive(Clone, Debug)]
pub struct Cong8 {
    history: BlockHistory,
    /// Rates at the nodes of the last attempt.
    nodes: Vec<F64x8>,
    /// States there.
    y: Vec<F64x8>,
}

impl Cong8 {
    /// For so many states.
    pub fn new(states: usize) -> Self {
        let rows = || vec![F64x8::ZERO; states];
        Self { history: BlockHistory::new(states), nodes: rows(), y: rows() }
    }
}

/// The states at a step's nodes, as they follow from accelerations.
struct States<'a> {
    start: &'a [f64],
    layout: StateLayout,
    h: f64,
    y: &'a mut [F64x8],
}

impl States<'_> {
    /// From weights of columns for every velocity (and first-order state).
    #[inline(always)]
    fn follow(&mut self, tables: &Tables, weights: impl Fn(usize) -> (f64, F64x8)) {
        let StateLayout { positions: p, states, .. } = self.layout;
        for i in p..states {
            let (first, others) = weights(i);
            let numbers = others.numbers();
            // Even and odd columns apart: half as long to wait.
            let mut sums = [[tables[0][0] * first, F64x8::ZERO], [tables[1][0] * first, F64x8::ZERO]];
            unroll!(true, j < ROW => {
                let weight = F64x8::constant(numbers[j]);
                sums[0][j % 2] = tables[0][1 + j].multiply_add(weight, sums[0][j % 2]);
                sums[1][j % 2] = tables[1][1 + j].multiply_add(weight, sums[1][j % 2]);
            });
            let [once, twice] = sums.map(|[even, odd]| even + odd);
            self.place(i, once, twice);
        }
    }

    /// From rates that stay as they are at the start.
    fn go_on(&mut self, rates: &[f64]) {
        let StateLayout { positions: p, states, .. } = self.layout;
        let [once, twice] = [MONOMIALS[0][0], MONOMIALS[1][0]];
        for (i, rate) in rates.iter().enumerate().take(states).skip(p) {
            self.place(i, once * *rate, twice * *rate);
        }
    }

    /// Velocity `i` (or a first-order state) and its position by what the integrals add to them.
    #[inline(always)]
    fn place(&mut self, i: usize, once: F64x8, twice: F64x8) {
        let Self { start, h, y, layout: StateLayout { positions: p, .. }, .. } = self;
        y[i] = once.multiply_add(*h, F64x8::constant(start[i]));
        if i < 2 * *p {
            let shift = F64x8::of(NODES) * *h;
            y[i - *p] = twice.multiply_add(*h * *h, shift.multiply_add(start[i], F64x8::constant(start[i - *p])));
        }
    }
}

impl<D: Copy> Method<D> for Cong8 {
    fn properties(&self) -> &Properties {
        &PROPERTIES
    }

    fn kind(&self) -> MethodKind {
        MethodKind::Block
    }

    #[inline(never)]
    fn attempt(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        end: &mut StepPoint<D>,
        attempt: &mut Attempt,
    ) -> u64 {
        let Self { history, nodes, y } = self;
        let layout = system.layout();
        let StateLayout { positions: p, states, .. } = layout;
        let t = F64x8::of(NODES).multiply_add(h, F64x8::constant(start.t));
        let mut at_nodes = States { start: &start.y, layout, h, y };
        let rounds = if let Some(origin) = history.origin(start.t, h) {
            let ratio = h / (history.end - history.begin);
            if origin == 1 && (ratio - 1.0).abs() < ROUNDING {
                at_nodes.follow(&AHEAD, |i| (history.start[i], history.nodes[i]));
            } else {
                let mut powers = [ratio; ROW];
                unroll!(true, n in 1..ROW, ROW => {
                    powers[n] = powers[n - 1] * ratio;
                });
                let powers = F64x8::of(powers);
                at_nodes.follow(&MONOMIALS, |i| history.coefficients(origin, powers, i));
            }
            ROUNDS
        } else {
            at_nodes.go_on(&start.rates);
            FIRST_ROUNDS
        };
        for _ in 0..rounds {
            system.rates_in_row(&start.discrete, &t, at_nodes.y, nodes);
            at_nodes.follow(&INTEGRALS, |i| (start.rates[i], nodes[i]));
        }
        for (y, at_nodes) in end.y.iter_mut().zip(&*at_nodes.y) {
            *y = at_nodes.last();
        }
        let StepPoint { y, rates, .. } = end;
        system.rates_and_event_functions(&start.discrete, start.t + h, y, rates, &mut attempt.events);
        for i in p..states {
            let (first, at) = (start.rates[i], nodes[i]);
            let late = (rates[i] - at.last()).abs();
            let top = BENT * TOP.0.multiply_add(first, (TOP.1 * at).sum()).abs();
            attempt.error[i] = h * (late * LATE[0] + top);
            if i < 2 * p {
                attempt.error[i - p] = h * h * (late * LATE[1] + 0.3 * top);
            }
        }
        attempt.unseen.fill(0.0);
        (ROW * rounds) as u64 + 1
    }

    fn remember(&mut self, start: &StepPoint<D>, end: f64) {
        let Self { history, nodes, .. } = self;
        (history.begin, history.end) = (start.t, end);
        history.start.copy_from_slice(&start.rates);
        std::mem::swap(&mut history.nodes, nodes);
    }

    fn forget(&mut self) {
        self.history.end = self.history.begin;
    }

    fn save(&self, snapshot: &mut Snapshot) {
        let BlockHistory { begin, end, start, nodes } = &self.history;
        snapshot.integers.push(u64::from(self.history.is_some()));
        if self.history.is_some() {
            snapshot.reals.extend([begin, end]);
            snapshot.reals.extend(start);
            snapshot.reals.extend(nodes.iter().flat_map(|row| row.numbers()));
        }
    }

    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        let BlockHistory { begin, end, start, nodes } = &mut self.history;
        (*begin, *end) = (0.0, 0.0);
        if reader.integer()? != 0 {
            [*begin, *end] = reader.reals()?;
            reader.fill(start)?;
            for row in nodes {
                *row = F64x8::of(reader.reals()?);
            }
        }
        (*begin <= *end && start.iter().all(|rate| is_kept(*rate))).then_some(())
    }
}
