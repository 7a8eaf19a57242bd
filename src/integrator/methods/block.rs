//! `cong8`: a block predictor-corrector method of Runge–Kutta–Nyström type (N. H. Cong, K. Strehmel, R. Weiner, Adv.
//! Comput. Math. 10 (1999) 115). A step is a block of eight nodes; the accelerations at all nodes are evaluated
//! together.
//!
//! ```text
//!   t − h₋    previous block, h₋          t                 block (step), h                   t + h
//!   |+──+─────+──────+───────+─────+────+─|+────+────────+─────────+──────────+─────────+──────+──|
//!                                       c₀ c₁   c₂       c₃        c₄         c₅        c₆     c₇ c₈
//!   a₋₀ … a₋₈                           a₀ a₁   a₂       a₃        a₄         a₅        a₆     a₇ a₈
//!                                          ^    ^        ^         ^          ^         ^      ^  ^
//!   a₋(x), polynomial of degree 8 ─────────┴────┴────────┴─────────┴──────────┴─────────┴──────┴──┘  extrapolation
//!
//!   predictor: a_j from a₋(x)                                   ── integrals of ℓ_j ──> v_i, q_i at all nodes
//!   corrector: a_j = f(t + c_j·h, q_j, v_j), j = 1 … 8 together  ── A, B ──────────────> v_i, q_i at all nodes
//!              three rounds of the corrector; five without a previous block
//!   end:       state q₈, v₈; its rates f(t + h, q₈, v₈) are a₀ of the next block
//! ```
//!
//! Symbols: q positions, v velocities or first-order states, a their rates, t and h [s] start and length of the step,
//! c₀ = 0 the start and c₁ … c₈ the nodes of Radau's right quadrature (`NODES`: 0.0225, 0.1147, 0.2658, 0.4528, 0.6474,
//! 0.8198, 0.9437, 1), ℓ_j the Lagrange polynomials through c₀ … c₈. The accelerations a_j at t + c_j·h define a
//! polynomial of degree eight, a(t + x·h) = Σ_j ℓ_j(x)·a_j. Its integrals from the start give the states at the nodes:
//!
//! ```text
//! v(t + c_i·h) = v + h·Σ_j A_ij·a_j,               A_ij = ∫ ℓ_j(x) dx,
//! q(t + c_i·h) = q + c_i·h·v + h²·Σ_j B_ij·a_j,    B_ij = ∫ (c_i − x)·ℓ_j(x) dx,   both from 0 to c_i.
//! ```
//!
//! Predictor: with r = h/h₋ the point x of the step is the point 1 + r·x of the previous block, so that a(t + x·h) =
//! Σ_j ℓ_j(1 + r·x)·a₋_j. For r = 1 the integrals of ℓ_j(1 + x) are constants (`EXTRAPOLATION`). Otherwise the
//! polynomial is expanded in powers of x about the point 1 (`POWERS`), scaled by powers of r and integrated term by
//! term (`MONOMIALS`). A failed attempt predicts the shorter attempt that follows, from the same start: its polynomial
//! is expanded about the point 0. Without history, at the start of a motion or after an event, a = a₀ is predicted.
//!
//! Corrector: a round evaluates the rates at the predicted states of all nodes and integrates them. A round gains two
//! orders, because positions are integrated twice from accelerations. Three rounds suffice after a prediction by a
//! previous block and five without history. Radau's quadrature makes the velocity at the end exact for accelerations up
//! to degree 14.
//!
//! Dense output: the integrals of a(t + x·h) from the nearer end of the step, expanded in powers of x about it, so that no
//! evaluation is needed and states inside a long step are as accurate as at its end.
//!
//! Error estimate: the change of the end's rates after the last round, which shows how far the corrector has converged,
//! and the coefficient of degree eight of the accelerations in Legendre polynomials, which is small unless they have a
//! discontinuity.
//!
//! A step is stable up to 2.3 over the angular frequency of an oscillation and up to 1.2 over the rate of a decay.
//!
//! Evaluating the rates at eight states together takes little more time than at two: with a single state the processor
//! waits for its own results.

mod nodes;

use crate::integrator::dense_output::Step;
use crate::integrator::method::{Attempt, ERROR_SHARE, Method, MethodKind, Properties};
use crate::integrator::snapshot::{Reader, Snapshot};
use crate::integrator::state::{StepPoint, first_invalid, is_valid};
use crate::integrator::system::{StateLayout, System};
use crate::math::{F64x8, Fused, ROW, Real, unroll};
use nodes::{EXTRAPOLATION, INTEGRALS, MONOMIALS, NODES, PER_INTEGRAL, POWERS, TOP_DEGREE_WEIGHTS, Tables};

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
    keeps_length: true,
    error_share: ERROR_SHARE,
    others: &[],
};
/// Number of corrector rounds after a prediction from the previous block.
const CORRECTOR_ROUNDS: usize = 3;
/// Number of corrector rounds without history.
const CORRECTOR_ROUNDS_WITHOUT_HISTORY: usize = 5;
/// A step longer than this many times the previous block is not predicted from it.
const MAX_LENGTH_RATIO: f64 = 2.5;
/// Lengths of steps whose ratio differs from 1 by less than this are equal.
const ROUNDING: f64 = 1e-9;
/// Factors of the change of the end's rates after the last round in the error of a velocity and of a position. The
/// remaining correction grows with a high power of the time in the step, and another round would reduce it further.
const CORRECTION_FACTORS: [f64; 2] = [1.0 / 32.0, 1.0 / 288.0];
/// Factor of the accelerations' part of degree eight in the error; the part is small unless they have a discontinuity.
const TOP_DEGREE_FACTOR: f64 = 0.02;

/// History of the predictor: the rates in the previous block, or in an attempt that failed.
#[derive(Clone, Debug, PartialEq)]
struct BlockHistory {
    /// [s] Start of the block.
    begin: f64,
    /// [s] End of the block; equal to `begin` without history.
    end: f64,
    /// Rates at the block's start.
    start: Vec<f64>,
    /// Rates at the block's nodes.
    nodes: Vec<F64x8>,
    /// Whether the motion has gone on without an event since then, so that the polynomial predicts the next step.
    goes_on: bool,
}

impl BlockHistory {
    fn new(states: usize) -> Self {
        Self { begin: 0.0, end: 0.0, start: vec![0.0; states], nodes: vec![F64x8::ZERO; states], goes_on: false }
    }

    /// Whether there is a history.
    fn is_some(&self) -> bool {
        self.end > self.begin
    }

    /// The point of the previous block at which a step of `h` from `t` starts: its start (0) or its end (1). `None` if
    /// the step cannot be predicted.
    fn origin(&self, t: f64, h: f64) -> Option<usize> {
        let length = self.end - self.begin;
        if !self.goes_on || length <= 0.0 || h > MAX_LENGTH_RATIO * length {
            None
        } else if t == self.end {
            Some(1)
        } else {
            (t == self.begin).then_some(0)
        }
    }

    /// Coefficients of the polynomial of rate `i` about `origin`: the constant term, and those of the powers 1 to 8 of the share of
    /// the block, each times one of `powers`. For shares of a new step, `powers` are those of the ratio of its length to that of
    /// the block.
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

    /// Writes the state at `t` in the `step`, which is the block: integrals of the polynomials from the nearer end of the step.
    fn write(&self, step: &Step<'_>, t: f64, y: &mut [f64]) {
        let StateLayout { positions: p, states, .. } = step.layout;
        let share = (t - step.t) / step.h;
        let (origin, x, from) = if share < 0.5 { (0, share, step.y0) } else { (1, share - 1.0, step.y1) };
        let (powers, time) = (powers_of(x), x * step.h);
        for i in p..states {
            let (first, others) = self.coefficients(origin, powers, i);
            y[i] = from[i] + time * (first + (PER_INTEGRAL[0] * others).sum());
            if i < 2 * p {
                let twice = 0.5 * first + (PER_INTEGRAL[1] * others).sum();
                y[i - p] = from[i - p] + time * (from[i] + time * twice);
            }
        }
    }
}

/// The powers 1 to 8 of a number.
#[inline(always)]
fn powers_of(x: f64) -> F64x8 {
    let mut powers = [x; ROW];
    unroll!(true, n in 1..ROW, ROW => {
        powers[n] = powers[n - 1] * x;
    });
    F64x8::of(powers)
}

/// The block method with eight nodes.
#[derive(Clone, Debug)]
pub struct Cong8 {
    history: BlockHistory,
    /// Rates at the nodes in the last attempt.
    nodes: Vec<F64x8>,
    /// States at the nodes.
    y: Vec<F64x8>,
}

impl Cong8 {
    /// The method for `states` states.
    pub fn new(states: usize) -> Self {
        let rows = || vec![F64x8::ZERO; states];
        Self { history: BlockHistory::new(states), nodes: rows(), y: rows() }
    }
}

/// The states at a step's nodes, integrated from accelerations.
struct States<'a> {
    start: &'a [f64],
    layout: StateLayout,
    h: f64,
    y: &'a mut [F64x8],
}

impl States<'_> {
    /// Integrates all velocities and first-order states: `weights(i)` are the coefficients by which the columns of
    /// `tables` are multiplied for state `i`.
    #[inline(always)]
    fn integrate(&mut self, tables: &Tables, weights: impl Fn(usize) -> (f64, F64x8)) {
        let StateLayout { positions: p, states, .. } = self.layout;
        for i in p..states {
            let (first, others) = weights(i);
            let numbers = others.numbers();
            // Separate sums of even and odd columns halve the chain of dependent operations.
            let mut sums = [[tables[0][0] * first, F64x8::ZERO], [tables[1][0] * first, F64x8::ZERO]];
            unroll!(true, j < ROW => {
                let weight = F64x8::constant(numbers[j]);
                sums[0][j % 2] = tables[0][1 + j].multiply_add(weight, sums[0][j % 2]);
                sums[1][j % 2] = tables[1][1 + j].multiply_add(weight, sums[1][j % 2]);
            });
            let [once, twice] = sums.map(|[even, odd]| even + odd);
            self.set_state(i, once, twice);
        }
    }

    /// Integrates rates that keep their values at the start.
    fn integrate_constant(&mut self, rates: &[f64]) {
        let StateLayout { positions: p, states, .. } = self.layout;
        let [once, twice] = [MONOMIALS[0][0], MONOMIALS[1][0]];
        for (i, rate) in rates.iter().enumerate().take(states).skip(p) {
            self.set_state(i, once * *rate, twice * *rate);
        }
    }

    /// Sets velocity (or first-order state) `i` and its position from the integrals `once` and `twice` of its rate.
    #[inline(always)]
    fn set_state(&mut self, i: usize, once: F64x8, twice: F64x8) {
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
                at_nodes.integrate(&EXTRAPOLATION, |i| (history.start[i], history.nodes[i]));
            } else {
                let powers = powers_of(ratio);
                at_nodes.integrate(&MONOMIALS, |i| history.coefficients(origin, powers, i));
            }
            CORRECTOR_ROUNDS
        } else {
            at_nodes.integrate_constant(&start.rates);
            CORRECTOR_ROUNDS_WITHOUT_HISTORY
        };
        for _ in 0..rounds {
            system.rates_in_row(&start.discrete, &t, at_nodes.y, nodes);
            at_nodes.integrate(&INTEGRALS, |i| (start.rates[i], nodes[i]));
        }
        for (y, at_nodes) in end.y.iter_mut().zip(&*at_nodes.y) {
            *y = at_nodes.last();
        }
        let StepPoint { y, rates, .. } = end;
        system.rates_and_event_functions(&start.discrete, start.t + h, y, rates, &mut attempt.events);
        for i in p..states {
            let (first, at) = (start.rates[i], nodes[i]);
            let last_correction = (rates[i] - at.last()).abs();
            let top =
                TOP_DEGREE_FACTOR * TOP_DEGREE_WEIGHTS.0.multiply_add(first, (TOP_DEGREE_WEIGHTS.1 * at).sum()).abs();
            attempt.error[i] = h * (last_correction * CORRECTION_FACTORS[0] + top);
            if i < 2 * p {
                attempt.error[i - p] = h * h * (last_correction * CORRECTION_FACTORS[1] + 0.3 * top);
            }
        }
        attempt.unseen.fill(0.0);
        (ROW * rounds) as u64 + 1
    }

    fn remember(&mut self, start: &StepPoint<D>, end: f64) {
        let Self { history, nodes, .. } = self;
        (history.begin, history.end, history.goes_on) = (start.t, end, true);
        history.start.copy_from_slice(&start.rates);
        std::mem::swap(&mut history.nodes, nodes);
    }

    fn inside(&self, step: &Step<'_>, t: f64, y: &mut [f64]) -> bool {
        let history = &self.history;
        let known = history.is_some() && (step.t, step.h) == (history.begin, history.end - history.begin);
        if known {
            history.write(step, t, y);
        }
        known && first_invalid(y).is_none()
    }

    fn forget(&mut self) {
        self.history.goes_on = false;
    }

    fn save(&self, snapshot: &mut Snapshot) {
        let BlockHistory { begin, end, start, nodes, goes_on } = &self.history;
        snapshot.integers.extend([self.history.is_some(), *goes_on].map(u64::from));
        if self.history.is_some() {
            snapshot.reals.extend([begin, end]);
            snapshot.reals.extend(start);
            snapshot.reals.extend(nodes.iter().flat_map(|row| row.numbers()));
        }
    }

    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        let BlockHistory { begin, end, start, nodes, goes_on } = &mut self.history;
        (*begin, *end) = (0.0, 0.0);
        let known = reader.integer()? != 0;
        *goes_on = reader.integer()? != 0;
        if known {
            [*begin, *end] = reader.reals()?;
            reader.fill(start)?;
            for row in nodes {
                *row = F64x8::of(reader.reals()?);
            }
        }
        (*begin <= *end && start.iter().all(|rate| is_valid(*rate))).then_some(())
    }
}
