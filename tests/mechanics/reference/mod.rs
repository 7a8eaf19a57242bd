//! The mechanism solved a second way, from the equations of the model alone.
//!
//! Where the product cuts the loop and integrates minimal coordinates with Runge-Kutta pairs,
//! this keeps all nine coordinates of the three bodies, holds ideal joints and a prescribed crank
//! by Lagrange multipliers, and integrates by extrapolation. It shares the scene and the signals
//! with the product, and no equation. Slow and simple is fine here; wrong is not.

mod bodies;
mod constraints;
mod contact;
mod extrapolation;
mod laws;
mod ledger;
mod loads;
mod observe;
mod phase;
mod solver;
mod start;

pub use solver::{Crossing, Reference};
