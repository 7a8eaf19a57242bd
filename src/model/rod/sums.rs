//! Sums over the rows of a table.

use crate::math::{LANES, Lanes, Real, each};
use std::array;
use std::ops::Range;

/// Most fours of sums at a time, those of all lists together: as many as stay in registers.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Dual;

    const WIDTH: usize = 28;
    const ROWS: usize = 12;

    /// Two lists of sums over the rows from the third on, by [`add_rows`] together and apart, and one by one.
    fn agrees<R: Real + PartialEq, const FEW: bool>(number: impl Fn(usize) -> R, columns: usize) {
        let table: [[f64; WIDTH]; ROWS] = array::from_fn(|row| array::from_fn(|i| ((7 * row + 3 * i) as f64).sin()));
        let factors: [[R; ROWS]; 2] = array::from_fn(|list| array::from_fn(|row| number(20 * list + row)));
        let start: [[R; WIDTH]; 2] = array::from_fn(|list| array::from_fn(|i| number(50 * list + i)));
        let (rows, lists) = (2..ROWS, [&factors[0][..], &factors[1][..]]);
        let [mut one, mut other] = start;
        add_rows::<R, FEW, _, _>([&mut one, &mut other], &table, rows.clone(), lists, columns);
        for (list, together) in [one, other].into_iter().enumerate() {
            let mut alone = start[list];
            add_rows::<R, FEW, _, _>([&mut alone], &table, rows.clone(), [lists[list]], columns);
            for i in 0..WIDTH {
                let wanted = if i < columns.next_multiple_of(LANES) {
                    rows.clone().fold(start[list][i], |sum, row| factors[list][row].times_plus(table[row][i], sum))
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
            agrees::<f64, false>(|i| (i as f64).cos(), columns);
            agrees::<f64, true>(|i| (i as f64).cos(), columns);
            let dual = |i: usize| Dual { value: (i as f64).cos(), slope: [i as f64, -1.0] };
            agrees::<Dual<2>, false>(dual, columns);
        }
    }
}
