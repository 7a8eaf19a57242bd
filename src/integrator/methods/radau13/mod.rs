//! `radau13`: the collocation method of Radau IIA type with seven stages, of order 13, for stiff motion (E. Hairer,
//! G. Wanner, J. Comput. Appl. Math. 111 (1999) 93; Solving Ordinary Differential Equations II, IV.8). It is L-stable,
//! and a stage has order 7: the order does not fall in stiff motion as that of a linearly implicit method does.
//!
//! A step follows, in each state, the polynomial of degree seven from y that satisfies the equations at the nodes c_i of
//! Radau's right quadrature, the last of which is the step's end. The changes z_i = y(t + c_i·h) − y satisfy
//!
//! ```text
//! z_i = h·Σ_j a_ij·f(t + c_j·h, y + z_j),      i = 1 … 7.
//! ```
//!
//! Newton's method solves them with the exact Jacobian J at one stage, as it is predicted or, if that does not converge, as it
//! has become. It is the fifth: with it 22 machines in stiff motion took 0.84 of the evaluations that they took with J at the
//! step's start (0.91 with the fourth, 0.86 with the sixth, 0.90 at the end).
//!
//! With A⁻¹ = V·Λ·U, U = V⁻¹, and w = U·z, a correction falls apart into equations of the size of the system, one
//! real and three complex ones; `modes` below:
//!
//! ```text
//! (λ_k/h − J)·Δw_k = (U·f)_k − λ_k/h·w_k,      z = V·w.
//! ```
//!
//! The four matrices are factorised together, in the four numbers of a register. The stages of a state fill a row of eight,
//! in which the last stage stands twice; `second_order` eliminates the positions.
//!
//! Newton's method begins with the polynomial of the last step or, without one, with constant accelerations. It has
//! converged once the error that is left, which follows from the ratio of two corrections, is a small share of the
//! tolerance. If it does not converge, the step is repeated, shorter. A step after which it would hardly converge is not
//! made: the ratio of the corrections bounds the next step through the error.
//!
//! Error estimate: the difference from a quadrature of order 7 with the additional node 0, of weight h/λ₁, filtered by
//! (1 − h/λ₁·J)⁻¹ so that it stays bounded in stiff motion: (1 − h/λ₁·J)⁻¹·(h/λ₁·f(t, y) + Σ e_i·z_i).

mod tables;

use crate::integrator::dense_output::Step;
use crate::integrator::linear::FourFactors;
use crate::integrator::method::{Attempt, ERROR_SHARE, Method, MethodKind, NOT_CONVERGED, Properties};
use crate::integrator::second_order;
use crate::integrator::snapshot::{Reader, Snapshot};
use crate::integrator::state::{StepPoint, is_valid};
use crate::integrator::step_control::{SAFETY, norm};
use crate::integrator::system::{Jacobian, StateLayout, System, one_by_one};
use crate::math::{Complex4, F64x8, Fused, Real};
use tables::{EIGENVALUES, ERROR, NODES, STAGES, TO_MODES, TO_STAGES};

/// Power of the step to which the error estimate is proportional.
const ERROR_POWER: i32 = STAGES as i32 + 1;
/// Maximum number of Jacobians in an attempt.
const MAX_JACOBIANS: usize = 2;
/// Maximum number of Newton iterations with one Jacobian.
const MAX_ITERATIONS: usize = 10;
/// Newton's method has converged once the error that is left is this share of the tolerance: the errors of all steps have the
/// same sign, and add up.
const CONVERGED: f64 = 0.005;
/// Ratio of two corrections that is assumed after the first.
const FIRST_RATIO: f64 = 0.1;
/// Newton's method does not converge if a correction is larger than this share of the one before.
const MAX_RATIO: f64 = 0.9;
/// A ratio of two corrections that a step should have. The ratio is about proportional to the step.
const GOOD_RATIO: f64 = 0.15;
/// A step longer than this many times the last one is not predicted from it.
const MAX_LENGTH_RATIO: f64 = 6.0;
/// The stage at which the equations are linearised.
const LINEARISED: usize = 4;

const PROPERTIES: Properties = Properties {
    name: "radau13",
    order: 13,
    adaptive: true,
    coarse: false,
    locates: true,
    error_power: ERROR_POWER as f64,
    interpolates: false,
    gives_end: false,
    predicts: true,
    keeps_length: false,
    error_share: ERROR_SHARE,
    others: &[],
};

/// History of the predictor: the polynomial of the last step, or of an attempt that failed.
#[derive(Clone, Debug)]
struct History {
    /// [s] Start of the step.
    begin: f64,
    /// [s] End of the step; equal to `begin` without history.
    end: f64,
    /// z of the step.
    changes: Vec<F64x8>,
    /// Whether the motion has gone on without an event since then, so that the polynomial predicts the next step.
    goes_on: bool,
}

/// The seven-stage method.
#[derive(Clone, Debug)]
pub struct Radau13 {
    history: History,
    /// Whether `changes` are those of a step: whether Newton's method has converged.
    converged: bool,
    jacobian: Jacobian,
    factors: FourFactors,
    /// z: changes of the states from the step's start to its stages.
    changes: Vec<F64x8>,
    /// w.
    modes: Vec<Complex4>,
    /// Right-hand side of a correction, then the correction Δw.
    correction: Vec<Complex4>,
    /// States at the stages.
    y: Vec<F64x8>,
    /// Rates at the stages.
    rates: Vec<F64x8>,
}

impl Radau13 {
    /// The method for `states` states.
    pub fn new(states: usize) -> Self {
        let rows = || vec![F64x8::ZERO; states];
        let modes = || vec![Complex4::ZERO; states];
        Self {
            history: History { begin: 0.0, end: 0.0, changes: rows(), goes_on: false },
            converged: false,
            jacobian: Jacobian::new(states),
            factors: FourFactors::with_capacity(states),
            changes: rows(),
            modes: modes(),
            correction: modes(),
            y: rows(),
            rates: rows(),
        }
    }

    /// The derivatives of the rates in the last attempt, as workspace for other uses between attempts.
    pub fn jacobian(&mut self) -> &mut Jacobian {
        &mut self.jacobian
    }

    /// Predicts z of a step of `h` [s] from `start` with `positions` positions.
    #[inline(never)] // keeps the frame below the equations' own small
    fn predict<D>(&mut self, start: &StepPoint<D>, h: f64, positions: usize) {
        let Self { history, changes, .. } = self;
        let Some(origin) = history.origin(start.t, h) else {
            let time = NODES * h;
            for (i, change) in changes.iter_mut().enumerate() {
                *change = time * start.rates[i];
                if i < positions {
                    *change += time * time * (0.5 * start.rates[positions + i]);
                }
            }
            return;
        };
        let weights = weights(NODES * (h / (history.end - history.begin)) + origin);
        for (change, before) in changes.iter_mut().zip(&history.changes) {
            let passed = if origin > 0.0 { before.last() } else { 0.0 };
            *change = combined(&weights, before.numbers(), F64x8::constant(-passed));
        }
    }

    /// Computes the Jacobian where the equations are linearised in a step of `h` [s] from `start`, and the factors; `y` is
    /// workspace.
    fn linearise<D: Copy>(&mut self, system: &dyn System<Discrete = D>, start: &StepPoint<D>, h: f64, y: &mut [f64]) {
        let Self { jacobian, factors, changes, .. } = self;
        for ((y, start), change) in y.iter_mut().zip(&start.y).zip(&*changes) {
            let there = start + change.numbers()[LINEARISED];
            *y = if is_valid(there) { there } else { *start };
        }
        system.jacobian(&start.discrete, start.t + NODES.numbers()[LINEARISED] * h, y, jacobian);
        let StateLayout { positions, states, .. } = system.layout();
        let shift = EIGENVALUES.reciprocal() * h;
        factors.of(states - positions, |i, j| second_order::element(jacobian, positions, shift, i, j));
    }

    /// Solves for z by Newton's method. Returns the number of iterations and the largest ratio of two successive corrections;
    /// [`converged`](Self::converged) is then known.
    #[inline(never)] // keeps the frame below the equations' own small
    fn iterate<D: Copy>(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        attempt: &mut Attempt,
    ) -> (usize, f64) {
        let Self { converged, jacobian, factors, changes, modes, correction, y, rates, .. } = self;
        let layout = system.layout();
        let (shift, per_step) = (EIGENVALUES.reciprocal() * h, EIGENVALUES * (1.0 / h));
        for (mode, change) in modes.iter_mut().zip(&*changes) {
            *mode = to_modes(*change);
        }
        let t = NODES.multiply_add(h, F64x8::constant(start.t));
        let (mut before, mut worst) = (f64::INFINITY, 0.0_f64);
        *converged = false;
        for iteration in 1..=MAX_ITERATIONS {
            for ((y, change), start) in y.iter_mut().zip(&*changes).zip(&start.y) {
                *y = *change + *start;
            }
            if system.suits_blocks() {
                system.rates_in_row(&start.discrete, &t, y, rates);
            } else {
                // Eight instants together would save no time, and take more stack.
                one_by_one(&|t, y, rates| system.rates(&start.discrete, t, y, rates), &t, y, rates);
            }
            for ((correction, rate), mode) in correction.iter_mut().zip(&*rates).zip(&*modes) {
                *correction = to_modes(*rate) - per_step * *mode;
            }
            second_order::solve(jacobian, layout.positions, shift, correction, |rest| factors.solve(rest));
            for (i, correction) in correction.iter().enumerate() {
                modes[i] = modes[i] + *correction;
                let change = combined(&TO_STAGES, correction.row().numbers(), F64x8::ZERO);
                changes[i] += change;
                attempt.error[i] = (change * change).sum().sqrt();
            }
            let size = norm(attempt, &start.y, system.scales(), layout, false, CONVERGED * attempt.tolerance);
            if !size.is_finite() {
                return (iteration, f64::INFINITY);
            }
            let mut ratio = FIRST_RATIO;
            if iteration > 1 {
                ratio = size / before;
                worst = worst.max(ratio);
            }
            let left = |iterations: usize| {
                let shrinkage = (0..iterations).fold(1.0, |product, _| product * ratio);
                shrinkage * size * ratio / (1.0 - ratio.min(MAX_RATIO))
            };
            if left(0) <= 1.0 {
                *converged = true;
                return (iteration, worst);
            }
            if iteration > 1 && (ratio > MAX_RATIO || left(MAX_ITERATIONS - iteration) > 1.0) {
                return (iteration, worst);
            }
            before = size;
        }
        (MAX_ITERATIONS, worst)
    }

    /// Writes the state at the end of a step from `start`. Where it is invalid, the step has not converged, and the state at
    /// the start is written.
    fn write_end<D>(&mut self, start: &StepPoint<D>, y: &mut [f64]) {
        for ((y, start), change) in y.iter_mut().zip(&start.y).zip(&self.changes) {
            let end = start + change.last();
            self.converged &= is_valid(end);
            *y = if is_valid(end) { end } else { *start };
        }
    }

    /// Writes the error estimate of a step of `h` [s] from `start`.
    fn estimate<D>(&mut self, start: &StepPoint<D>, h: f64, positions: usize, error: &mut [f64]) {
        let Self { jacobian, factors, changes, correction, .. } = self;
        let shift = EIGENVALUES.reciprocal() * h;
        for ((right, rate), change) in correction.iter_mut().zip(&start.rates).zip(&*changes) {
            *right = Complex4::real(rate + (ERROR * *change).sum() / shift.first());
        }
        second_order::solve(jacobian, positions, shift, correction, |rest| factors.solve(rest));
        for (error, found) in error.iter_mut().zip(&*correction) {
            *error = found.first();
        }
    }
}

impl<D: Copy> Method<D> for Radau13 {
    fn properties(&self) -> &Properties {
        &PROPERTIES
    }

    fn kind(&self) -> MethodKind {
        MethodKind::Implicit
    }

    fn begin(&mut self, _system: &dyn System<Discrete = D>) {
        self.history.end = self.history.begin;
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
        let layout = system.layout();
        let positions = layout.positions;
        self.predict(start, h, positions);
        attempt.unseen.fill(0.0);
        let (mut evaluations, mut ratio) = (0, 0.0);
        for _ in 0..MAX_JACOBIANS {
            self.linearise(system, start, h, &mut end.y);
            let iterations;
            (iterations, ratio) = self.iterate(system, start, h, attempt);
            attempt.jacobians += 1;
            // The Jacobian counts as one evaluation.
            evaluations += STAGES * iterations + 1;
            self.write_end(start, &mut end.y);
            if self.converged || !ratio.is_finite() {
                break;
            }
        }
        if self.converged {
            self.estimate(start, h, positions, &mut attempt.error);
            let tolerance = ERROR_SHARE * attempt.tolerance;
            let size = norm(attempt, &start.y, system.scales(), layout, false, tolerance);
            let least = (0..ERROR_POWER).fold(1.0, |power, _| power * (SAFETY * ratio / GOOD_RATIO)).min(1.0);
            if size < least {
                let factor = least / size.max(f64::MIN_POSITIVE);
                attempt.error.iter_mut().for_each(|error| *error *= factor);
            }
        } else {
            // A step to an event is part of one that has been accepted.
            if self.history.contains(start.t, start.t + h) {
                self.history.write(&start.y, start.t + h, &mut end.y);
            }
            for (error, scale) in attempt.error.iter_mut().zip(system.scales()) {
                *error = NOT_CONVERGED * scale;
            }
        }
        evaluations as u64
    }

    fn remember(&mut self, start: &StepPoint<D>, end: f64) {
        let Self { history, changes, converged, .. } = self;
        if *converged {
            (history.begin, history.end, history.goes_on) = (start.t, end, true);
            history.changes.copy_from_slice(changes);
        }
    }

    fn inside(&self, step: &Step<'_>, t: f64, y: &mut [f64]) -> bool {
        let known = step.h == self.history.end - self.history.begin && self.history.contains(step.t, t);
        if known {
            self.history.write(step.y0, t, y);
        }
        known
    }

    fn forget(&mut self) {
        self.history.goes_on = false;
    }

    fn save(&self, snapshot: &mut Snapshot) {
        let History { begin, end, changes, goes_on } = &self.history;
        snapshot.integers.extend([end > begin, *goes_on].map(u64::from));
        if end > begin {
            snapshot.reals.extend([begin, end]);
            snapshot.reals.extend(changes.iter().flat_map(|row| row.numbers().into_iter().take(STAGES)));
        }
    }

    fn load(&mut self, reader: &mut Reader<'_>) -> Option<()> {
        let History { begin, end, changes, goes_on } = &mut self.history;
        (*begin, *end) = (0.0, 0.0);
        let known = reader.integer()? != 0;
        *goes_on = reader.integer()? != 0;
        if known {
            [*begin, *end] = reader.reals()?;
            for row in changes {
                let stages: [f64; STAGES] = reader.reals()?;
                *row = F64x8::of(std::array::from_fn(|stage| stages[stage.min(STAGES - 1)]));
            }
        }
        (*begin <= *end).then_some(())
    }
}

impl History {
    /// The point of the last step at which a step of `h` [s] from `t` starts: its start (0) or its end (1). `None` if the step
    /// cannot be predicted.
    fn origin(&self, t: f64, h: f64) -> Option<f64> {
        let length = self.end - self.begin;
        if !self.goes_on || length <= 0.0 || h > MAX_LENGTH_RATIO * length {
            None
        } else if t == self.end {
            Some(1.0)
        } else {
            (t == self.begin).then_some(0.0)
        }
    }

    /// Whether `t` lies in the step, which started at `start`.
    fn contains(&self, start: f64, t: f64) -> bool {
        start == self.begin && self.begin < t && t <= self.end
    }

    /// Writes the state at `t` in the step that started from `start`.
    fn write(&self, start: &[f64], t: f64, y: &mut [f64]) {
        let weights = weights((t - self.begin) / (self.end - self.begin));
        for ((y, start), change) in y.iter_mut().zip(start).zip(&self.changes) {
            let change = weights.iter().zip(change.numbers()).fold(0.0, |sum, (weight, change)| sum + weight * change);
            *y = start + change;
        }
    }
}

/// U times the numbers of the stages.
fn to_modes(stages: F64x8) -> Complex4 {
    Complex4::from_row(combined(&TO_MODES, stages.numbers(), F64x8::ZERO))
}

/// The sum of the `columns` times `numbers`, and `term`.
#[inline(always)]
fn combined<const COLUMNS: usize>(columns: &[F64x8; COLUMNS], numbers: [f64; 8], term: F64x8) -> F64x8 {
    columns.iter().zip(numbers).fold(term, |sum, (column, number)| column.multiply_add(number, sum))
}

/// Weights of z₁ … z₇ in the polynomial of a step through 0 at its start, at the share `x` of the step.
fn weights<R: Real>(x: R) -> [R; STAGES] {
    let nodes = NODES.numbers();
    std::array::from_fn(|j| {
        let others = (0..STAGES).filter(|k| *k != j).map(|k| nodes[k]).chain([0.0]);
        others.fold(R::ONE, |product, other| product * ((x - other) * (1.0 / (nodes[j] - other))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// V times complex numbers.
    fn to_stages(modes: Complex4) -> [f64; 8] {
        combined(&TO_STAGES, modes.row().numbers(), F64x8::ZERO).numbers()
    }

    #[test]
    fn the_modes_are_those_of_collocation_at_the_nodes() {
        // A·c^k = c^(k + 1)/(k + 1), hence A⁻¹·c^(k + 1) = (k + 1)·c^k.
        for k in 0..STAGES as i32 {
            let powers = F64x8::of(NODES.numbers().map(|c| c.powi(k + 1)));
            let found = to_stages(EIGENVALUES * to_modes(powers));
            for (found, c) in found.iter().zip(NODES.numbers()) {
                let wanted = f64::from(k + 1) * c.powi(k);
                assert!((found - wanted).abs() < 1e-11, "{found} is not {wanted} for power {k} at {c}");
            }
            for (found, power) in to_stages(to_modes(powers)).iter().zip(powers.numbers()) {
                assert!((found - power).abs() < 1e-12, "{found} is not {power}");
            }
        }
    }

    #[test]
    fn the_error_estimate_sees_the_first_power_that_a_quadrature_of_order_seven_misses() {
        // z = x^k on a step of length 1 has the rate k·x^(k − 1) and the estimate f(0)/λ₁ + Σ e_i·z_i.
        for k in 1..=STAGES as i32 + 1 {
            let changes = F64x8::of(NODES.numbers().map(|c| c.powi(k)));
            let rate = if k == 1 { EIGENVALUES.reciprocal().first() } else { 0.0 };
            let estimate = rate + (ERROR * changes).sum();
            assert_eq!(estimate.abs() < 1e-14, k <= STAGES as i32, "{estimate:e} for power {k}");
        }
    }

    #[test]
    fn a_polynomial_of_degree_seven_is_continued_exactly() {
        let polynomial = |x: f64| x * (1.0 + x * (0.5 - x.powi(5)));
        for x in [0.0, 0.3, 1.0, 1.4] {
            let weights = weights(x);
            let found: f64 = weights.iter().zip(NODES.numbers()).map(|(weight, c)| weight * polynomial(c)).sum();
            assert!((found - polynomial(x)).abs() < 1e-11, "{found} at {x}");
        }
    }
}
