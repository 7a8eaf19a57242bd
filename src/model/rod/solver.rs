//! Solves M·q̈ = Q of a chain with a flexible rod, by L·D·Lᵀ.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::Counted;
use crate::math::{Real, each};
use std::marker::PhantomData;

/// Mass matrix (upper triangle) and right side over the angles of the rod's chain and the modal coordinates.
pub struct ModalEquations<R, const S: usize> {
    /// How many there are.
    pub size: usize,
    /// M: kg·m², kg·m and kg.
    pub matrix: [[R; S]; S],
    /// Q: N·m and N.
    pub right: [R; S],
}

/// What is known of the number of coordinates where code is compiled.
trait Size {
    /// It is, and loops over them are written out.
    const KNOWN: bool;
    /// Most.
    const MOST: usize;
}

struct Unknown;

impl Size for Unknown {
    const KNOWN: bool = false;
    const MOST: usize = usize::MAX;
}

/// Of a rod's modes and at most three angles.
struct Known<C>(PhantomData<C>);

impl<C: Counted> Size for Known<C> {
    const KNOWN: bool = true;
    const MOST: usize = C::MODES.saturating_add(3);
}

impl<R: Real, const S: usize> ModalEquations<R, S> {
    /// Accelerations of the coordinates, by L·D·Lᵀ: the matrix is positive definite. D is of blocks of two, since
    /// pivots wait for one another, each with a division: there are half as many. Where the rod's counts are known, the
    /// loops are written out.
    #[inline(always)]
    pub fn solve<C: Counted>(mut self) -> [R; S] {
        if const { C::KNOWN } {
            self.reduce::<true, Known<C>>(self.size);
        } else {
            self.reduce::<false, Unknown>(self.size);
        }
        self.right
    }

    /// Puts the solution in place of the right side. With `BLOCKS` the loop over blocks, with a known size every loop is
    /// written out.
    #[inline(always)]
    fn reduce<const BLOCKS: bool, Z: Size>(&mut self, size: usize) {
        let (mut per, blocks) = ([R::ZERO; S], size / 2);
        each!(BLOCKS, block < blocks, Z::MOST.div_ceil(2) => {
            per[block] = self.eliminate::<Z>(size, 2 * block);
        });
        self.divide_last(size);
        each!(BLOCKS, done < blocks, Z::MOST.div_ceil(2) => {
            let block = blocks - 1 - done;
            self.substitute::<Z>(size, 2 * block, per[block]);
        });
    }

    /// Takes the coordinates `k` and `k` + 1 out of the equations after them, and returns the reciprocal of their
    /// block's determinant.
    #[inline(always)]
    fn eliminate<Z: Size>(&mut self, size: usize, k: usize) -> R {
        let Self { matrix, right, .. } = self;
        let (one, two, x) = (matrix[k], matrix[k + 1], [right[k], right[k + 1]]);
        let (a, b, d) = (one[k], one[k + 1], two[k + 1]);
        let per = a.times_plus(d, -(b * b)).recip();
        each!(Z::KNOWN, i in k + 2..size, Z::MOST => {
            // What the division is not needed for comes first.
            let (p, q) = (d.times_plus(one[i], -(b * two[i])), a.times_plus(two[i], -(b * one[i])));
            each!(Z::KNOWN, j in i..size, Z::MOST => {
                matrix[i][j] = p.times_plus(one[j], q * two[j]).times_plus(-per, matrix[i][j]);
            });
            right[i] = p.times_plus(x[0], q * x[1]).times_plus(-per, right[i]);
        });
        per
    }

    /// Solves the equation of the last coordinate, where it has no partner.
    #[inline(always)]
    fn divide_last(&mut self, size: usize) {
        if !size.is_multiple_of(2) {
            self.right[size - 1] = self.right[size - 1] * self.matrix[size - 1][size - 1].recip();
        }
    }

    /// Puts the coordinates `k` and `k` + 1 in place of their right sides, those after them being there.
    #[inline(always)]
    fn substitute<Z: Size>(&mut self, size: usize, k: usize, per: R) {
        let Self { matrix, right, .. } = self;
        let (one, two) = (matrix[k], matrix[k + 1]);
        let (a, b, d) = (one[k], one[k + 1], two[k + 1]);
        let [mut first, mut second] = [right[k], right[k + 1]];
        each!(Z::KNOWN, done < size - (k + 2), Z::MOST => {
            let j = size - 1 - done;
            first = (-one[j]).times_plus(right[j], first);
            second = (-two[j]).times_plus(right[j], second);
        });
        right[k] = d.times_plus(first, -(b * second)) * per;
        right[k + 1] = a.times_plus(second, -(b * first)) * per;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::rod::{Any, Exactly};

    const ROOM: usize = 15;

    /// Equations whose solution is 1, −2, 3, …: a chain of springs between masses, and a corner that fills up.
    fn equations(size: usize) -> ModalEquations<f64, ROOM> {
        let element = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 3.0 + i as f64,
            1 => -1.0,
            distance => 0.1 / distance as f64,
        };
        let mut all = ModalEquations { size, matrix: [[0.0; ROOM]; ROOM], right: [0.0; ROOM] };
        for i in 0..size {
            for j in 0..size {
                all.right[i] += element(i, j) * solution(j);
                if i <= j {
                    all.matrix[i][j] = element(i, j);
                }
            }
        }
        all
    }

    fn solution(k: usize) -> f64 {
        if k.is_multiple_of(2) { k as f64 + 1.0 } else { -(k as f64 + 1.0) }
    }

    #[test]
    fn loops_that_are_written_out_find_the_solution_that_others_find() {
        for size in 1..=ROOM {
            let found = equations(size).solve::<Any>();
            assert_eq!(found, equations(size).solve::<Exactly<12, 0>>(), "{size}");
            for (k, found) in found.iter().enumerate().take(size) {
                assert!((found - solution(k)).abs() < 1e-12, "{size}: {found} for {}", solution(k));
            }
        }
    }
}
