//! Bathe's composite method at a fixed step: the trapezoidal rule over half the step, then the three-point backward
//! difference over all of it (K. J. Bathe, Computers and Structures 85 (2007) 437). The method is of second order and
//! L-stable: oscillations that are too fast for the step decay within a few steps.
//!
//! y₁ = y₀ + h/4·(f₀ + f₁), 3·y₂ = 4·y₁ − y₀ + h·f₂. Both equations have the form y = c + g·f(t, y), which Newton's
//! method solves with the exact Jacobian. If it does not converge, the attempt fails, and a step of a tenth is
//! attempted, down to a step that does not move time.

use crate::integrator::linear::Factors;
use crate::integrator::method::{Attempt, ERROR_SHARE, Method, MethodKind, Properties};
use crate::integrator::state::StepPoint;
use crate::integrator::system::{Jacobian, System};

/// Newton's method has converged once the correction of every state is at most this share of the state's scale.
const CORRECTION_TOLERANCE: f64 = 1e-9;
/// Share of a state's value that is added to that bound, for rounding.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;
/// Maximum number of Newton iterations.
const MAX_ITERATIONS: usize = 20;

const PROPERTIES: Properties = Properties {
    name: "bathe",
    order: 2,
    adaptive: false,
    coarse: false,
    locates: true,
    error_power: 2.0,
    interpolates: true,
    gives_end: false,
    predicts: false,
    keeps_length: false,
    error_share: ERROR_SHARE,
    others: &[],
};

/// The composite method.
#[derive(Clone, Debug)]
pub struct Bathe {
    jacobian: Jacobian,
    factors: Factors,
    /// c of the equation y = c + g·f(t, y).
    known: Vec<f64>,
    /// Rates, then the Newton correction.
    correction: Vec<f64>,
}

impl Bathe {
    /// The method for `states` states.
    pub fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        let (jacobian, factors) = (Jacobian::new(states), Factors::with_capacity(states));
        Self { jacobian, factors, known: zeros(), correction: zeros() }
    }

    /// Solves y = c + g·f(`t`, y) by Newton's method from the estimate `y`. Without convergence `y` is NaN afterwards.
    /// Returns the number of evaluations of the rates.
    fn solve<D: Copy>(
        &mut self,
        system: &dyn System<Discrete = D>,
        discrete: &D,
        t: f64,
        g: f64,
        y: &mut [f64],
    ) -> u64 {
        let Self { jacobian, factors, known, correction, .. } = self;
        let scales = &system.scales()[..system.layout().weighted];
        for iterations in 1..=MAX_ITERATIONS {
            system.rates(discrete, t, y, correction);
            system.jacobian(discrete, t, y, jacobian);
            factors.of(y.len(), |i, j| f64::from(u8::from(i == j)) - g * jacobian.row(i)[j]);
            for (i, correction) in correction.iter_mut().enumerate() {
                *correction = known[i] + g * *correction - y[i];
            }
            factors.solve(correction);
            for (y, correction) in y.iter_mut().zip(&*correction) {
                *y += correction;
            }
            let small = |((correction, scale), y): ((&f64, &f64), &f64)| {
                correction.abs() <= CORRECTION_TOLERANCE * scale + ROUNDINGS * y.abs()
            };
            if correction.iter().zip(scales).zip(&*y).all(small) {
                // A Jacobian counts as one evaluation.
                return 2 * iterations as u64;
            }
        }
        y.fill(f64::NAN);
        2 * MAX_ITERATIONS as u64
    }
}

impl<D: Copy> Method<D> for Bathe {
    fn properties(&self) -> &Properties {
        &PROPERTIES
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
        _attempt: &mut Attempt,
    ) -> u64 {
        let StepPoint { t, y, rates, discrete, .. } = start;
        // y₁ = y₀ + h/4·f₀ + h/4·f₁
        for (known, (y, rate)) in self.known.iter_mut().zip(y.iter().zip(rates)) {
            *known = y + 0.25 * h * rate;
        }
        end.y.copy_from_slice(y);
        let evaluations = self.solve(system, discrete, t + 0.5 * h, 0.25 * h, &mut end.y);
        if end.y.iter().any(|y| y.is_nan()) {
            return evaluations;
        }
        // y₂ = (4·y₁ − y₀)/3 + h/3·f₂
        for (known, (middle, y)) in self.known.iter_mut().zip(end.y.iter().zip(y)) {
            *known = (4.0 * middle - y) / 3.0;
        }
        evaluations + self.solve(system, discrete, t + h, h / 3.0, &mut end.y)
    }
}
