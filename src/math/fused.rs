//! A product and a sum as one operation.

/// Whether this library is compiled for every processor of its platform, so that its results have the same bits on all of
/// them; otherwise it multiplies and adds in one instruction.
pub const PORTABLE: bool = !cfg!(target_feature = "fma");

/// a·b + c.
///
/// On processors with a fused multiply-add instruction the result is rounded once; on others the product is rounded,
/// too, and the result has the bits of `a * b + c`. Only code whose speed matters uses it. It is called by name rather
/// than left to the compiler, so that the same expression has the same bits wherever it stands.
pub trait Fused<F = Self>: Sized {
    /// `self`·`factor` + `term`.
    fn multiply_add(self, factor: F, term: Self) -> Self;
}

impl Fused for f64 {
    #[inline(always)]
    fn multiply_add(self, factor: f64, term: f64) -> f64 {
        if PORTABLE { self * factor + term } else { self.mul_add(factor, term) }
    }
}
