//! The loop over a step's stages, compiled for a mechanism whose number of states is known, with its rates inside.

use crate::integrator::Tableau;
use crate::math::{Fused, unroll};

/// Up to so many states, what one stage hands on to the next stays in registers, or in places of its own. In an array it
/// would be written in other portions than it is read in, and wait to have left the processor's store buffer.
const IN_REGISTERS: usize = 14;

/// [`Ode::stages`](crate::integrator::Ode::stages) of a mechanism of `N` states with these `rates`, in registers or not;
/// `false` for one that may have fewer states than that.
#[inline(always)]
pub fn of_so_many<const N: usize>(
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

/// The same of a mechanism of at most [`IN_REGISTERS`] states; `false` for others.
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
        return false; // nothing is compiled
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
        // The last rates are added last: what they wait for is theirs alone.
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
