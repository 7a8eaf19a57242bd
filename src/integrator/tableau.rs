//! Butcher tableaux, as printed in their sources; their consistency is checked at compile time.

/// Maximum number of stages of a method.
pub const MAX_STAGES: usize = 12;

/// Coefficients of an explicit Runge-Kutta method with up to two error estimates.
#[derive(Clone, Copy, Debug)]
pub struct Tableau {
    /// Name in the `solver.method` enumeration.
    pub name: &'static str,
    /// Number of stages.
    pub stages: usize,
    /// Order of the solution.
    pub order: u32,
    /// Stage coefficients, strictly lower triangular.
    pub a: [[f64; MAX_STAGES]; MAX_STAGES],
    /// Weights of the solution.
    pub b: [f64; MAX_STAGES],
    /// Nodes.
    pub c: [f64; MAX_STAGES],
    /// Weights of the error estimate: those of the solution less those of the embedded method; all zero without an
    /// embedded method.
    pub error: [f64; MAX_STAGES],
    /// Weights of a second, lower-order error estimate, where the method has one.
    pub coarse_error: Option<[f64; MAX_STAGES]>,
    /// The error estimate is proportional to the step raised to this power.
    pub error_power: f64,
    /// Whether the last stage is at the step's end with the weights of the solution; its rates are then the first of
    /// the next step.
    pub first_same_as_last: bool,
    /// Whether events are located and steps end at them; otherwise events are noticed at the end of a step.
    pub locates: bool,
}

impl Tableau {
    /// Combines rows of different lengths into one square array.
    pub const fn rows(rows: &[&[f64]]) -> [[f64; MAX_STAGES]; MAX_STAGES] {
        let mut a = [[0.0; MAX_STAGES]; MAX_STAGES];
        let mut i = 0;
        while i < rows.len() {
            a[i] = Self::row(rows[i]);
            i += 1;
        }
        a
    }

    /// One row, padded with zeros.
    pub const fn row(row: &[f64]) -> [f64; MAX_STAGES] {
        let mut full = [0.0; MAX_STAGES];
        let mut j = 0;
        while j < row.len() {
            full[j] = row[j];
            j += 1;
        }
        full
    }

    /// The difference of two rows of weights.
    pub const fn difference(weights: &[f64], embedded: &[f64]) -> [f64; MAX_STAGES] {
        let mut full = Self::row(weights);
        let mut j = 0;
        while j < embedded.len() {
            full[j] -= embedded[j];
            j += 1;
        }
        full
    }

    /// Number of stages before the step's end.
    pub const fn inner_stages(&self) -> usize {
        if self.first_same_as_last { self.stages - 1 } else { self.stages }
    }

    /// The first stage after stage 0 that the error estimate weighs; 0 without an estimate.
    pub const fn first_weighted_stage(&self) -> usize {
        let mut i = 1;
        while i < self.stages {
            if self.error[i] != 0.0 {
                return i;
            }
            i += 1;
        }
        0
    }

    /// Whether each row sums to its node, the weights to one and the weights of the error estimates to zero.
    pub const fn is_consistent(&self) -> bool {
        let mut i = 0;
        while i < self.stages {
            // A row of Verner's tableau has coefficients near 200, printed to double precision.
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

const fn sum(row: &[f64; MAX_STAGES]) -> f64 {
    let mut total = 0.0;
    let mut j = 0;
    while j < MAX_STAGES {
        total += row[j];
        j += 1;
    }
    total
}

const fn is_small(x: f64, bound: f64) -> bool {
    x < bound && -x < bound
}
