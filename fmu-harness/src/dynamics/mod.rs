//! What a motion is in the long run: where it pierces sections, how fast neighbours part, whether it repeats.
//!
//! [`lyapunov`] and [`verdict`] know no mechanism, only a [`Flow`], so that they can be tried on motions whose answers
//! are known.

pub mod bifurcation;
pub mod lyapunov;
pub mod machine;
pub mod portrait;
pub mod section;
pub mod spectrum;
pub mod verdict;

pub use machine::Machine;

use anyhow::Result;

/// A motion that can be looked at, perturbed and started anew.
pub trait Flow {
    /// [s] Where it is.
    fn time(&self) -> f64;
    /// Moves on.
    ///
    /// # Errors
    /// If it cannot go on.
    fn advance(&mut self, time: f64) -> Result<()>;
    /// The point of phase space where it is.
    fn point(&mut self) -> Point;
    /// Goes on from another point.
    fn place(&mut self, point: &Point);
}

/// A point of phase space.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// [s]
    pub time: f64,
    /// All numbers that decide how the motion goes on, each over the size of a noticeable difference. Which ones there
    /// are depends on the modes.
    pub coordinates: Vec<f64>,
    /// Contacts that are closed, or whatever else is discrete.
    pub modes: Vec<bool>,
}

impl Point {
    /// Root mean square of the differences, of points with equal modes.
    pub fn distance(&self, other: &Self) -> f64 {
        let squares = self.coordinates.iter().zip(&other.coordinates).map(|(a, b)| (a - b).powi(2));
        (squares.sum::<f64>() / self.coordinates.len().max(1) as f64).sqrt()
    }
}
