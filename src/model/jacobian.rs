//! Jacobians of right-hand sides by forward differentiation of their code: exact, several columns at a time.

use super::scalar::{DIRECTIONS, Tangent};
use crate::integrator::Jacobian;
use crate::math::Real;

/// Computes the rates of a state at a time, all with derivatives.
pub type Rates<'a> = dyn Fn(Tangent, &[Tangent], &mut [Tangent]) + 'a;

/// Writes the derivatives of the first `states` rates at `t` and `y` with respect to the first `moving` states and, if the
/// Jacobian has room for them, to time. The rates must not depend on the other states. `N` is the size of the arrays.
pub fn differentiate<const N: usize>(
    states: usize,
    moving: usize,
    t: f64,
    y: &[f64],
    jacobian: &mut Jacobian,
    rates: &Rates<'_>,
) {
    for i in 0..states {
        jacobian.row_mut(i)[moving..states].fill(0.0);
    }
    let mut found = [Tangent::ZERO; N];
    let columns = moving + usize::from(!jacobian.time.is_empty());
    in_directions::<N>(moving, columns, t, &y[..states], |first, t, at| {
        rates(t, at, &mut found[..states]);
        for (i, Tangent { slope, .. }) in found.iter().enumerate().take(states) {
            for (column, slope) in (first..columns).zip(slope) {
                if column < moving {
                    jacobian.row_mut(i)[column] = *slope;
                } else {
                    jacobian.time[i] = *slope;
                }
            }
        }
    });
}

/// Calls `evaluate` with `t` and the states `y` for each group of the first `columns` directions: the first `moving` states,
/// then time, which is the column after theirs. It gets the first column of the group, time and states. `N` is the size of
/// the array.
#[inline(always)]
pub fn in_directions<const N: usize>(
    moving: usize,
    columns: usize,
    t: f64,
    y: &[f64],
    mut evaluate: impl FnMut(usize, Tangent, &[Tangent]),
) {
    let mut at = [Tangent::ZERO; N];
    for first in (0..columns).step_by(DIRECTIONS) {
        let seed = |value: f64, column: usize| match column.checked_sub(first) {
            Some(direction) if direction < DIRECTIONS => Tangent::variable(value, direction),
            _ => Tangent::constant(value),
        };
        for (k, (at, y)) in at.iter_mut().zip(y).enumerate() {
            *at = if k < moving { seed(*y, k) } else { Tangent::constant(*y) };
        }
        evaluate(first, seed(t, moving), &at[..y.len()]);
    }
}
