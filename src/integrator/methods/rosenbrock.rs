//! Rosenbrock methods: linearly implicit, with the exact Jacobian J and one factorisation per step.
//!
//! Stage i solves (1/(hγ) − J)·u_i = f(t + α_i·h, y + Σ a_ij·u_j) + Σ (c_ij/h)·u_j + γ_i·h·∂f/∂t, and the step ends at
//! y + Σ m_j·u_j (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.7, in the variables of (7.25)).
//! `second_order` solves these equations.

use crate::integrator::linear::Factors;
use crate::integrator::method::{Attempt, ERROR_SHARE, Method, MethodKind, Properties};
use crate::integrator::second_order;
use crate::integrator::state::StepPoint;
use crate::integrator::system::{Jacobian, StateLayout, System};

/// Number of stages.
pub const STAGES: usize = 6;

/// Coefficients of a Rosenbrock method.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    /// Name in the `solver.method` enumeration.
    pub name: &'static str,
    /// Order of the solution.
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
#[derive(Clone, Debug)]
pub struct Rosenbrock {
    coefficients: &'static Coefficients,
    properties: Properties,
    jacobian: Jacobian,
    factors: Factors,
    /// u_i, one stage after the other.
    stages: Vec<f64>,
}

impl Rosenbrock {
    /// The method for `states` states.
    pub fn new(coefficients: &'static Coefficients, states: usize) -> Self {
        let properties = Properties {
            name: coefficients.name,
            order: coefficients.order,
            adaptive: true,
            coarse: false,
            locates: true,
            error_power: f64::from(coefficients.order),
            interpolates: false,
            gives_end: false,
            predicts: false,
            keeps_length: false,
            error_share: ERROR_SHARE,
            others: &[],
        };
        let (jacobian, factors) = (Jacobian::new(states), Factors::with_capacity(states));
        Self { coefficients, properties, jacobian, factors, stages: vec![0.0; STAGES * states] }
    }
}

impl<D: Copy> Method<D> for Rosenbrock {
    fn properties(&self) -> &Properties {
        &self.properties
    }

    fn kind(&self) -> MethodKind {
        MethodKind::Implicit
    }

    fn attempt(
        &mut self,
        system: &dyn System<Discrete = D>,
        start: &StepPoint<D>,
        h: f64,
        end: &mut StepPoint<D>,
        attempt: &mut Attempt,
    ) -> u64 {
        let Self { coefficients: method, jacobian, factors, stages: u, .. } = self;
        let StateLayout { positions: p, states, .. } = system.layout();
        let g = method.gamma * h;
        system.jacobian(&start.discrete, start.t, &start.y, jacobian);
        factors.of(states - p, |i, j| second_order::element(jacobian, p, g, i, j));
        for i in 0..STAGES {
            let (earlier, later) = u.split_at_mut(i * states);
            let right = &mut later[..states];
            if i == 0 {
                right.copy_from_slice(&start.rates);
            } else {
                sum(&mut end.y, |k| start.y[k], &method.a[i][..i], earlier);
                system.rates(&start.discrete, start.t + method.nodes[i] * h, &end.y, right);
                let couplings = method.c[i].map(|c| c / h);
                for (k, right) in right.iter_mut().enumerate() {
                    let coupled = couplings.iter().take(i).enumerate();
                    *right += coupled.map(|(j, c)| c * earlier[j * states + k]).sum::<f64>();
                }
            }
            for (right, slope) in right.iter_mut().zip(&jacobian.time) {
                *right += method.slopes[i] * h * slope;
            }
            second_order::solve(jacobian, p, g, right, |rest| factors.solve(rest));
        }
        sum(&mut end.y, |k| start.y[k], &method.weights, u);
        sum(&mut attempt.error, |_| 0.0, &method.error, u);
        attempt.unseen.fill(0.0);
        attempt.jacobians = 1;
        // The Jacobian counts as one evaluation.
        STAGES as u64
    }
}

/// Writes y + Σ weight_j·u_j of every state.
fn sum(sums: &mut [f64], y: impl Fn(usize) -> f64, weights: &[f64], u: &[f64]) {
    let states = sums.len();
    for (k, sum) in sums.iter_mut().enumerate() {
        *sum = y(k) + weights.iter().enumerate().map(|(j, weight)| weight * u[j * states + k]).sum::<f64>();
    }
}
