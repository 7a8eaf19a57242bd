//! Numbers, vectors and the elementary functions. Their results have the same bits on every platform, except that
//! [`Fused`] operations round differently on processors that multiply and add in one instruction.
//!
//! The elementary functions of `f64` are not used: they come from the platform's C library, whose last digits differ.
//! Square roots are correctly rounded everywhere by IEEE 754, so `f64::sqrt` is used.

mod complex;
mod dual;
mod f64x8;
mod fused;
mod lanes;
mod real;
mod sin_cos;
mod unroll;
mod vec2;

pub use complex::Complex4;
pub use dual::Dual;
pub use f64x8::{F64x8, ROW};
pub use fused::{Fused, PORTABLE};
pub(crate) use lanes::larger;
pub use lanes::{LANES, Lanes};
pub use real::Real;
pub(crate) use unroll::{unroll, unroll_four};
pub use vec2::Vec2;

/// Adds `share`·`more` to `sum`.
#[inline(always)]
pub fn add_multiple(sum: &mut [f64], share: f64, more: &[f64]) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += share * more);
}

/// (sin x, cos x).
#[inline(always)]
pub fn sin_cos<R: Real>(x: R) -> (R, R) {
    let [both] = R::sin_cos([x]);
    both
}

/// x^y.
pub fn powf<R: Real>(x: R, y: f64) -> R {
    R::powf(x, y)
}

/// e^x.
pub fn exp<R: Real>(x: R) -> R {
    R::exp(x)
}

/// Natural logarithm of x.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Natural logarithm of 1 + x.
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// Hyperbolic tangent.
pub fn tanh<R: Real>(x: R) -> R {
    R::tanh(x)
}

/// Inverse hyperbolic sine.
pub fn asinh<R: Real>(x: R) -> R {
    R::asinh(x)
}

/// Angle in (−π/2, π/2] of the point (x, y), x ≥ 0.
pub fn atan2<R: Real>(y: R, x: R) -> R {
    R::atan2(y, x)
}

/// x^y to a few parts in a thousand, for positive normal x and |y·log₂x| below 1000.
pub fn rough_power(x: f64, y: f64) -> f64 {
    rough_exp2(y * rough_log2(x))
}

const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
const ONE: u64 = 1023 << MANTISSA;

/// log₂ x: the exponent plus a parabola through log₂ of the mantissa at 1, √2 and 2.
fn rough_log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = f64::from((bits >> MANTISSA) as i32) - 1023.0;
    let m = f64::from_bits((bits & ((1 << MANTISSA) - 1)) | ONE) - 1.0;
    exponent + m + 0.343_145_750_507_620 * m * (1.0 - m)
}

/// 2^x: the exponent plus a parabola through 2^x at 0, ½ and 1.
fn rough_exp2(x: f64) -> f64 {
    let biased = x.clamp(-1000.0, 1000.0) + 1023.0;
    let exponent = biased as i32;
    let f = biased - f64::from(exponent);
    let mantissa = 1.0 + f - 0.343_145_750_507_620 * f * (1.0 - f);
    mantissa * f64::from_bits((exponent as u64) << MANTISSA)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_those_of_the_library() {
        let mut x: f64 = 1e-9;
        let mut worst: f64 = 0.0;
        while x < 3e6 {
            for angle in [x, -x, (x / 1.5).round() * std::f64::consts::FRAC_PI_2, (x * 81.5).round() / 163.0] {
                let (sin, cos) = sin_cos(angle);
                let (exact_sin, exact_cos) = libm::sincos(angle);
                for (found, exact) in [(sin, exact_sin), (cos, exact_cos)] {
                    // Where a multiple of π/2 is meant, what is left of it is known to 1e-17.
                    let error = (found - exact).abs() / (exact.abs() + 0.05);
                    assert!(error <= 3.4e-16, "{angle:e}: {found:e} {exact:e}");
                    worst = worst.max(error);
                }
            }
            x *= 1.000_37;
        }
        println!("largest error: {worst:.1e}");
        for small in [1e-300, 1e-9, 1e-3, 0.3] {
            let error = (sin_cos(small).0 / libm::sin(small) - 1.0).abs();
            assert!(error <= 2.3e-16, "{small:e}: {error:e}");
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        let (sin, cos) = sin_cos(f64::INFINITY);
        assert!(sin.is_nan() && cos.is_nan());
    }

    #[test]
    fn company_changes_no_bit() {
        let bits = |(sin, cos): (f64, f64)| [sin.to_bits(), cos.to_bits()];
        let mut x: f64 = 1e-3;
        for company in [0.0, -17.5, 2e6, 1e300, f64::INFINITY].iter().cycle().take(2000) {
            let [first, second, third] = Real::sin_cos([x, *company, -x]);
            assert_eq!([first, third].map(bits), [x, -x].map(|x| bits(sin_cos(x))), "{x:e}, {company:e}");
            assert_eq!(bits(second), bits(sin_cos(*company)));
            x *= 1.01;
        }
    }

    #[test]
    fn a_rough_power_is_near_the_power() {
        let mut x: f64 = 1e-12;
        while x < 1e12 {
            for y in [-0.15, 0.04, 0.2, -0.125] {
                let share = rough_power(x, y) / x.powf(y);
                assert!((share - 1.0).abs() < 0.006, "{x}^{y}: {share}");
            }
            x *= 1.37;
        }
    }
}
