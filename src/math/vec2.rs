//! Vectors of the plane.

use super::fused::Fused;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A vector of the plane, in inertial axes unless stated otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec2<R = f64> {
    /// Along the first axis.
    pub x: R,
    /// Along the second axis.
    pub y: R,
}

impl<R> Vec2<R> {
    /// (x, y).
    #[inline(always)]
    pub const fn new(x: R, y: R) -> Self {
        Self { x, y }
    }
}

impl<R: Copy + Fused + Mul<Output = R>> Vec2<R> {
    /// x·x' + y·y'.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x.multiply_add(other.x, self.y * other.y)
    }

    /// `factor`·`self` + `other`.
    #[inline(always)]
    pub fn multiply_add<S: Copy>(self, factor: S, other: Self) -> Self
    where
        R: Fused<S>,
    {
        Self { x: self.x.multiply_add(factor, other.x), y: self.y.multiply_add(factor, other.y) }
    }

    /// x² + y².
    #[inline(always)]
    pub fn norm_squared(self) -> R {
        self.dot(self)
    }
}

impl<R> From<Vec2<R>> for [R; 2] {
    fn from(v: Vec2<R>) -> Self {
        [v.x, v.y]
    }
}

impl<R: Neg<Output = R>> Neg for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}

impl<R: Add<S, Output = R>, S> Add<Vec2<S>> for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Vec2<S>) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<R: Sub<S, Output = R>, S> Sub<Vec2<S>> for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Vec2<S>) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

impl<R: AddAssign> AddAssign for Vec2<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.x += other.x;
        self.y += other.y;
    }
}

impl<R: SubAssign> SubAssign for Vec2<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.x -= other.x;
        self.y -= other.y;
    }
}

impl<R: Mul<S, Output = R>, S: Copy> Mul<S> for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: S) -> Self {
        Self { x: self.x * factor, y: self.y * factor }
    }
}

impl<R: Div<S, Output = R>, S: Copy> Div<S> for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: S) -> Self {
        Self { x: self.x / divisor, y: self.y / divisor }
    }
}

impl Mul<Vec2> for f64 {
    type Output = Vec2;
    #[inline(always)]
    fn mul(self, v: Vec2) -> Vec2 {
        v * self
    }
}
