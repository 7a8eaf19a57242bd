//! The loop over the stages of a step, compiled with the rates of a mechanism whose number of states is a constant.

use crate::integrator::Tableau;
use crate::math::{Fused, unroll};

/// Up to this number of states the sums of a stage stay in registers or in separate places. In an array they would be
/// written in other portions than they are read in, and wait for the processor's store buffer.
const IN_REGISTERS: usize = 14;

/// [`Ode::stages`](crate::integrator::Ode::stages) of a mechanism with `N` states and these `rates`. Returns `false` if
/// the mechanism has fewer than `N` states.
#[inline(always)]
pub fn run_stages<const N: usize>(
    tableau: &Tableau,
    t: f64,
    y: &[f64],
    h: f64,
    k: &mut [f64],
    rates: impl Fn(f64, &[f64; N], &mut [f64; N]),
) -> bool {
    if const { N <= IN_REGISTERS } {
        return in_registers::<N>(tableau, t, y, h, k, rates);
    }
    let (Some(y), (k, _)) = (y.first_chunk::<N>(), k.as_chunks_mut::<N>()) else {
        return false;
    };
    for i in 1..tableau.inner_stages().min(k.len()) {
        let (earlier, later) = k.split_at_mut(i);
        let (last, earlier) = (&earlier[i - 1], &earlier[..i - 1]);
        let weights = &tableau.a[i];
        let mut at = [0.0; N];
        for (weight, k) in weights.iter().zip(earlier) {
            if *weight != 0.0 {
                for (slope, k) in at.iter_mut().zip(k) {
                    *slope = weight.multiply_add(*k, *slope);
                }
            }
        }
        let weight_of_last = h * weights[i - 1];
        for ((at, y), last) in at.iter_mut().zip(y).zip(last) {
            *at = y + weight_of_last.multiply_add(*last, h * *at);
        }
        rates(t + tableau.c[i] * h, &at, &mut later[0]);
    }
    true
}

/// As [`run_stages`] for at most [`IN_REGISTERS`] states; returns `false` for more.
#[inline(always)]
fn in_registers<const N: usize>(
    tableau: &Tableau,
    t: f64,
    y: &[f64],
    h: f64,
    k: &mut [f64],
    rates: impl Fn(f64, &[f64; N], &mut [f64; N]),
) -> bool {
    if const { N > IN_REGISTERS || N == 0 } {
        return false; // produces no code
    }
    let (Some(y), (k, _)) = (y.first_chunk::<N>(), k.as_chunks_mut::<N>()) else {
        return false;
    };
    let mut last = k[0];
    for i in 1..tableau.inner_stages().min(k.len()) {
        let weights = &tableau.a[i];
        let mut slope = [0.0; N];
        for (weight, k) in weights.iter().zip(k.iter()).take(i - 1) {
            unroll!(true, m < N => {
                slope[m] = weight.multiply_add(k[m], slope[m]);
            });
        }
        // The rates of the last stage are added last: only they have to be waited for.
        let weight_of_last = h * weights[i - 1];
        let mut at = *y;
        unroll!(true, m < N => {
            at[m] += weight_of_last.multiply_add(last[m], h * slope[m]);
        });
        rates(t + tableau.c[i] * h, &at, &mut last);
        k[i] = last;
    }
    true
}
