//! The mechanism solved a second way, from the equations of the model alone.
//!
//! Where the product cuts the loop and integrates minimal coordinates with Runge-Kutta pairs,
//! this keeps all coordinates of the three bodies, holds ideal joints and a prescribed crank by
//! Lagrange multipliers, sums a flexible rod over quadrature points, and integrates by
//! extrapolation. It knows nothing of the product: a mechanism is told it in words of its own
//! ([`Mechanism`]), and it answers in its own ([`Outputs`]). Slow and simple is fine here; wrong is
//! not.

mod beam;
mod bodies;
mod constraints;
mod contact;
mod coordinates;
mod crossing;
mod elimination;
mod extrapolation;
mod face;
mod film;
mod laws;
mod ledger;
mod loads;
mod mark;
pub mod mechanism;
mod observe;
mod phase;
mod quadrature;
pub mod signals;
mod solver;
mod standard;
mod start;

pub use crossing::Crossing;
pub use mechanism::Mechanism;
pub use signals::{Inputs, Outputs};
pub use solver::Reference;
