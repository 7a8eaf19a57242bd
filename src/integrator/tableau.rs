//! Butcher tableaux, as printed in their sources and summed up by the compiler.

use super::block::Past;
use super::memory::Front;
use super::method::{Character, Method};
use super::problem::Problem;
use super::regime::Manner;
use super::stages::Attempt;

/// Most stages that a method may have.
pub const STAGES: usize = 12;

/// Coefficients of an explicit Runge-Kutta method with up to two error estimates.
#[derive(Clone, Copy, Debug)]
pub struct Tableau {
    /// Number of stages.
    pub stages: usize,
    /// Order of the solution that is carried on.
    pub order: u32,
    /// Stage coefficients, strictly lower triangular.
    pub a: [[f64; STAGES]; STAGES],
    /// Weights of the solution.
    pub b: [f64; STAGES],
    /// Nodes.
    pub c: [f64; STAGES],
    /// Weights of the error estimate: the solution's minus those of the embedded one. All zero for
    /// a method without one.
    pub error: [f64; STAGES],
    /// Weights of a second, lower-order estimate, where the method has one.
    pub coarse_error: Option<[f64; STAGES]>,
    /// The power of the step with which the error estimate falls.
    pub error_power: f64,
    /// The last stage is at the step's end: its weights are those of the solution, its rates the next step's first.
    pub first_same_as_last: bool,
}

/// An explicit Runge-Kutta method.
pub trait Explicit: Send + Sync + 'static {
    /// Name in the `solver.method` enumeration.
    const NAME: &'static str;
    /// Its coefficients.
    const TABLEAU: Tableau;
    /// Events are located and landed on.
    const LOCATES: bool = true;
}

impl<E: Explicit> Method for E {
    const NAME: &'static str = E::NAME;
    const ORDER: u32 = E::TABLEAU.order;
    const ADAPTIVE: bool = E::TABLEAU.first_weighed_stage() != 0;
    const COARSE: bool = E::TABLEAU.coarse_error.is_some();
    const LOCATES: bool = E::LOCATES;
    const CHARACTER: Character = Character {
        error_power: E::TABLEAU.error_power,
        interpolates: true,
        gives_end: E::TABLEAU.first_same_as_last,
        predicts: false,
    };
    type Room<const N: usize> = ();

    fn attempt<const N: usize, P: Problem<N> + ?Sized>(
        made: &mut Attempt<N>,
        (): &mut (),
        problem: &P,
        start: &Front<N, P::Modes>,
        _past: &Past<N>,
        h: f64,
        _manner: Manner,
    ) -> u64 {
        made.explicitly::<E, P>(problem, start, h);
        E::TABLEAU.stages as u64 - 1
    }
}

impl Tableau {
    /// Rows of different lengths as one square array.
    pub const fn rows(rows: &[&[f64]]) -> [[f64; STAGES]; STAGES] {
        let mut a = [[0.0; STAGES]; STAGES];
        let mut i = 0;
        while i < rows.len() {
            a[i] = Self::row(rows[i]);
            i += 1;
        }
        a
    }

    /// One row, filled up with zeros.
    pub const fn row(row: &[f64]) -> [f64; STAGES] {
        let mut full = [0.0; STAGES];
        let mut j = 0;
        while j < row.len() {
            full[j] = row[j];
            j += 1;
        }
        full
    }

    /// The difference of two rows of weights.
    pub const fn difference(weights: &[f64], embedded: &[f64]) -> [f64; STAGES] {
        let mut full = Self::row(weights);
        let mut j = 0;
        while j < embedded.len() {
            full[j] -= embedded[j];
            j += 1;
        }
        full
    }

    /// Number of stages before the step's end is known.
    pub const fn inner_stages(&self) -> usize {
        if self.first_same_as_last { self.stages - 1 } else { self.stages }
    }

    /// The first stage after the first of all that an error estimate weighs; 0 without an estimate.
    pub const fn first_weighed_stage(&self) -> usize {
        let mut i = 1;
        while i < self.stages {
            if self.error[i] != 0.0 {
                return i;
            }
            i += 1;
        }
        0
    }

    /// Each row sums to its node, the weights to one and the error's weights to zero.
    pub const fn is_consistent(&self) -> bool {
        let mut i = 0;
        while i < self.stages {
            // A row of Verner's holds coefficients near 200, printed to double precision.
            if !is_small(sum(&self.a[i]) - self.c[i], 1e-13) {
                return false;
            }
            i += 1;
        }
        let coarse = match &self.coarse_error {
            Some(weights) => sum(weights),
            None => 0.0,
        };
        is_small(sum(&self.b) - 1.0, 1e-14) && is_small(sum(&self.error), 1e-14) && is_small(coarse, 1e-14)
    }
}

const fn sum(row: &[f64; STAGES]) -> f64 {
    let mut total = 0.0;
    let mut j = 0;
    while j < STAGES {
        total += row[j];
        j += 1;
    }
    total
}

const fn is_small(x: f64, bound: f64) -> bool {
    x < bound && -x < bound
}
