//! Forward-mode differentiation: numbers that carry their derivatives (A. Griewank, A. Walther, Evaluating Derivatives,
//! 2nd ed. 2008, 3.1: tangents, several directions at a time).

use super::fused::Fused;
use super::lanes::LANES;
use super::real::Real;
use super::vec2::Vec2;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number and its derivatives along `D` directions.
///
/// The value has the same bits as the same computation in `f64`. Where a function has a corner, the derivative is that
/// of the branch that the value takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const D: usize> {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub slope: [f64; D],
}

impl<const D: usize> Dual<D> {
    /// An independent variable: its derivative along `direction` is 1 and all others are 0.
    pub fn variable(value: f64, direction: usize) -> Self {
        let mut slope = [0.0; D];
        slope[direction] = 1.0;
        Self { value, slope }
    }

    /// The function g(`self`) whose value is g and whose derivative is g′ (chain rule).
    #[inline(always)]
    fn chained(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: self.slope.map(|slope| slope * derivative) }
    }

    /// A function of two numbers, given its value and its two partial derivatives (chain rule).
    #[inline(always)]
    fn joined(self, other: Self, value: f64, first: f64, second: f64) -> Self {
        Self { value, slope: std::array::from_fn(|k| self.slope[k] * first + other.slope[k] * second) }
    }
}

impl<const D: usize> Default for Dual<D> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const D: usize> PartialEq<f64> for Dual<D> {
    #[inline(always)]
    fn eq(&self, other: &f64) -> bool {
        self.value == *other
    }
}

impl<const D: usize> PartialOrd for Dual<D> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<const D: usize> PartialOrd<f64> for Dual<D> {
    #[inline(always)]
    fn partial_cmp(&self, other: &f64) -> Option<Ordering> {
        self.value.partial_cmp(other)
    }
}

impl<const D: usize> Neg for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: self.slope.map(|slope| -slope) }
    }
}

impl<const D: usize> Add for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: std::array::from_fn(|k| self.slope[k] + other.slope[k]) }
    }
}

impl<const D: usize> Sub for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: std::array::from_fn(|k| self.slope[k] - other.slope[k]) }
    }
}

impl<const D: usize> Mul for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.joined(other, self.value * other.value, other.value, self.value)
    }
}

impl<const D: usize> Fused for Dual<D> {
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        let product = self.joined(factor, 0.0, factor.value, self.value);
        Self { value: self.value.multiply_add(factor.value, term.value), ..product + term }
    }
}

impl<const D: usize> Fused<f64> for Dual<D> {
    #[inline(always)]
    fn multiply_add(self, factor: f64, term: Self) -> Self {
        Self { value: self.value.multiply_add(factor, term.value), ..self * factor + term }
    }
}

impl<const D: usize> Div for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (quotient, per) = (self.value / other.value, 1.0 / other.value);
        self.joined(other, quotient, per, -quotient * per)
    }
}

impl<const D: usize> Add<f64> for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<const D: usize> Sub<f64> for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl<const D: usize> Mul<f64> for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.chained(self.value * other, other)
    }
}

impl<const D: usize> Div<f64> for Dual<D> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.chained(self.value / other, 1.0 / other)
    }
}

impl<const D: usize> Mul<Vec2<Self>> for Dual<D> {
    type Output = Vec2<Self>;
    #[inline(always)]
    fn mul(self, v: Vec2<Self>) -> Vec2<Self> {
        v * self
    }
}

impl<const D: usize> AddAssign for Dual<D> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const D: usize> SubAssign for Dual<D> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const D: usize> Real for Dual<D> {
    type Lanes = [Self; LANES];

    const ZERO: Self = Self { value: 0.0, slope: [0.0; D] };
    const ONE: Self = Self { value: 1.0, slope: [0.0; D] };

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self { value, slope: [0.0; D] }
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let per = 1.0 / self.value;
        self.chained(per, -per * per)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chained(root, if root == 0.0 { 0.0 } else { 0.5 / root })
    }
    fn abs(self) -> Self {
        self.chained(self.value.abs(), 1.0_f64.copysign(self.value))
    }
    fn max(self, limit: f64) -> Self {
        if self.value > limit { self } else { Self::constant(self.value.max(limit)) }
    }
    fn min(self, limit: f64) -> Self {
        if self.value < limit { self } else { Self::constant(self.value.min(limit)) }
    }
    fn clamp(self, low: f64, high: f64) -> Self {
        let within = self.value > low && self.value < high;
        if within { self } else { Self::constant(self.value.clamp(low, high)) }
    }
    fn choose(self, then: impl FnOnce() -> Self, other: impl FnOnce() -> Self) -> Self {
        if self.value > 0.0 { then() } else { other() }
    }
    fn copysign(self, sign: Self) -> Self {
        if self.value.is_sign_negative() == sign.value.is_sign_negative() { self } else { -self }
    }
    fn sin_cos<const K: usize>(x: [Self; K]) -> [(Self, Self); K] {
        let values: [(f64, f64); K] = Real::sin_cos(x.map(|x| x.value));
        std::array::from_fn(|place| {
            let (x, (sin, cos)) = (x[place], values[place]);
            (x.chained(sin, cos), x.chained(cos, -sin))
        })
    }
    fn exp(self) -> Self {
        let value = Real::exp(self.value);
        self.chained(value, value)
    }
    fn tanh(self) -> Self {
        let value = Real::tanh(self.value);
        self.chained(value, (1.0 - value) * (1.0 + value))
    }
    fn asinh(self) -> Self {
        self.chained(Real::asinh(self.value), 1.0 / (1.0 + self.value * self.value).sqrt())
    }
    fn powf(self, p: f64) -> Self {
        self.chained(Real::powf(self.value, p), p * Real::powf(self.value, p - 1.0))
    }
    fn atan2(self, x: Self) -> Self {
        let per_square = 1.0 / (self.value * self.value + x.value * x.value);
        self.joined(x, Real::atan2(self.value, x.value), x.value * per_square, -self.value * per_square)
    }
}
