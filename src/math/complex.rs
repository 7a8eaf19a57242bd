//! Complex numbers, four side by side.

use super::f64x8::F64x8;
use super::lanes::LANES;
use std::ops::{Add, Mul, Sub};
use wide::f64x4;

/// Four complex numbers that are computed together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex4 {
    /// Real parts.
    re: f64x4,
    /// Imaginary parts.
    im: f64x4,
}

impl Complex4 {
    /// Four zeros.
    pub const ZERO: Self = Self { re: f64x4::ZERO, im: f64x4::ZERO };

    /// Four ones.
    pub const ONE: Self = Self { re: f64x4::ONE, im: f64x4::ZERO };

    /// Packs real and imaginary parts.
    pub const fn of(re: [f64; LANES], im: [f64; LANES]) -> Self {
        Self { re: f64x4::new(re), im: f64x4::new(im) }
    }

    /// The same real number four times.
    pub fn real(number: f64) -> Self {
        Self { re: f64x4::splat(number), im: f64x4::ZERO }
    }

    /// The numbers whose real parts are the first half of a row and whose imaginary parts are its second half.
    pub fn from_row(row: F64x8) -> Self {
        let [re, im] = row.halves();
        Self { re, im }
    }

    /// Real parts, then imaginary parts.
    pub fn row(self) -> F64x8 {
        F64x8::of_halves([self.re, self.im])
    }

    /// The real part of the first number.
    pub fn first(self) -> f64 {
        self.re.to_array()[0]
    }

    /// 1/z of each number.
    pub fn reciprocal(self) -> Self {
        let square = self.re * self.re + self.im * self.im;
        Self { re: self.re / square, im: -self.im / square }
    }

    /// Sum of the absolute values of all parts of all four numbers.
    pub fn size(self) -> f64 {
        let [a, b, c, d] = (self.re.abs() + self.im.abs()).to_array();
        (a + b) + (c + d)
    }
}

impl Add for Complex4 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for Complex4 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Mul for Complex4 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Mul<f64> for Complex4 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { re: self.re * f64x4::splat(factor), im: self.im * f64x4::splat(factor) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_reciprocals_are_those_of_complex_numbers() {
        let a = Complex4::of([3.0, 0.0, -1.0, 2.0], [4.0, 1.0, 0.0, -2.0]);
        assert_eq!(a * a, Complex4::of([-7.0, -1.0, 1.0, 0.0], [24.0, 0.0, 0.0, -8.0]));
        let one = a * a.reciprocal() - Complex4::real(1.0);
        assert!(one.size() < 1e-15, "{one:?}");
        assert_eq!(Complex4::from_row(a.row()), a);
    }
}
