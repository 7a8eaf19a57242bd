//! The numbers that the equations of motion are compiled for.

use crate::math::{Dual, Real, Row};

/// Derivatives along so many directions at a time: with 8 the Jacobian takes up to a fifth less time than
/// with 4, and is compiled in somewhat more (`cargo bench --bench jacobian`).
pub const DIRECTIONS: usize = 8;

/// A number with its derivatives along some of the states and time.
pub type Tangent = Dual<DIRECTIONS>;

/// What is compiled for each number and chosen once.
pub trait Kernel {
    /// The kernel for the number `R`.
    type Of<R: Real>: Clone + Copy + std::fmt::Debug;
}

/// A kernel for every number.
#[derive(Clone, Copy, Debug)]
pub struct Kernels<K: Kernel> {
    /// For plain numbers.
    pub value: K::Of<f64>,
    /// For eight numbers together.
    pub row: K::Of<Row>,
    /// For four numbers together.
    pub half: K::Of<Row<1>>,
    /// For numbers with derivatives.
    pub tangent: K::Of<Tangent>,
}

/// A number that the equations of motion are compiled for.
pub trait Scalar: Real {
    /// The kernel for this number.
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
