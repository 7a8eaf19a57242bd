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
    ($unrolled:expr, $i:ident in $range:expr, $max:expr => $work:block) => {
        unroll!(@ $unrolled, $i in $range, $max, $work, 16: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    (@ $unrolled:expr, $i:ident in $range:expr, $max:expr, $work:block, $all:literal: $($number:literal)*) => {{
        let range: std::ops::Range<usize> = $range;
        if const { $unrolled } {
            assert!(range.end <= const { if $max < $all { $max } else { $all } }, "more iterations than are written out");
            $(if const { $number < $max } && range.start <= $number && $number < range.end {
                let $i: usize = $number;
                $work
            })*
        } else {
            #[allow(clippy::needless_range_loop, clippy::manual_memcpy)]
            for $i in range $work
        }
    }};
}
pub(crate) use unroll;

/// As [`unroll!`] with at most four iterations: for loops in loops over the modes of a rod, of whose bodies the compiler reads
/// as many copies as are written out.
macro_rules! unroll_four {
    ($unrolled:expr, $i:ident < $end:expr, $max:expr => $work:block) => {
        crate::math::unroll!(@ $unrolled, $i in 0..$end, $max, $work, 4: 0 1 2 3)
    };
}
pub(crate) use unroll_four;
