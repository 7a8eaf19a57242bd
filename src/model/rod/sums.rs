//! Sums over the rows of a table.

#![allow(clippy::needless_range_loop)] // several arrays are read by the number of one four

use super::counts::CompiledCounts;
use crate::math::{LANES, Lanes, Real, unroll};
use std::array;
use std::marker::PhantomData;
use std::ops::Range;

/// Maximum number of groups of four sums at a time, over all lists: as many as stay in registers.
const FOURS: usize = if cfg!(target_feature = "avx") { 8 } else { 4 };

/// Bounds of the numbers of rows and columns of a sum, as far as they are known at compile time.
pub trait Bounds {
    /// Maximum number of rows.
    const ROWS: usize;
    /// Maximum number of columns.
    const COLUMNS: usize;
}

/// Bounds of sums with a row for each modal coordinate and a column for each modal coordinate.
pub struct ModesToModes<C>(PhantomData<C>);
/// Bounds of sums with a row for each function along x and a column for each modal coordinate and, last, one for the
/// rod.
pub struct FunctionsToModes<C>(PhantomData<C>);
/// Bounds of sums with a row for each function along x and a column for each function or pair of modes.
pub struct FunctionsToFunctions<C>(PhantomData<C>);

impl<C: CompiledCounts> Bounds for ModesToModes<C> {
    const ROWS: usize = C::MODES;
    const COLUMNS: usize = C::MODES.saturating_add(1);
}
impl<C: CompiledCounts> Bounds for FunctionsToModes<C> {
    const ROWS: usize = C::FUNCTIONS;
    const COLUMNS: usize = C::MODES.saturating_add(1);
}
impl<C: CompiledCounts> Bounds for FunctionsToFunctions<C> {
    const ROWS: usize = C::FUNCTIONS;
    const COLUMNS: usize = C::FUNCTIONS;
}

/// Adds Σ factor·row over the `rows` of a table to each list in `sums`, with the list's own `factors`, in the first
/// `columns` columns, rounded up to groups of four. If the number of rows is known at compile time, the sum is written
/// out: at most sixteen rows.
#[inline(always)]
pub fn add_rows<R: Real, B: Bounds, const WIDTH: usize, const LISTS: usize>(
    mut sums: [&mut [R; WIDTH]; LISTS],
    table: &[[f64; WIDTH]],
    rows: Range<usize>,
    factors: [&[R]; LISTS],
    columns: usize,
) {
    const { assert!(WIDTH.is_multiple_of(LANES)) };
    let fours = columns.div_ceil(LANES);
    let (table, factors) = (&table[rows.clone()], factors.map(|factors| &factors[rows.clone()]));
    let most = const { most_fours::<R, B>(WIDTH, LISTS) };
    unroll!(B::COLUMNS < usize::MAX, turn < fours.div_ceil(most), WIDTH / LANES => {
        let (sums, first) = (&mut sums, turn * most);
        match (fours - first).min(most) {
            2 if const { most_fours::<R, B>(WIDTH, LISTS) >= 2 } => {
                add_fours::<R, B, WIDTH, LISTS, 2>(sums, table, factors, first);
            }
            3 if const { most_fours::<R, B>(WIDTH, LISTS) >= 3 } => {
                add_fours::<R, B, WIDTH, LISTS, 3>(sums, table, factors, first);
            }
            4 if const { most_fours::<R, B>(WIDTH, LISTS) >= 4 } => {
                add_fours::<R, B, WIDTH, LISTS, 4>(sums, table, factors, first);
            }
            _ => add_fours::<R, B, WIDTH, LISTS, 1>(sums, table, factors, first),
        }
    });
}

/// Number of groups of four sums of each list that are computed at a time.
const fn most_fours<R: Real, B: Bounds>(width: usize, lists: usize) -> usize {
    const fn smaller(a: usize, b: usize) -> usize {
        if a < b { a } else { b }
    }
    let there = smaller(width / LANES, B::COLUMNS.div_ceil(LANES));
    if R::PLAIN { smaller(smaller(FOURS / lists, there), 4) } else { 1 }
}

/// Adds the rows in `COUNT` groups of four columns from group `first` on; the groups do not wait for each other. Rows
/// with even and with odd numbers are summed separately, so that a sum waits only for every other product.
#[inline(always)]
fn add_fours<R: Real, B: Bounds, const WIDTH: usize, const LISTS: usize, const COUNT: usize>(
    sums: &mut [&mut [R; WIDTH]; LISTS],
    table: &[[f64; WIDTH]],
    factors: [&[R]; LISTS],
    first: usize,
) {
    let mut even: [[R::Lanes; COUNT]; LISTS] = array::from_fn(|list| {
        let (numbers, _) = sums[list].as_chunks();
        array::from_fn(|four| R::Lanes::of(numbers[first + four]))
    });
    let mut odd = [[R::Lanes::of([R::ZERO; LANES]); COUNT]; LISTS];
    let add = |fours: &mut [[R::Lanes; COUNT]; LISTS], row: usize| {
        let (numbers, _) = table[row].as_chunks();
        for list in 0..LISTS {
            let factor = factors[list][row];
            for four in 0..COUNT {
                fours[list][four].add(factor, &numbers[first + four]);
            }
        }
    };
    let pairs = table.len() / 2;
    if R::PLAIN {
        unroll!(B::ROWS < usize::MAX, pair < pairs, B::ROWS.div_ceil(2) => {
            add(&mut even, 2 * pair);
            add(&mut odd, 2 * pair + 1);
        });
    } else {
        // Both sums at once would not stay in registers.
        unroll!(B::ROWS < usize::MAX, pair < pairs, B::ROWS.div_ceil(2) => {
            add(&mut even, 2 * pair);
        });
        unroll!(B::ROWS < usize::MAX, pair < pairs, B::ROWS.div_ceil(2) => {
            add(&mut odd, 2 * pair + 1);
        });
    }
    if !table.len().is_multiple_of(2) {
        add(&mut even, table.len() - 1);
    }
    for ((sums, even), odd) in sums.iter_mut().zip(even).zip(odd) {
        let (places, _) = sums.as_chunks_mut();
        for four in 0..COUNT {
            places[first + four] = even[four].plus(odd[four]).numbers();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Dual;

    const WIDTH: usize = 28;
    const ROWS: usize = 12;

    struct Known;
    impl Bounds for Known {
        const ROWS: usize = ROWS;
        const COLUMNS: usize = WIDTH;
    }
    struct Unknown;
    impl Bounds for Unknown {
        const ROWS: usize = usize::MAX;
        const COLUMNS: usize = usize::MAX;
    }

    /// Compares sums of two lists over the rows from the third on: by [`add_rows`] together and separately, and one by
    /// one, every other row.
    fn agrees<R: Real + PartialEq, B: Bounds>(number: impl Fn(usize) -> R, columns: usize) {
        let table: [[f64; WIDTH]; ROWS] = array::from_fn(|row| array::from_fn(|i| ((7 * row + 3 * i) as f64).sin()));
        let factors: [[R; ROWS]; 2] = array::from_fn(|list| array::from_fn(|row| number(20 * list + row)));
        let start: [[R; WIDTH]; 2] = array::from_fn(|list| array::from_fn(|i| number(50 * list + i)));
        let (rows, lists) = (2..ROWS, [&factors[0][..], &factors[1][..]]);
        let [mut one, mut other] = start;
        add_rows::<R, B, _, _>([&mut one, &mut other], &table, rows.clone(), lists, columns);
        for (list, together) in [one, other].into_iter().enumerate() {
            let mut alone = start[list];
            add_rows::<R, B, _, _>([&mut alone], &table, rows.clone(), [lists[list]], columns);
            for i in 0..WIDTH {
                let sum = |first: usize, start: R| {
                    let every_other = rows.clone().skip(first).step_by(2);
                    every_other.fold(start, |sum, row| factors[list][row].multiply_add(table[row][i], sum))
                };
                let wanted = if i < columns.next_multiple_of(LANES) {
                    sum(0, start[list][i]) + sum(1, R::ZERO)
                } else {
                    start[list][i]
                };
                assert_eq!([together[i], alone[i]], [wanted; 2], "list {list}, column {i} of {columns}");
            }
        }
    }

    #[test]
    fn sums_side_by_side_have_the_bits_of_sums_one_by_one() {
        for columns in 1..=WIDTH {
            agrees::<f64, Unknown>(|i| (i as f64).cos(), columns);
            agrees::<f64, Known>(|i| (i as f64).cos(), columns);
            let dual = |i: usize| Dual { value: (i as f64).cos(), slope: [i as f64, -1.0] };
            agrees::<Dual<2>, Unknown>(dual, columns);
        }
    }
}
