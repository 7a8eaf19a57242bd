//! Classification of a motion over many turns: Poincaré sections, divergence of neighbouring motions, periods.
//!
//! [`lyapunov`], [`exponents`] and [`verdict`] use no mechanism, only a [`Flow`], so that they can be tested on motions with known
//! results.

pub mod bifurcation;
pub mod continuation;
pub mod exponents;
pub mod lyapunov;
pub mod machine;
pub mod orbit;
pub mod poincare;
pub mod portrait;
pub mod response;
pub mod section;
pub mod spectrum;
pub mod tangent;
pub mod verdict;

pub use machine::Machine;

use anyhow::Result;

/// A motion that can be observed, perturbed and restarted.
pub trait Flow {
    /// [s] Current time.
    fn time(&self) -> f64;
    /// Advances to `time` [s].
    ///
    /// # Errors
    /// If it cannot go on.
    fn advance(&mut self, time: f64) -> Result<()>;
    /// The current point in phase space.
    fn point(&mut self) -> Point;
    /// Continues from another point.
    fn place(&mut self, point: &Point);
}

/// A point of phase space.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// [s]
    pub time: f64,
    /// All numbers that determine the further motion, each divided by the size of a noticeable difference. The discrete
    /// state decides which numbers there are.
    pub coordinates: Vec<f64>,
    /// How many of them, the last ones, do not change until the discrete state does: what contacts remember. In a contact that
    /// never opens they are a parameter of the motion rather than a part of it.
    pub remembered: usize,
    /// The discrete state, such as which contacts are closed.
    pub modes: Vec<bool>,
}

impl Point {
    /// Root mean square of the differences between two points with the same discrete state.
    pub fn distance(&self, other: &Self) -> f64 {
        let squares = self.coordinates.iter().zip(&other.coordinates).map(|(a, b)| (a - b).powi(2));
        (squares.sum::<f64>() / self.coordinates.len().max(1) as f64).sqrt()
    }
}
