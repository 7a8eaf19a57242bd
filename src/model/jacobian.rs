//! Jacobians of right-hand sides by forward differentiation of their code: exact, several columns at a time.

use super::scalar::{DIRECTIONS, Tangent};
use crate::integrator::Jacobian;
use crate::math::Real;

/// Computes the rates of a state at a time, all with derivatives.
pub type Rates<'a> = dyn Fn(Tangent, &[Tangent], &mut [Tangent]) + 'a;

/// Writes the derivatives of the first `states` rates at `t` and `y` with respect to the first `moving` states and to
/// time. The rates must not depend on the other states. `N` is the size of the arrays.
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
    let (mut at, mut found) = ([Tangent::ZERO; N], [Tangent::ZERO; N]);
    for first in (0..=moving).step_by(DIRECTIONS) {
        let seed = |value: f64, column: usize| match column.checked_sub(first) {
            Some(direction) if direction < DIRECTIONS => Tangent::variable(value, direction),
            _ => Tangent::constant(value),
        };
        // Time is the column after those of the states.
        for (k, (at, y)) in at.iter_mut().zip(y).enumerate() {
            *at = if k < moving { seed(*y, k) } else { Tangent::constant(*y) };
        }
        rates(seed(t, moving), &at[..states], &mut found[..states]);
        for (i, Tangent { slope, .. }) in found.iter().enumerate().take(states) {
            for (column, slope) in (first..=moving).zip(slope) {
                if column < moving {
                    jacobian.row_mut(i)[column] = *slope;
                } else {
                    jacobian.time[i] = *slope;
                }
            }
        }
    }
}
