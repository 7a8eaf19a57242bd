//! Rosenbrock methods: linearly implicit, one factorisation a step, with the exact Jacobian J.
//!
//! Stage i solves (1/(hγ) − J)·u_i = f(t + α_i·h, y + Σ a_ij·u_j) + Σ (c_ij/h)·u_j + γ_i·h·∂f/∂t, and the
//! step ends at y + Σ m_j·u_j (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.7, in
//! the variables of (7.25)). Positions drop out: their rates are velocities, so that u of a position is
//! hγ times its right side plus u of its velocity, and only velocities and first-order states are
//! solved for.

use super::block::Past;
use super::linear::Factors;
use super::memory::Front;
use super::method::{Character, Method, Room};
use super::problem::{Extent, Jacobian, Problem};
use super::regime::Manner;
use super::stages::Attempt;

/// Stages of the methods here.
pub const STAGES: usize = 6;

/// Coefficients of a Rosenbrock method.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    /// Order of the solution that is carried on.
    pub order: u32,
    /// γ.
    pub gamma: f64,
    /// α_i.
    pub nodes: [f64; STAGES],
    /// γ_i.
    pub slopes: [f64; STAGES],
    /// a_ij, strictly lower triangular.
    pub a: [[f64; STAGES]; STAGES],
    /// c_ij, strictly lower triangular.
    pub c: [[f64; STAGES]; STAGES],
    /// m_j.
    pub weights: [f64; STAGES],
    /// Weights of the error estimate.
    pub error: [f64; STAGES],
}

/// A Rosenbrock method.
pub trait Rosenbrock: Send + Sync + 'static {
    /// Name in the `solver.method` enumeration.
    const NAME: &'static str;
    /// Its coefficients.
    const COEFFICIENTS: Coefficients;
}

/// The method of these coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Implicit<R>(std::marker::PhantomData<R>);

/// What a step works with.
pub struct Workspace<const N: usize> {
    jacobian: Jacobian<N>,
    factors: Factors<N>,
    stages: [[f64; N]; STAGES],
}

impl<const N: usize> Workspace<N> {
    /// The derivatives of the rates at the start of the last attempt, or what was written since.
    pub fn jacobian(&mut self) -> &mut Jacobian<N> {
        &mut self.jacobian
    }
}

impl<const N: usize> Room for Workspace<N> {
    const NEW: Self = Self { jacobian: Jacobian::ZERO, factors: Factors::NONE, stages: [[0.0; N]; STAGES] };
}

impl<R: Rosenbrock> Method for Implicit<R> {
    const NAME: &'static str = R::NAME;
    const ORDER: u32 = R::COEFFICIENTS.order;
    const ADAPTIVE: bool = true;
    const COARSE: bool = false;
    const LOCATES: bool = true;
    const CHARACTER: Character =
        Character { error_power: R::COEFFICIENTS.order as f64, interpolates: false, gives_end: false, predicts: false };
    type Room<const N: usize> = Workspace<N>;

    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        room: &mut Workspace<N>,
        problem: &P,
        start: &Front<N, P::Modes>,
        _past: &Past<N>,
        h: f64,
        _manner: Manner,
    ) -> u64 {
        let Workspace { jacobian, factors, stages: u } = room;
        let method = const { &R::COEFFICIENTS };
        let Extent { positions: p, states, .. } = Extent::of(problem);
        let g = method.gamma * h;
        problem.jacobian(&start.modes, start.t, &start.y, jacobian);
        factors.of(states - p, |i, j| {
            let row = &jacobian.state[p + i];
            let unit = if i == j { 1.0 } else { 0.0 };
            let through_position = if j < p { g * row[j] } else { 0.0 };
            unit - g * (row[p + j] + through_position)
        });
        for i in 0..STAGES {
            let (earlier, later) = u.split_at_mut(i);
            let right = &mut later[0];
            if i == 0 {
                *right = start.rates;
            } else {
                sum(&mut made.y, &start.y, &method.a[i], earlier, states);
                problem.rates(&start.modes, start.t + method.nodes[i] * h, &made.y, right);
                let couplings = method.c[i].map(|c| c / h);
                for (k, right) in right.iter_mut().enumerate().take(states) {
                    *right += couplings.iter().zip(&*earlier).map(|(c, u)| c * u[k]).sum::<f64>();
                }
            }
            for (right, slope) in right.iter_mut().zip(&jacobian.time).take(states) {
                *right += method.slopes[i] * h * slope;
            }
            solve(factors, jacobian, g, p, states, right);
        }
        sum(&mut made.y, &start.y, &method.weights, u, states);
        sum(&mut made.error, &[0.0; N], &method.error, u, states);
        made.unseen = [0.0; N];
        // The Jacobian counts as one.
        STAGES as u64
    }
}

/// Turns a stage's right side into its u.
fn solve<const N: usize>(
    factors: &Factors<N>,
    jacobian: &Jacobian<N>,
    g: f64,
    p: usize,
    states: usize,
    right: &mut [f64; N],
) {
    let (of_positions, rest) = right[..states].split_at_mut(p);
    for (row, right) in jacobian.state[p..states].iter().zip(rest.iter_mut()) {
        let through: f64 = row[..p].iter().zip(&*of_positions).map(|(slope, right)| slope * right).sum();
        *right = g * (*right + g * through);
    }
    factors.solve(rest);
    for (position, velocity) in of_positions.iter_mut().zip(rest) {
        *position = g * (*position + *velocity);
    }
}

/// `sum` = `y` + Σ weight_j·u_j.
fn sum<const N: usize>(sum: &mut [f64; N], y: &[f64; N], weights: &[f64; STAGES], u: &[[f64; N]], states: usize) {
    for (k, (sum, y)) in sum.iter_mut().zip(y).enumerate().take(states) {
        *sum = *y + weights.iter().zip(u).map(|(weight, u)| weight * u[k]).sum::<f64>();
    }
}
