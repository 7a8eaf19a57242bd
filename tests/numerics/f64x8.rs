//! Numbers side by side.

use slidercrank::math::{F64x8, Fused, ROW, Real};

/// The bits of `of` computed together and one by one.
fn agrees(of_row: impl Fn(F64x8, F64x8) -> F64x8, of: impl Fn(f64, f64) -> f64) {
    let mut x: f64 = 0.011;
    for round in 0..500 {
        let a: [f64; ROW] = std::array::from_fn(|i| (x * (i as f64 + 1.7)).sin() * 10_f64.powi(i as i32 - 4));
        let mut b: [f64; ROW] = std::array::from_fn(|i| (x * (i as f64 - 3.2)).cos());
        b[round % ROW] = if round % 2 == 0 { 0.0 } else { -0.0 };
        let together = of_row(F64x8::of(a), F64x8::of(b)).numbers().map(f64::to_bits);
        assert_eq!(together, std::array::from_fn(|i| of(a[i], b[i]).to_bits()), "{a:?} {b:?}");
        x += 0.37;
    }
}

#[test]
fn eight_together_have_the_bits_of_each_alone() {
    agrees(|a, b| a + b, |a, b| a + b);
    agrees(|a, b| a - b * 3.0, |a, b| a - b * 3.0);
    agrees(|a, b| b / a, |a, b| b / a);
    agrees(|a, b| a.multiply_add(b, a), |a, b| a.multiply_add(b, a));
    agrees(|a, b| a.multiply_add(0.1, b), |a, b| a.multiply_add(0.1, b));
    agrees(|a, b| -a.recip() + b, |a, b| -a.recip() + b);
    agrees(|a, b| a.abs().sqrt() + b, |a, b| a.abs().sqrt() + b);
    agrees(|a, b| a.copysign(b), |a, b| a.copysign(b));
    agrees(|a, b| a.max(0.0) + b.max(0.3), |a, b| Real::max(a, 0.0) + Real::max(b, 0.3));
    agrees(|a, b| b.max(0.0) + a, |a, b| Real::max(b, 0.0) + a);
    agrees(|a, b| a.min(0.0) + b.min(0.3), |a, b| Real::min(a, 0.0) + Real::min(b, 0.3));
    agrees(|a, b| a.choose(|| a, || b), |a, b| a.choose(|| a, || b));
    agrees(|a, b| b.choose(|| a, || b), |a, b| b.choose(|| a, || b));
    agrees(|_, b| b.clamp(0.0, 1.0), |_, b| Real::clamp(b, 0.0, 1.0));
    agrees(|a, b| a.exp() + b.tanh(), |a, b| Real::exp(a) + Real::tanh(b));
    agrees(|a, b| a.abs().powf(1.4) + b.asinh(), |a, b| Real::powf(a.abs(), 1.4) + Real::asinh(b));
    agrees(|a, b| a.atan2(b.abs()), |a, b| Real::atan2(a, b.abs()));
}

#[test]
fn angles_together_have_the_bits_of_each_alone() {
    for size in [1.0, 1e3, 1e7, 1e300] {
        let turn = |of: fn((f64, f64)) -> f64| move |a: f64, b: f64| of(slidercrank::math::sin_cos(size * (a + b)));
        agrees(|a, b| slidercrank::math::sin_cos((a + b) * size).0, turn(|both| both.0));
        agrees(|a, b| slidercrank::math::sin_cos((a + b) * size).1, turn(|both| both.1));
    }
}
