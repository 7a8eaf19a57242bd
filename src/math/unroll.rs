//! Short loops of which every round is code of its own.

/// `unroll!(ALONE, i in first..end, MOST => { … })` is `for i in first..end { … }`, with an `end` of at most `MOST`. With
/// `ALONE` it is written out round by round, at most sixteen, so that where the range is known to the compiler nothing of
/// the loop is left, and what depends on `i` alone is known before the program runs. (The compiler does so by itself only
/// with the shortest loops, and often too late: arrays that such a loop fills then stay in memory, written in other
/// portions than they are read in, and the processor waits for them to have left its store buffer.) `ALONE` and `MOST`
/// are constants; of rounds beyond `MOST` nothing is compiled. From 0 on, the range is `i < end`, and an `end` that is a
/// constant needs no `MOST`.
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
