//! A product and a sum as one operation.

/// a·b + c.
///
/// Compiled for processors that do it in one instruction it rounds once, and otherwise the product, too: then it has the
/// bits of `a * b + c`. Only what takes time is written so. It is called by name, and not left to the compiler to find:
/// the same expression has the same bits wherever it stands.
pub trait Fused<F = Self>: Sized {
    /// `self`·`factor` + `term`.
    fn multiply_add(self, factor: F, term: Self) -> Self;
}

impl Fused for f64 {
    #[inline(always)]
    fn multiply_add(self, factor: f64, term: f64) -> f64 {
        if cfg!(target_feature = "fma") { self.mul_add(factor, term) } else { self * factor + term }
    }
}
