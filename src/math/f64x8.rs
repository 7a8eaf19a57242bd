//! Eight numbers that are computed together: the values of one quantity at eight instants of a step.

use super::fused::Fused;
use super::lanes::{LANES, larger, smaller};
use super::real::Real;
use super::sin_cos::{self, multiply_add};
use super::unroll::unroll;
use super::vec2::Vec2;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use wide::{CmpGt, f64x4};

/// How many numbers an [`F64x8`] holds.
pub const ROW: usize = REGISTERS * LANES;
const REGISTERS: usize = 2;

/// Eight numbers side by side. They fill two registers of four on processors that have such registers, so that one half
/// computes while the other waits for a result.
///
/// Each number has the bits that `f64` would have. A comparison of two `F64x8` holds only if it holds for all eight
/// pairs of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct F64x8([f64x4; REGISTERS]);

impl F64x8 {
    /// Packs eight numbers.
    #[inline(always)]
    pub const fn of(numbers: [f64; ROW]) -> Self {
        let [a, b, c, d, e, f, g, h] = numbers;
        Self([f64x4::new([a, b, c, d]), f64x4::new([e, f, g, h])])
    }

    /// Unpacks the eight numbers.
    #[inline(always)]
    pub fn numbers(self) -> [f64; ROW] {
        let ([a, b, c, d], [e, f, g, h]) = (self.0[0].to_array(), self.0[1].to_array());
        [a, b, c, d, e, f, g, h]
    }

    /// Packs two times four numbers.
    #[inline(always)]
    pub(super) const fn of_halves(halves: [f64x4; REGISTERS]) -> Self {
        Self(halves)
    }

    /// The first and the last four numbers.
    #[inline(always)]
    pub(super) const fn halves(self) -> [f64x4; REGISTERS] {
        self.0
    }

    /// The number at a place from 0 to 7.
    #[inline(always)]
    pub fn number(&self, place: usize) -> f64 {
        self.0[place / LANES].as_array_ref()[place % LANES]
    }

    /// Replaces the number at a place from 0 to 7.
    #[inline(always)]
    pub fn set(&mut self, place: usize, number: f64) {
        self.0[place / LANES].as_array_mut()[place % LANES] = number;
    }

    /// The last of the eight numbers.
    #[inline(always)]
    pub fn last(self) -> f64 {
        self.number(ROW - 1)
    }

    /// The sum of all eight numbers.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = (self.0[0] + self.0[1]).to_array();
        (a + b) + (c + d)
    }
}

impl F64x8 {
    #[inline(always)]
    fn each(self, of: impl Fn(f64x4) -> f64x4) -> Self {
        // Not by `map`, which the compiler does not always inline.
        let [first, second] = self.0;
        Self([of(first), of(second)])
    }

    #[inline(always)]
    fn with(self, other: Self, of: impl Fn(f64x4, f64x4) -> f64x4) -> Self {
        let ([first, second], [other_first, other_second]) = (self.0, other.0);
        Self([of(first, other_first), of(second, other_second)])
    }

    /// Applies a function that has no implementation for four numbers at a time.
    fn one_by_one(self, of: impl Fn(f64) -> f64) -> Self {
        self.each(|four| f64x4::new(four.to_array().map(&of)))
    }
}

impl Default for F64x8 {
    fn default() -> Self {
        Self::ZERO
    }
}

impl PartialEq<f64> for F64x8 {
    #[inline(always)]
    fn eq(&self, other: &f64) -> bool {
        self.0.iter().all(|four| four.to_array().iter().all(|number| number == other))
    }
}

impl PartialOrd for F64x8 {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let pairs = self.0.iter().zip(&other.0).flat_map(|(a, b)| a.to_array().into_iter().zip(b.to_array()));
        let mut compared = pairs.map(|(a, b)| a.partial_cmp(&b));
        let first = compared.next()?;
        compared.all(|next| next == first).then_some(first).flatten()
    }
}

impl PartialOrd<f64> for F64x8 {
    fn partial_cmp(&self, other: &f64) -> Option<Ordering> {
        self.partial_cmp(&Self::constant(*other))
    }
}

impl Neg for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|x| -x)
    }
}

impl Add for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl Sub for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl Mul for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl Div for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| a / b)
    }
}

impl Add<f64> for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + Self::constant(other)
    }
}

impl Sub<f64> for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        self - Self::constant(other)
    }
}

impl Mul<f64> for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * Self::constant(other)
    }
}

impl Div<f64> for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self / Self::constant(other)
    }
}

impl Mul<Vec2<Self>> for F64x8 {
    type Output = Vec2<Self>;
    #[inline(always)]
    fn mul(self, v: Vec2<Self>) -> Vec2<Self> {
        v * self
    }
}

impl AddAssign for F64x8 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for F64x8 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Fused for F64x8 {
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        Self(std::array::from_fn(|k| multiply_add(self.0[k], factor.0[k], term.0[k])))
    }
}

impl Fused<f64> for F64x8 {
    #[inline(always)]
    fn multiply_add(self, factor: f64, term: Self) -> Self {
        self.multiply_add(Self::constant(factor), term)
    }
}

impl Real for F64x8 {
    const MANY: bool = true;
    type Lanes = [Self; LANES];

    const ZERO: Self = Self([f64x4::ZERO; REGISTERS]);
    const ONE: Self = Self([f64x4::ONE; REGISTERS]);

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([f64x4::splat(value); REGISTERS])
    }
    /// The first of the eight numbers.
    #[inline(always)]
    fn value(self) -> f64 {
        self.0[0].to_array()[0]
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Self::ONE / self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(f64x4::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.each(f64x4::abs)
    }
    #[inline(always)]
    fn max(self, limit: f64) -> Self {
        // The limit is returned where both are equal and where the number is NaN.
        self.each(|x| larger(x, f64x4::splat(limit)))
    }
    #[inline(always)]
    fn min(self, limit: f64) -> Self {
        self.each(|x| smaller(x, f64x4::splat(limit)))
    }
    #[inline(always)]
    fn clamp(self, low: f64, high: f64) -> Self {
        self.each(|x| larger(f64x4::splat(low), x)).each(|x| smaller(f64x4::splat(high), x))
    }
    #[inline(always)]
    fn choose(self, then: impl FnOnce() -> Self, other: impl FnOnce() -> Self) -> Self {
        let (then, other) = (then(), other());
        Self(std::array::from_fn(|k| self.0[k].cmp_gt(f64x4::ZERO).blend(then.0[k], other.0[k])))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.with(sign, f64x4::copysign)
    }
    #[inline(always)]
    fn sin_cos<const K: usize>(x: [Self; K]) -> [(Self, Self); K] {
        let mut found = [(Self::ZERO, Self::ONE); K];
        unroll!(true, k < K => {
            let [first, second] = x[k].0;
            let ((sin_first, cos_first), (sin_second, cos_second)) =
                (sin_cos::of_four(first), sin_cos::of_four(second));
            found[k] = (Self([sin_first, sin_second]), Self([cos_first, cos_second]));
        });
        found
    }
    fn exp(self) -> Self {
        self.one_by_one(Real::exp)
    }
    fn tanh(self) -> Self {
        self.one_by_one(Real::tanh)
    }
    fn asinh(self) -> Self {
        self.one_by_one(Real::asinh)
    }
    fn powf(self, p: f64) -> Self {
        self.one_by_one(|x| Real::powf(x, p))
    }
    fn atan2(self, x: Self) -> Self {
        self.with(x, |y, x| {
            let (y, x) = (y.to_array(), x.to_array());
            f64x4::new(std::array::from_fn(|i| Real::atan2(y[i], x[i])))
        })
    }
}
