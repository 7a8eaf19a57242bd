//! The numbers that the equations of motion are compiled for.

use crate::math::{Dual, F64x8, Real};

/// Derivatives along so many directions at a time: with 8 the Jacobian takes up to a fifth less time than with 4
/// (`cargo bench --bench jacobian`), but twice as much stack and code.
pub const DIRECTIONS: usize = 4;

/// A number with its derivatives along some of the states and time.
pub type Tangent = Dual<DIRECTIONS>;

/// A number that the equations of motion are compiled for: one state, eight, or one with derivatives.
pub trait Scalar: Real {}

impl Scalar for f64 {}
impl Scalar for F64x8 {}
impl Scalar for Tangent {}
