//! Loops with few iterations that are written out.

/// `unroll!(UNROLLED, i in first..end, MAX => { … })` is `for i in first..end { … }` with `end` at most `MAX`. If the
/// constant `UNROLLED` is true, the loop is written out iteration by iteration, at most sixteen. Where the compiler
/// knows the range, nothing of the loop is left, and whatever depends on `i` alone is computed at compile time.
/// Iterations beyond the constant `MAX` produce no code. `i < end` stands for a range from 0; a constant `end` needs no
/// `MAX`.
///
/// The compiler unrolls only the shortest loops by itself, and often too late: arrays that such a loop fills then stay
/// in memory, are written in other portions than they are read in, and the processor waits for its store buffer.
macro_rules! unroll {
    ($unrolled:expr, $i:ident < $end:expr => $work:block) => {
        unroll!($unrolled, $i in 0..$end, $end => $work)
    };
    ($unrolled:expr, $i:ident < $end:expr, $max:expr => $work:block) => {
        unroll!($unrolled, $i in 0..$end, $max => $work)
    };
    ($unrolled:expr, $i:ident in $range:expr, $max:expr => $work:block) => {{
        let range: std::ops::Range<usize> = $range;
        if const { $unrolled } {
            assert!(range.end <= const { if $max < 16 { $max } else { 16 } }, "more iterations than are written out");
            unroll!(@ $i range, $max, $work 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
        } else {
            #[allow(clippy::needless_range_loop, clippy::manual_memcpy)]
            for $i in range $work
        }
    }};
    (@ $i:ident $range:ident, $max:expr, $work:block $($number:literal)*) => {{
        $(if const { $number < $max } && $range.start <= $number && $number < $range.end {
            let $i: usize = $number;
            $work
        })*
    }};
}
pub(crate) use unroll;
