//! Sine and cosine together, without a branch or a call: a table of the circle gives the nearest entry, short series
//! the rest of the angle (P. T. P. Tang, Table-lookup algorithms for elementary functions, ARITH 10 (1991) 232).

use super::fused::Fused;
use super::lanes::LANES;
use super::unroll::unroll;
use std::f64::consts::{PI, TAU};
use wide::f64x4;

/// Largest angle that the argument reduction accepts: its multiple of [`STEP`] has 27 bits.
const MAX_REDUCED_ANGLE: f64 = 1.6e6;

/// 1.5·2⁵²: adding and subtracting this number rounds to an integer.
const ROUND_TO_INTEGER: f64 = 6_755_399_441_055_744.0;

/// Number of table entries in the circle.
const PARTS: usize = 512;

/// 2π/[`PARTS`] as a sum of two numbers: the first has 26 bits, so that its product with an integer of 27 bits is
/// exact; the second is the rest (W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980). π/2 is
/// 0x3FF9_21FB_5444_2D18 plus 0x3C91_A626_3314_5C07; its leading 26 bits and the remainder are scaled by powers of two.
const STEP: [f64; 2] = {
    const PER_STEP: f64 = 4.0 / PARTS as f64;
    let high = f64::from_bits(0x3FF9_21FB_5000_0000);
    let low = (f64::from_bits(0x3FF9_21FB_5444_2D18) - high) + f64::from_bits(0x3C91_A626_3314_5C07);
    [high * PER_STEP, low * PER_STEP]
};

/// (sin, cos) of every multiple of [`STEP`] in the circle.
static CIRCLE: [(f64, f64); PARTS] = {
    let mut circle = [(0.0, 0.0); PARTS];
    let mut part = 0;
    while part < PARTS {
        circle[part] = of_part(part);
        part += 1;
    }
    circle
};

/// (sin, cos) of multiple `part` of [`STEP`], reduced to the first eighth of the circle.
const fn of_part(part: usize) -> (f64, f64) {
    let quarter = PARTS / 4;
    let index = part % quarter;
    let (sin, cos) = if index <= quarter / 2 {
        series(index)
    } else {
        let (sin, cos) = series(quarter - index);
        (cos, sin)
    };
    match part / quarter {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Taylor series of an angle in the first eighth of the circle, summed from the smallest term, with nearly one
/// rounding.
const fn series(part: usize) -> (f64, f64) {
    let (x, rest) = (part as f64 * STEP[0], part as f64 * STEP[1]);
    let (z, mut sin, mut cos) = (x * x, 0.0, 0.0);
    let mut n = 24;
    while n > 0 {
        cos = -z * (1.0 + cos) / (n * (n - 1)) as f64;
        sin = -z * (1.0 + sin) / (n * (n + 1)) as f64;
        n -= 2;
    }
    (x + (x * sin + (1.0 + cos) * rest), 1.0 + (cos - x * (1.0 + sin) * rest))
}

/// (sin x, cos x) of each x, with an error of about two roundings.
#[inline(always)]
pub fn sin_cos<const K: usize>(x: [f64; K]) -> [(f64, f64); K] {
    let mut found = [(0.0, 0.0); K];
    let mut within_reach = true;
    unroll!(true, k < K => {
        within_reach &= x[k].abs() < MAX_REDUCED_ANGLE;
    });
    if within_reach {
        unroll!(true, k < K => {
            found[k] = reduced(x[k]);
        });
    } else {
        unroll!(true, k < K => {
            found[k] = one_by_one(x[k]);
        });
    }
    found
}

/// (sin, cos) of four angles together.
#[inline(always)]
pub fn of_four(x: f64x4) -> (f64x4, f64x4) {
    let angles = x.to_array();
    let mut within_reach = true;
    unroll!(true, k < LANES => {
        within_reach &= angles[k].abs() < MAX_REDUCED_ANGLE;
    });
    if !within_reach {
        return beyond_reduction(angles);
    }
    let shifted = multiply_add(x, f64x4::splat(PARTS as f64 / TAU), f64x4::splat(ROUND_TO_INTEGER));
    let k = shifted - f64x4::splat(ROUND_TO_INTEGER);
    let (places, mut sin_k, mut cos_k) = (shifted.to_array(), [0.0; LANES], [0.0; LANES]);
    unroll!(true, k < LANES => {
        (sin_k[k], cos_k[k]) = CIRCLE[places[k].to_bits() as usize % PARTS];
    });
    let (sin_k, cos_k) = (f64x4::new(sin_k), f64x4::new(cos_k));
    let r = multiply_add(k, f64x4::splat(-STEP[1]), multiply_add(k, f64x4::splat(-STEP[0]), x));
    let z = r * r;
    let series = |first: f64, second: f64| multiply_add(z, f64x4::splat(first), f64x4::splat(second));
    let sin_r = multiply_add(r * z, series(1.0 / 120.0, -1.0 / 6.0), r);
    let less = z * multiply_add(z, series(-1.0 / 720.0, 1.0 / 24.0), f64x4::splat(-0.5));
    (sin_k + multiply_add(cos_k, sin_r, sin_k * less), cos_k + multiply_add(cos_k, less, -(sin_k * sin_r)))
}

#[cold]
fn beyond_reduction(x: [f64; LANES]) -> (f64x4, f64x4) {
    let found = x.map(one_by_one);
    (f64x4::new(found.map(|(sin, _)| sin)), f64x4::new(found.map(|(_, cos)| cos)))
}

/// a·b + c, rounded as [`Fused`] rounds it.
#[inline(always)]
pub fn multiply_add(a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

#[cold]
fn one_by_one(x: f64) -> (f64, f64) {
    if x.abs() < MAX_REDUCED_ANGLE { reduced(x) } else { libm::sincos(x) }
}

#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    // x = k·STEP + r, |r| ≤ π/PARTS.
    let shifted = x.multiply_add(PARTS as f64 / TAU, ROUND_TO_INTEGER);
    let k = shifted - ROUND_TO_INTEGER;
    let (sin_k, cos_k) = CIRCLE[shifted.to_bits() as usize % PARTS];
    let r = k.multiply_add(-STEP[1], k.multiply_add(-STEP[0], x));
    // sin r and cos r − 1; the first neglected terms are below 1e-17.
    const { assert!((PI / PARTS as f64) < 0.0062) };
    let z = r * r;
    let sin_r = (r * z).multiply_add(z.multiply_add(1.0 / 120.0, -1.0 / 6.0), r);
    let less = z * z.multiply_add(z.multiply_add(-1.0 / 720.0, 1.0 / 24.0), -0.5);
    (sin_k + cos_k.multiply_add(sin_r, sin_k * less), cos_k + cos_k.multiply_add(less, -(sin_k * sin_r)))
}
