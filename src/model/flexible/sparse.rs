//! Numbers of which some are known to be zero by where they stand: what those would multiply is not computed.
//!
//! Where the frame is a constant, so is which numbers those are, and nothing of them is compiled.

use crate::math::{Fused, Real, Vec2};
use std::ops::{Add, AddAssign, Mul};

/// A number that may be known to be zero.
#[derive(Clone, Copy, Debug)]
pub enum Sparse<R> {
    /// 0.
    Zero,
    /// Any number.
    Is(R),
}

use Sparse::{Is, Zero};

impl<R: Real> Sparse<R> {
    /// 1.
    pub const ONE: Self = Is(R::ONE);

    /// As a number like others.
    #[inline(always)]
    pub fn value(self) -> R {
        match self {
            Zero => R::ZERO,
            Is(value) => value,
        }
    }

    /// The sum with a number like others.
    #[inline(always)]
    pub fn added_to(self, other: R) -> R {
        match self {
            Zero => other,
            Is(value) => other + value,
        }
    }

    /// What `of` makes of it, zero of zero.
    #[inline(always)]
    pub fn map(self, of: impl FnOnce(R) -> R) -> Self {
        match self {
            Zero => Zero,
            Is(value) => Is(of(value)),
        }
    }

    /// As many times a vector.
    #[inline(always)]
    pub fn times(self, v: Vec2<R>) -> Vec2<Self> {
        Vec2::new(self * v.x, self * v.y)
    }

    /// The same, and `other` added.
    #[inline(always)]
    pub fn times_vector_plus(self, v: Vec2<R>, other: Vec2<Self>) -> Vec2<Self> {
        Vec2::new(self.times_plus(v.x, other.x), self.times_plus(v.y, other.y))
    }
}

impl<R: Real> Vec2<Sparse<R>> {
    /// (0, 0).
    pub const NONE: Self = Self { x: Zero, y: Zero };

    /// So many times as long.
    #[inline(always)]
    pub fn scaled(self, factor: f64) -> Self {
        Self { x: self.x.map(|x| x * factor), y: self.y.map(|y| y * factor) }
    }

    /// x·x' + y·y'.
    #[inline(always)]
    pub fn with<S>(self, other: Vec2<S>) -> Sparse<R>
    where
        Sparse<R>: Mul<S, Output = Sparse<R>> + Fused<S>,
    {
        self.x.times_plus(other.x, self.y * other.y)
    }
}

impl<R: Real> Add for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        match (self, other) {
            (Is(a), Is(b)) => Is(a + b),
            (Is(a), Zero) => Is(a),
            (Zero, b) => b,
        }
    }
}

impl<R: Real> Mul for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        match (self, other) {
            (Is(a), Is(b)) => Is(a * b),
            _ => Zero,
        }
    }
}

impl<R: Real> Mul<R> for Sparse<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: R) -> Self {
        self.map(|value| value * other)
    }
}

impl<R: Real> Fused for Sparse<R> {
    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        match factor {
            Zero => term,
            Is(factor) => self.times_plus(factor, term),
        }
    }
}

impl<R: Real> Fused<R> for Sparse<R> {
    #[inline(always)]
    fn times_plus(self, factor: R, term: Self) -> Self {
        match (self, term) {
            (Is(value), Is(term)) => Is(value.times_plus(factor, term)),
            (Is(value), Zero) => Is(value * factor),
            (Zero, term) => term,
        }
    }
}

impl<R: Real> AddAssign for Sparse<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
