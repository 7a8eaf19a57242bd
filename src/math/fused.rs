//! A product and a sum as one operation.

/// Whether this library is compiled for every processor of its platform, so that its results have the same bits on all of
/// them; otherwise it multiplies and adds in one instruction.
pub const PORTABLE: bool = !cfg!(target_feature = "fma");

/// a·b + c.
///
/// Compiled for processors that do it in one instruction it rounds once, and otherwise the product, too: then it has the
/// bits of `a * b + c`. Only what takes time is written so. It is called by name, and not left to the compiler to find:
/// the same expression has the same bits wherever it stands.
pub trait Fused<F = Self>: Sized {
    /// `self`·`factor` + `term`.
    fn times_plus(self, factor: F, term: Self) -> Self;
}

impl Fused for f64 {
    #[inline(always)]
    fn times_plus(self, factor: f64, term: f64) -> f64 {
        if PORTABLE { self * factor + term } else { self.mul_add(factor, term) }
    }
}
