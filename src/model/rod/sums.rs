//! Sums over the rows of a table.

use crate::math::{LANES, Lanes, Real, each};
use std::array;
use std::ops::Range;

/// Most fours of sums at a time: as many as stay in registers.
const FOURS: usize = if cfg!(target_feature = "avx") { 8 } else { 4 };

/// Adds Σ factor·row over `rows` of a table to each list of `sums`, with factors of its own: in so many columns, and in
/// others up to whole fours. With `FEW`, a constant, sums are written out: at most twelve rows.
#[inline(always)]
pub fn add_rows<R: Real, const FEW: bool, const WIDTH: usize, const LISTS: usize>(
    mut sums: [&mut [R; WIDTH]; LISTS],
    table: &[[f64; WIDTH]],
    rows: Range<usize>,
    factors: [&[R]; LISTS],
    columns: usize,
) {
    const { assert!(WIDTH.is_multiple_of(LANES)) };
    let fours = columns.div_ceil(LANES);
    let most = if R::PLAIN { (FOURS / LISTS).min(4) } else { 1 };
    for first in (0..fours).step_by(most) {
        let (rows, sums) = (rows.clone(), &mut sums);
        match (fours - first).min(most) {
            2 if R::PLAIN => add_fours::<R, FEW, WIDTH, LISTS, 2>(sums, table, rows, factors, first),
            3 if R::PLAIN => add_fours::<R, FEW, WIDTH, LISTS, 3>(sums, table, rows, factors, first),
            4 if R::PLAIN => add_fours::<R, FEW, WIDTH, LISTS, 4>(sums, table, rows, factors, first),
            _ => add_fours::<R, FEW, WIDTH, LISTS, 1>(sums, table, rows, factors, first),
        }
    }
}

/// The same for `COUNT` fours of columns from the `first` on, side by side: a sum waits for itself alone.
#[inline(always)]
fn add_fours<R: Real, const FEW: bool, const WIDTH: usize, const LISTS: usize, const COUNT: usize>(
    sums: &mut [&mut [R; WIDTH]; LISTS],
    table: &[[f64; WIDTH]],
    rows: Range<usize>,
    factors: [&[R]; LISTS],
    first: usize,
) {
    let columns = LANES * first..LANES * (first + COUNT);
    let mut fours: [[R::Lanes; COUNT]; LISTS] = array::from_fn(|list| {
        let (numbers, _) = sums[list][columns.clone()].as_chunks();
        array::from_fn(|four| R::Lanes::of(numbers[four]))
    });
    let (table, factors) = (&table[rows.clone()], factors.map(|factors| &factors[rows.clone()]));
    each!(FEW, row < table.len() => {
        let (numbers, _) = table[row][columns.clone()].as_chunks();
        for (fours, factors) in fours.iter_mut().zip(&factors) {
            for (four, numbers) in fours.iter_mut().zip(numbers) {
                four.add(factors[row], numbers);
            }
        }
    });
    for (sums, fours) in sums.iter_mut().zip(fours) {
        let (places, _) = sums[columns.clone()].as_chunks_mut();
        for (place, four) in places.iter_mut().zip(fours) {
            *place = four.numbers();
        }
    }
}
