//! Short loops of which every round is code of its own.

/// `each!(ALONE, i < end => { … })` is `for i in 0..end { … }`. With `ALONE`, a constant, it is written out round by
/// round, at most sixteen, so that where `end` is a constant too nothing of the loop is left, and what depends on `i`
/// alone is known before the program runs. (The compiler does so by itself only with the shortest loops, and often too
/// late: arrays that such a loop fills then stay in memory, written in other portions than they are read in, and the
/// processor waits for them to have left its store buffer.)
macro_rules! each {
    ($alone:expr, $i:ident < $end:expr => $work:block) => {{
        let end: usize = $end;
        if $alone {
            assert!(end <= 16, "more rounds than are written out");
            each!(@ $i end, $work 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
        } else {
            #[allow(clippy::needless_range_loop, clippy::manual_memcpy)]
            for $i in 0..end $work
        }
    }};
    (@ $i:ident $end:ident, $work:block $($number:literal)*) => {{
        $(if $number < $end {
            let $i: usize = $number;
            $work
        })*
    }};
}
pub(crate) use each;
