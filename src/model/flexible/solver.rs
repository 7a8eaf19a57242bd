//! Solves the equations of a mechanism with a flexible rod.

#![allow(clippy::needless_range_loop)] // triangles are read by their indices

use super::equations::Equations;
use crate::math::{Real, each};
use crate::model::joint::{Kernel, Kernels};

impl<R: Real, const S: usize> Equations<R, S> {
    /// Accelerations of the coordinates, by L·D·Lᵀ: the matrix is positive definite. D is of blocks of two, since
    /// pivots wait for one another, each with a division: there are half as many.
    #[inline(always)]
    pub fn solve(mut self, solver: Solver<R, S>) -> [R; S] {
        solver(&mut self);
        self.right
    }

    /// For any number of coordinates.
    fn solve_any(&mut self) {
        let mut per = [R::ZERO; S];
        let (size, blocks) = (self.size, self.size / 2);
        for block in 0..blocks {
            per[block] = self.eliminate(size, 2 * block);
        }
        self.divide_last(size);
        for block in (0..blocks).rev() {
            self.substitute(size, 2 * block, per[block]);
        }
    }

    /// For `SIZE` of them.
    fn solve_sized<const SIZE: usize>(&mut self) {
        let mut per = [R::ZERO; SIZE];
        each!(true, block < SIZE / 2 => {
            per[block] = self.eliminate(SIZE, 2 * block);
        });
        self.divide_last(SIZE);
        each!(true, done < SIZE / 2 => {
            let block = SIZE / 2 - 1 - done;
            self.substitute(SIZE, 2 * block, per[block]);
        });
    }

    /// Takes the coordinates `k` and `k` + 1 out of the equations after them, and returns the reciprocal of their
    /// block's determinant.
    #[inline(always)]
    fn eliminate(&mut self, size: usize, k: usize) -> R {
        let Self { matrix, right, .. } = self;
        let (one, two, x) = (matrix[k], matrix[k + 1], [right[k], right[k + 1]]);
        let (a, b, d) = (one[k], one[k + 1], two[k + 1]);
        let per = a.times_plus(d, -(b * b)).recip();
        for i in k + 2..size {
            // What the division is not needed for comes first.
            let (p, q) = (d.times_plus(one[i], -(b * two[i])), a.times_plus(two[i], -(b * one[i])));
            for j in i..size {
                matrix[i][j] = p.times_plus(one[j], q * two[j]).times_plus(-per, matrix[i][j]);
            }
            right[i] = p.times_plus(x[0], q * x[1]).times_plus(-per, right[i]);
        }
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
    fn substitute(&mut self, size: usize, k: usize, per: R) {
        let Self { matrix, right, .. } = self;
        let (one, two) = (matrix[k], matrix[k + 1]);
        let (a, b, d) = (one[k], one[k + 1], two[k + 1]);
        let [mut first, mut second] = [right[k], right[k + 1]];
        for j in (k + 2..size).rev() {
            first = (-one[j]).times_plus(right[j], first);
            second = (-two[j]).times_plus(right[j], second);
        }
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
        Kernels { value: compiled!(1 2 3 4 5 6 7 8 9 10 11 12 13 14), tangent: Equations::solve_any }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let sized = equations(size).solve(Solvers::of(size).value);
            assert_eq!(sized, equations(size).solve(Equations::solve_any), "{size}");
            for (k, found) in sized.iter().enumerate().take(size) {
                assert!((found - solution(k)).abs() < 1e-12, "{size}: {found} for {}", solution(k));
            }
        }
    }
}
