//! The numbers that the equations of motion are compiled for.

use super::joint::{Kernel, Kernels};
use crate::math::{Dual, Real, Row};

/// Derivatives along so many directions at a time: with 8 the Jacobian takes up to a fifth less time than
/// with 4, and is compiled in somewhat more (`cargo bench --bench jacobian`).
pub const DIRECTIONS: usize = 8;

/// A number with its derivatives along some of the states and time.
pub type Tangent = Dual<DIRECTIONS>;

/// A number that contact kernels are compiled for.
pub trait Scalar: Real {
    /// The kernel of a scene for this number.
    fn kernel<K: Kernel>(kernels: &Kernels<K>) -> &K::Of<Self>;
}

impl Scalar for f64 {
    #[inline(always)]
    fn kernel<K: Kernel>(kernels: &Kernels<K>) -> &K::Of<Self> {
        &kernels.value
    }
}

impl Scalar for Row {
    #[inline(always)]
    fn kernel<K: Kernel>(kernels: &Kernels<K>) -> &K::Of<Self> {
        &kernels.row
    }
}

impl Scalar for Row<1> {
    #[inline(always)]
    fn kernel<K: Kernel>(kernels: &Kernels<K>) -> &K::Of<Self> {
        &kernels.half
    }
}

impl Scalar for Tangent {
    #[inline(always)]
    fn kernel<K: Kernel>(kernels: &Kernels<K>) -> &K::Of<Self> {
        &kernels.tangent
    }
}
