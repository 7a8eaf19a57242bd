//! The linear equations of implicit methods, (1/g − J)·u = r, where J is the Jacobian and g a multiple of the step.
//!
//! The rates of positions are velocities. Hence u of a position is g times its right-hand side plus u of its velocity,
//! and only the equations of velocities and first-order states are factorised.

use super::system::Jacobian;
use crate::math::Complex4;
use std::ops::{Add, Mul, Sub};

/// Numbers of the equations: of g, u and r.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
}

impl Number for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

impl Number for Complex4 {
    const ZERO: Self = Self::ZERO;
    const ONE: Self = Self::ONE;
}

/// Element (`i`, `j`) of the matrix that is factorised, of a system with `positions` positions: 1 − g·(J_v + g·J_q).
pub fn element<T: Number>(jacobian: &Jacobian, positions: usize, g: T, i: usize, j: usize) -> T {
    let row = jacobian.row(positions + i);
    let unit = if i == j { T::ONE } else { T::ZERO };
    let through_position = if j < positions { g * row[j] } else { T::ZERO };
    unit - g * (through_position + T::ONE * row[positions + j])
}

/// Replaces the right-hand side r by u. `solve` solves the equations whose matrix has the elements
/// [`element`].
pub fn solve<T: Number>(jacobian: &Jacobian, positions: usize, g: T, right: &mut [T], solve: impl FnOnce(&mut [T])) {
    let states = right.len();
    let (of_positions, rest) = right.split_at_mut(positions);
    for (i, right) in (positions..states).zip(rest.iter_mut()) {
        let row = &jacobian.row(i)[..positions];
        let through = row.iter().zip(&*of_positions).fold(T::ZERO, |sum, (slope, right)| sum + *right * *slope);
        *right = g * (*right + g * through);
    }
    solve(rest);
    for (position, velocity) in of_positions.iter_mut().zip(rest) {
        *position = g * (*position + *velocity);
    }
}
