//! All Lyapunov exponents of a motion from its tangent: directions are made orthogonal again and again, and their growth
//! in between is recorded (G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9 and 21).

use super::lyapunov::{Exponent, standard_error};
use super::{Machine, tangent};
use anyhow::{Result, ensure};
use nalgebra::DMatrix;

/// A motion with directions of neighbouring motions.
pub trait TangentFlow {
    /// [s] Current time.
    fn time(&self) -> f64;
    /// Advances motion and directions to `time` [s].
    ///
    /// # Errors
    /// If it cannot go on.
    fn advance(&mut self, time: f64) -> Result<()>;
    /// Directions in columns, in numbers of which each has the same meaning.
    ///
    /// # Errors
    /// If the first order has ended since they were set.
    fn directions(&mut self) -> Result<DMatrix<f64>>;
    /// Replaces the directions.
    fn set_directions(&mut self, directions: &DMatrix<f64>);
}

impl TangentFlow for Machine<tangent::Tangent> {
    fn time(&self) -> f64 {
        super::Flow::time(self)
    }

    fn advance(&mut self, time: f64) -> Result<()> {
        super::Flow::advance(self, time)
    }

    fn directions(&mut self) -> Result<DMatrix<f64>> {
        self.directions()
    }

    fn set_directions(&mut self, directions: &DMatrix<f64>) {
        self.set_directions(directions);
    }
}

/// Settings for measuring exponents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// [s] Time between two orthogonalisations.
    pub interval: f64,
    /// Number of intervals.
    pub count: usize,
    /// Number of first intervals that do not count, in which the directions settle.
    pub settling: usize,
}

/// The exponents of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Exponents {
    /// All exponents, the largest first.
    pub all: Vec<Exponent>,
    /// Number of intervals.
    pub intervals: usize,
    /// Number of those that were left out because the first order ended in them, near grazing.
    pub left_out: usize,
}

impl Exponents {
    /// [1/s] Their sum: the mean rate at which volumes grow.
    pub fn sum(&self) -> f64 {
        self.all.iter().map(|exponent| exponent.value).sum()
    }

    /// The dimension of Kaplan and Yorke: k + (λ₁ + … + λ_k)/|λ_{k+1}| with the largest k for which the sum is not
    /// negative (J. L. Kaplan, J. A. Yorke, Lecture Notes in Mathematics 730 (1979) 204). The number of exponents if no
    /// sum is negative.
    pub fn dimension(&self) -> f64 {
        let mut sum = 0.0;
        for (number, exponent) in self.all.iter().enumerate() {
            if sum + exponent.value < 0.0 {
                return number as f64 + sum / exponent.value.abs();
            }
            sum += exponent.value;
        }
        self.all.len() as f64
    }
}

impl Measurement {
    /// Measures as many exponents as `flow` has directions.
    ///
    /// # Errors
    /// If nothing is free to move, the flow cannot go on, or the first order ends in more than half of the intervals.
    pub fn run<F: TangentFlow>(&self, flow: &mut F, mut tick: impl FnMut()) -> Result<Exponents> {
        let columns = flow.directions()?.ncols();
        ensure!(columns > 0, "the motion is prescribed and has no neighbouring motions");
        let mut growths = vec![vec![]; columns];
        let mut histories = vec![vec![]; columns];
        let (mut sums, mut span, mut last) = (vec![0.0; columns], 0.0, flow.time());
        let mut directions = orthogonal(&flow.directions()?).0;
        let mut left_out = 0;
        for number in 0..self.count {
            flow.set_directions(&directions);
            flow.advance(last + self.interval)?;
            let passed = flow.time() - last;
            last = flow.time();
            let grown = match flow.directions() {
                Ok(grown) => {
                    let (next, grown) = orthogonal(&grown);
                    directions = next;
                    grown
                }
                // The same directions go on behind the place.
                Err(error) => {
                    left_out += 1;
                    ensure!(2 * left_out <= self.count, "the first order ends too often: {error:#}");
                    tick();
                    continue;
                }
            };
            if number >= self.settling {
                span += passed;
                for (column, growth) in grown.into_iter().enumerate() {
                    sums[column] += growth;
                    growths[column].push((growth, passed));
                    histories[column].push((last, sums[column] / span));
                }
            }
            tick();
        }
        let exponent = |((sum, growths), history): ((f64, Vec<_>), Vec<_>)| Exponent {
            value: sum / span,
            error: standard_error(&growths),
            history,
        };
        let mut all: Vec<Exponent> = sums.into_iter().zip(growths).zip(histories).map(exponent).collect();
        all.sort_by(|a, b| b.value.total_cmp(&a.value));
        Ok(Exponents { all, intervals: self.count, left_out })
    }
}

/// Orthogonal directions of unit length that span the same spaces, and the logarithms of the lengths.
fn orthogonal(directions: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let factors = directions.clone().qr();
    let r = factors.r();
    // A direction that has collapsed on the others has no length; its growth is that of rounding.
    let grown = (0..directions.ncols()).map(|i| r[(i, i)].abs().max(f64::MIN_POSITIVE).ln()).collect();
    (factors.q(), grown)
}
