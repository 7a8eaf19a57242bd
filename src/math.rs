//! The elementary functions, in one place: the same bits on every platform.
//!
//! `f64`'s own come from the platform's C library, whose last digits differ. Square roots are exact
//! by IEEE 754 everywhere and stay `f64::sqrt`.

/// (sin x, cos x).
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// x^y.
pub fn powf(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// e^x.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm of 1 + x.
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// Hyperbolic tangent.
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}

/// Inverse hyperbolic sine.
pub fn asinh(x: f64) -> f64 {
    libm::asinh(x)
}

/// Angle in (−π/2, π/2] of the point (x, y), x ≥ 0.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
