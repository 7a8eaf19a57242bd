//! Parts of the equations of motion with stack frames of their own.
//!
//! The compiler reserves memory for all arrays of a function at once, even for those that are never in use at the same
//! time. With derivatives, the equations of a flexible rod need 42 kB in parts.

/// `part!(R, C, value)` is `value`, a part of the equations for the numbers `R` and the counts `C` of a rod. It is
/// computed in a function of its own, whose arrays leave the stack when it returns. Only arrays of `f64` are short, and
/// those of counts known at compile time stay in registers: such parts belong to the function around them.
macro_rules! part {
    ($number:ty, $counts:ty, $value:expr) => {
        if const { <$number>::PLAIN || <$counts>::KNOWN } { $value } else { $crate::model::part::apart(|| $value) }
    };
}
pub(crate) use part;

/// Calls `work` in a stack frame of its own.
#[inline(never)]
pub(crate) fn apart<T>(work: impl FnOnce() -> T) -> T {
    work()
}
