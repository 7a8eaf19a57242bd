//! Jacobians of right-hand sides by differentiating their own code: exact, several columns at a time.

use super::scalar::{DIRECTIONS, Tangent};
use crate::integrator::Jacobian;
use crate::math::Real;

/// Rates of a state at a time, all with derivatives.
pub type Rates<'a, const N: usize> = dyn Fn(Tangent, &[Tangent; N], &mut [Tangent; N]) + 'a;

/// Evaluates `rates` with derivatives along the first `moving` states and time, and writes those of
/// the first `states` rates at `t` and `y`. Nothing depends on the other states.
pub fn differentiate<const N: usize>(
    states: usize,
    moving: usize,
    t: f64,
    y: &[f64; N],
    jacobian: &mut Jacobian<N>,
    rates: &Rates<'_, N>,
) {
    for row in jacobian.state.iter_mut().take(states) {
        row[moving..states].fill(0.0);
    }
    let mut found = [Tangent::ZERO; N];
    for first in (0..=moving).step_by(DIRECTIONS) {
        let seed = |value: f64, column: usize| match column.checked_sub(first) {
            Some(direction) if direction < DIRECTIONS => Tangent::variable(value, direction),
            _ => Tangent::constant(value),
        };
        // Time is the column after those of the states.
        let y = std::array::from_fn(|k| if k < moving { seed(y[k], k) } else { Tangent::constant(y[k]) });
        rates(seed(t, moving), &y, &mut found);
        for (i, Tangent { slope, .. }) in found.iter().enumerate().take(states) {
            for (column, slope) in (first..=moving).zip(slope) {
                if column < moving {
                    jacobian.state[i][column] = *slope;
                } else {
                    jacobian.time[i] = *slope;
                }
            }
        }
    }
}
