//! Directions across an event, and the end of the first order near grazing.

use super::variational::{Crossing, Gradient, Variational};
use crate::integrator::root;
use crate::integrator::{EventFunction, EventFunctions, MAX_EVENTS, MAX_STATES, StepPoint};
use nalgebra::DMatrix;

/// An event so near grazing that an error within the tolerance decides how, or whether, it happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grazing {
    /// [s] When.
    pub time: f64,
    /// Which contact or switch, as [`Crossing::contact`]; of an event that just fails to happen, the event function.
    pub contact: usize,
    /// [unit of the event function / s] Speed at which its surface is met; 0 if it is just missed.
    pub speed: f64,
    /// Whether the surface is just missed.
    pub missed: bool,
}

/// Takes directions across the events between two discrete states at one instant. `point` is the point before them.
///
/// # Errors
/// `Grazing` if an error of `close` in a distance is no small one.
pub fn cross<D: Copy>(
    system: &dyn Variational<Discrete = D>,
    [before, after]: [&StepPoint<D>; 2],
    parameters: &DMatrix<f64>,
    close: f64,
    tangents: &mut DMatrix<f64>,
) -> Result<(), Grazing> {
    let (t, n) = (before.t, before.y.len());
    let mut discrete = before.discrete;
    for crossing in system.crossings(&before.discrete, &after.discrete, t, &before.y) {
        let rates = |discrete: &D| {
            let mut rates = [0.0; MAX_STATES];
            system.system().rates(discrete, t, &before.y, &mut rates[..n]);
            rates
        };
        let (earlier, later) = (rates(&discrete), rates(&crossing.after));
        let (earlier, later) = (&earlier[..n], &later[..n]);
        let speed = crossing.distance.rate(earlier);
        if matters(system, &crossing, [earlier, later]) {
            let bend = crossing.rate.rate(earlier).abs().max(crossing.rate.rate(later).abs());
            // Errors of the second order would be as large as those of the first.
            if speed * speed <= 2.0 * bend * close {
                return Err(Grazing { time: t, contact: crossing.contact, speed: speed.abs(), missed: false });
            }
        }
        for (mut direction, parameters) in tangents.column_iter_mut().zip(parameters.column_iter()) {
            let along = |gradient: &Gradient, direction: &[f64], delay: f64| {
                let states = gradient.by_state.iter().zip(direction).map(|(slope, value)| slope * value);
                let others = gradient.by_parameter.iter().zip(parameters.iter()).map(|(slope, share)| slope * share);
                states.sum::<f64>() + others.sum::<f64>() + gradient.by_time * delay
            };
            let direction = direction.as_mut_slice();
            let delay = -along(&crossing.distance, &direction[..n], 0.0) / speed;
            direction.iter_mut().zip(earlier).for_each(|(value, rate)| *value += rate * delay);
            if let Some((place, gradient)) = &crossing.memory {
                direction[n + place] = along(gradient, &direction[..n], delay);
            }
            direction[crossing.reset.clone()].fill(0.0);
            direction.iter_mut().zip(later).for_each(|(value, rate)| *value -= rate * delay);
        }
        discrete = crossing.after;
    }
    Ok(())
}

/// Whether the time of an event has an influence on what follows, which is not so where the rates are continuous and
/// nothing is remembered.
fn matters<D: Copy>(
    system: &dyn Variational<Discrete = D>,
    crossing: &Crossing<D>,
    [earlier, later]: [&[f64]; 2],
) -> bool {
    /// Jump of a rate relative to itself that is no jump.
    const CONTINUOUS: f64 = 1e-9;
    let remembered = crossing.memory.as_ref();
    let depends = remembered.is_some_and(|(_, gradient)| gradient.by_state.iter().any(|slope| *slope != 0.0));
    let scales = system.system().scales();
    let scaled = |rate: &f64, scale: &f64| if *scale > 0.0 { (rate / scale).abs() } else { 0.0 };
    let size = earlier.iter().zip(scales).map(|(rate, scale)| scaled(rate, scale)).fold(0.0, f64::max);
    let jump = earlier.iter().zip(later).zip(scales).map(|((a, b), scale)| scaled(&(a - b), scale));
    depends || jump.fold(0.0, f64::max) > CONTINUOUS * size
}

/// An event that fails by less than `close` to happen in a step from `start` to `end`. `distance` gives the event
/// functions at a share of the step.
pub fn near_miss(
    [start, end]: [f64; 2],
    count: usize,
    close: f64,
    distance: impl Fn(f64) -> EventFunctions,
) -> Option<Grazing> {
    let (before, after) = (distance(0.0), distance(1.0));
    (0..count.min(MAX_EVENTS)).find_map(|event| {
        let [EventFunction { value: from, rate: falling }, EventFunction { value: to, rate: rising }] =
            [before[event], after[event]];
        let dips = falling < 0.0 && rising > 0.0 && from > 0.0 && to > 0.0;
        // No parabola with these rates dips deeper.
        if !dips || from.min(to) - 0.5 * (end - start) * rising.max(-falling) > close {
            return None;
        }
        let bottom = root::falling(0.0, 1.0, -falling, -rising, 1e-6, |share| -distance(share)[event].rate);
        (distance(bottom)[event].value < close).then_some(Grazing {
            time: start + bottom * (end - start),
            contact: event,
            speed: 0.0,
            missed: true,
        })
    })
}
