//! The number types for which the equations of motion are compiled.

use crate::math::{Dual, F64x8, Real};

/// Number of directions of derivatives that are computed at a time. With 8 the Jacobian takes up to a fifth less time
/// than with 4 (`cargo bench --bench jacobian`), but twice as much stack and code.
pub const DIRECTIONS: usize = 4;

/// A number with its derivatives with respect to some of the states and time.
pub type Tangent = Dual<DIRECTIONS>;

/// A number type for which the equations of motion are compiled: one state, eight states, or one state with
/// derivatives.
pub trait Scalar: Real {}

impl Scalar for f64 {}
impl Scalar for F64x8 {}
impl Scalar for Tangent {}
