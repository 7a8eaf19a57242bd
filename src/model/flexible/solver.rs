//! Solves the equations of a mechanism with a flexible rod.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::equations::Equations;
use crate::math::{Real, each};
use crate::model::joint::{Kernel, Kernels};
use crate::model::rod::Counted;
use std::marker::PhantomData;

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

/// Of a rod's modes and `P` places, of which L is no coordinate.
struct Known<C, const P: usize>(PhantomData<C>);

impl<C: Counted, const P: usize> Size for Known<C, P> {
    const KNOWN: bool = true;
    const MOST: usize = (P - 1).saturating_add(C::MODES);
}

impl<R: Real, const S: usize> Equations<R, S> {
    /// Accelerations of the coordinates, by L·D·Lᵀ: the matrix is positive definite. D is of blocks of two, since
    /// pivots wait for one another, each with a division: there are half as many.
    ///
    /// Where the rod's counts are known, the equations of up to `P` places are solved by code for their number alone;
    /// others `solver` solves.
    #[inline(always)]
    pub fn solve<C: Counted, const P: usize>(mut self, solver: Solver<R, S>) -> [R; S] {
        if const { C::KNOWN } {
            self.reduce::<true, Known<C, P>>(self.size)
        } else {
            solver(&mut self)
        }
        self.right
    }

    /// For any number of coordinates.
    fn solve_any(&mut self) {
        self.reduce::<false, Unknown>(self.size);
    }

    /// For `SIZE` of them.
    fn solve_sized<const SIZE: usize>(&mut self) {
        self.reduce::<true, Unknown>(SIZE);
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

/// Puts the solution in place of the right side.
pub type Solver<R, const S: usize> = fn(&mut Equations<R, S>);

/// Solvers as a kernel.
#[derive(Clone, Copy, Debug)]
pub struct Solvers<const S: usize>;

impl<const S: usize> Kernel for Solvers<S> {
    type Of<R: Real> = Solver<R, S>;
}

impl<const S: usize> Solvers<S> {
    /// Those for `size` coordinates, compiled for that many where they are few.
    pub fn of(size: usize) -> Kernels<Self> {
        /// Chooses among the listed sizes.
        macro_rules! compiled {
            ($($size:literal)*) => {
                match size {
                    $($size if $size <= S => Equations::solve_sized::<$size>,)*
                    _ => Equations::solve_any,
                }
            };
        }
        Kernels {
            value: compiled!(1 2 3 4 5 6 7 8 9 10 11 12 13 14),
            row: Equations::solve_any,
            half: Equations::solve_any,
            tangent: Equations::solve_any,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::rod::{Any, Exactly};

    const ROOM: usize = 15;

    /// Equations whose solution is 1, −2, 3, …: a chain of springs between masses, and a corner that fills up.
    fn equations(size: usize) -> Equations<f64, ROOM> {
        let element = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 3.0 + i as f64,
            1 => -1.0,
            distance => 0.1 / distance as f64,
        };
        let mut all = Equations { size, matrix: [[0.0; ROOM]; ROOM], right: [0.0; ROOM] };
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
    fn every_size_finds_the_solution_that_any_size_finds() {
        for size in 1..=ROOM {
            let (sized, any) = (Solvers::of(size).value, Equations::solve_any);
            let found = equations(size).solve::<Any, 1>(sized);
            assert_eq!(found, equations(size).solve::<Any, 1>(any), "{size}");
            assert_eq!(found, equations(size).solve::<Exactly<ROOM, 0>, 1>(any), "{size}");
            for (k, found) in found.iter().enumerate().take(size) {
                assert!((found - solution(k)).abs() < 1e-12, "{size}: {found} for {}", solution(k));
            }
        }
    }
}
