//! Loops with few iterations that are written out.

/// `unroll!(ALONE, i in first..end, MAX => { … })` is `for i in first..end { … }` with `end` at most `MAX`. If the
/// constant `ALONE` is true, the loop is written out iteration by iteration, at most sixteen. Where the compiler knows
/// the range, nothing of the loop is left, and whatever depends on `i` alone is computed at compile time. Iterations
/// beyond the constant `MAX` produce no code. `i < end` stands for a range from 0; a constant `end` needs no `MAX`.
///
/// The compiler unrolls only the shortest loops by itself, and often too late: arrays that such a loop fills then stay
/// in memory, are written in other portions than they are read in, and the processor waits for its store buffer.
macro_rules! unroll {
    ($alone:expr, $i:ident < $end:expr => $work:block) => {
        unroll!($alone, $i in 0..$end, $end => $work)
    };
    ($alone:expr, $i:ident < $end:expr, $most:expr => $work:block) => {
        unroll!($alone, $i in 0..$end, $most => $work)
    };
    ($alone:expr, $i:ident in $range:expr, $most:expr => $work:block) => {{
        let range: std::ops::Range<usize> = $range;
        if const { $alone } {
            assert!(range.end <= const { if $most < 16 { $most } else { 16 } }, "more rounds than are written out");
            unroll!(@ $i range, $most, $work 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
        } else {
            #[allow(clippy::needless_range_loop, clippy::manual_memcpy)]
            for $i in range $work
        }
    }};
    (@ $i:ident $range:ident, $most:expr, $work:block $($number:literal)*) => {{
        $(if const { $number < $most } && $range.start <= $number && $number < $range.end {
            let $i: usize = $number;
            $work
        })*
    }};
}
pub(crate) use unroll;
