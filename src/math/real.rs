//! The number types that the equations of motion are computed with.

use super::fused::Fused;
use super::lanes::Lanes;
use super::sin_cos;
use super::vec2::Vec2;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number: `f64`, a [`Dual`](super::Dual), which carries derivatives, or an [`F64x8`](super::F64x8), which holds
/// eight.
///
/// Generic code over `Real` computes with `f64` exactly what code for `f64` would. Parameters of the model stay `f64`
/// and stand on the right of an operator. Comparisons look at values alone, not at derivatives.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + PartialOrd<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Add<f64, Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Sub<f64, Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Mul<Vec2<Self>, Output = Vec2<Self>>
    + Div<Output = Self>
    + Div<f64, Output = Self>
    + Fused
    + Fused<f64>
{
    /// Whether the type carries no derivatives; short loops are then written out.
    const PLAIN: bool = false;
    /// Whether the type holds several numbers; both branches of a comparison are then computed.
    const MANY: bool = false;
    /// Four numbers of this type side by side.
    type Lanes: Lanes<Self>;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;

    /// A number that depends on no variable: its derivatives are 0.
    fn constant(value: f64) -> Self;
    /// The number without its derivatives; of several numbers the first.
    fn value(self) -> f64;
    /// 1/x.
    fn recip(self) -> Self;
    /// √x; the derivative at 0 is taken as 0.
    fn sqrt(self) -> Self;
    /// |x|; the derivative at ±0 is taken as ±1.
    fn abs(self) -> Self;
    /// The larger of `self` and `limit`; `limit` if they are equal.
    fn max(self, limit: f64) -> Self;
    /// The smaller of `self` and `limit`; `limit` if they are equal.
    fn min(self, limit: f64) -> Self;
    /// `self` limited to `low..=high`; at a bound the derivative is 0.
    fn clamp(self, low: f64, high: f64) -> Self;
    /// `then()` where `self` is positive and `other()` elsewhere. For a single number only one of the two is called.
    fn choose(self, then: impl FnOnce() -> Self, other: impl FnOnce() -> Self) -> Self;
    /// |x| with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// (sin x, cos x) of each x.
    fn sin_cos<const K: usize>(x: [Self; K]) -> [(Self, Self); K];
    /// e^x.
    fn exp(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Inverse hyperbolic sine.
    fn asinh(self) -> Self;
    /// x^p; derivatives are valid for x ≥ 0, p ≥ 1.
    fn powf(self, p: f64) -> Self;
    /// Angle of the point (x, `self`).
    fn atan2(self, x: Self) -> Self;
}

impl Real for f64 {
    const PLAIN: bool = true;
    type Lanes = wide::f64x4;

    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn max(self, limit: f64) -> Self {
        if self > limit { self } else { limit } // one instruction
    }
    #[inline(always)]
    fn min(self, limit: f64) -> Self {
        if self < limit { self } else { limit }
    }
    #[inline(always)]
    fn clamp(self, low: f64, high: f64) -> Self {
        f64::clamp(self, low, high)
    }
    #[inline(always)]
    fn choose(self, then: impl FnOnce() -> Self, other: impl FnOnce() -> Self) -> Self {
        if self > 0.0 { then() } else { other() }
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }
    #[inline(always)]
    fn sin_cos<const K: usize>(x: [Self; K]) -> [(Self, Self); K] {
        sin_cos::sin_cos(x)
    }
    fn exp(self) -> Self {
        libm::exp(self)
    }
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    fn asinh(self) -> Self {
        libm::asinh(self)
    }
    fn powf(self, p: f64) -> Self {
        libm::pow(self, p)
    }
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
}

impl<R: Real> Vec2<R> {
    /// (0, 0).
    pub const ZERO: Self = Self { x: R::ZERO, y: R::ZERO };

    /// The vector `v` with derivatives 0.
    #[inline(always)]
    pub fn constant(v: Vec2) -> Self {
        Self { x: R::constant(v.x), y: R::constant(v.y) }
    }

    /// √(x² + y²); the derivatives at 0 are taken as 0.
    #[inline(always)]
    pub fn norm(self) -> R {
        self.norm_squared().sqrt()
    }
}
