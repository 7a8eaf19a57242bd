//! Derivatives of outputs with respect to time and to inputs.

use crate::integrator::MAX_STATES;
use crate::model::mechanism_model::MechanismModel;
use crate::model::signals::{Inputs, Outputs};

/// [s] Half the longest interval of a difference quotient.
const MAX_HALF_INTERVAL: f64 = 1e-8;
/// [s] Half the shortest interval of a difference quotient.
const MIN_HALF_INTERVAL: f64 = 1e-20;
/// Maximum number of times that the interval is shortened until the outputs at both ends are finite.
const MAX_SHORTENINGS: usize = 12;

/// Time derivatives of outputs along the motion through the state `y` at `t`, by a central difference. No state changes
/// by more than its scale, and time changes by at least a few roundings. Near a singular configuration the interval is
/// shortened.
pub fn slopes(
    model: &dyn MechanismModel,
    t: f64,
    y: &[f64],
    rates: &[f64],
    observe: &dyn Fn(f64, &[f64]) -> Outputs,
) -> Outputs {
    let over = |half: f64| {
        let along = |time: f64| {
            let mut moved = [0.0; MAX_STATES];
            for (moved, (y, rate)) in moved.iter_mut().zip(y.iter().zip(rates)) {
                *moved = y + (time - t) * rate;
            }
            observe(time, &moved[..y.len()])
        };
        let (before, after) = (t - half, t + half);
        let (first, second) = (along(before), along(after));
        second.combined(&first, |second, first| (second - first) / (after - before))
    };
    let weighted = rates.iter().zip(model.scales()).take(model.layout().weighted);
    let fastest = weighted.map(|(rate, scale)| (rate / scale).abs()).fold(0.0, f64::max);
    let shortest = MIN_HALF_INTERVAL.max(4.0 * f64::EPSILON * t.abs());
    let mut half = (1.0 / fastest).min(MAX_HALF_INTERVAL).max(shortest);
    let mut slopes = over(half);
    for _ in 0..MAX_SHORTENINGS {
        if half == shortest || slopes.is_finite() {
            break;
        }
        half = (0.1 * half).max(shortest);
        slopes = over(half);
    }
    slopes
}

/// Derivative of outputs with respect to the inputs, in the direction `seed`.
pub fn sensitivity(seed: Inputs, mut observe_under: impl FnMut(Inputs) -> Outputs) -> Outputs {
    // Outputs are affine in the inputs, so that any difference quotient is exact.
    let one = observe_under(seed);
    let other = observe_under(Inputs { crank_torque: -seed.crank_torque, slider_load: -seed.slider_load });
    one.combined(&other, |one, other| 0.5 * (one - other))
}
