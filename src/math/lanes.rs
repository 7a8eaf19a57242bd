//! Four numbers side by side.

use super::fused::Fused;
use std::array;
use std::ops::Add;
use wide::{CmpGt, CmpLt, f64x4};

/// How many numbers a [`Lanes`] holds.
pub const LANES: usize = 4;

/// Four numbers that are computed together, in one register on processors that have registers of four. The compiler
/// does not vectorise sums that are written out term by term.
pub trait Lanes<R>: Copy {
    /// Packs four numbers.
    fn of(numbers: [R; LANES]) -> Self;
    /// Adds `factor` times each of `numbers`.
    fn add(&mut self, factor: R, numbers: &[f64; LANES]);
    /// The sums of each two.
    fn plus(self, other: Self) -> Self;
    /// Unpacks the four numbers.
    fn numbers(self) -> [R; LANES];
}

/// The larger of each two; of equal ones, and where either is not a number, the second: what x86-64's instruction finds,
/// and that of AArch64 does not.
#[inline(always)]
pub(crate) fn larger(a: f64x4, b: f64x4) -> f64x4 {
    if cfg!(target_arch = "x86_64") { a.fast_max(b) } else { a.cmp_gt(b).blend(a, b) }
}

/// The smaller of each two; of equal ones, and where either is not a number, the second.
#[inline(always)]
pub(crate) fn smaller(a: f64x4, b: f64x4) -> f64x4 {
    if cfg!(target_arch = "x86_64") { a.fast_min(b) } else { a.cmp_lt(b).blend(a, b) }
}

impl Lanes<f64> for f64x4 {
    #[inline(always)]
    fn of(numbers: [f64; LANES]) -> Self {
        numbers.into()
    }

    #[inline(always)]
    fn add(&mut self, factor: f64, numbers: &[f64; LANES]) {
        let (factor, numbers) = (Self::splat(factor), Self::from(*numbers));
        *self = if cfg!(target_feature = "fma") { factor.mul_add(numbers, *self) } else { factor * numbers + *self };
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn numbers(self) -> [f64; LANES] {
        self.to_array()
    }
}

impl<R: Copy + Fused<f64> + Add<Output = R>> Lanes<R> for [R; LANES] {
    #[inline(always)]
    fn of(numbers: Self) -> Self {
        numbers
    }

    #[inline(always)]
    fn add(&mut self, factor: R, numbers: &[f64; LANES]) {
        *self = array::from_fn(|i| factor.multiply_add(numbers[i], self[i]));
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        array::from_fn(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn numbers(self) -> Self {
        self
    }
}
