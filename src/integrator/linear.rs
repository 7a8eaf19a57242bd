//! Systems of linear equations, solved without allocation.

use crate::math::{Complex4, add_multiple};
use nalgebra::{DMatrixView, DMatrixViewMut, DVectorViewMut};

/// LU factors of a square matrix (Gaussian elimination with partial pivoting).
#[derive(Clone, Debug, Default)]
pub struct Factors {
    size: usize,
    /// See [`factorise`].
    elements: Vec<f64>,
    pivot: Vec<usize>,
}

impl Factors {
    /// Memory for matrices of up to `rows` rows.
    pub fn with_capacity(rows: usize) -> Self {
        Self { size: 0, elements: vec![0.0; rows * rows], pivot: vec![0; rows] }
    }

    /// Factorises the matrix of `size` rows with elements `element(i, j)`. If the matrix is singular, solutions are not
    /// finite.
    pub fn of(&mut self, size: usize, element: impl Fn(usize, usize) -> f64) {
        self.size = size;
        factorise(&mut self.elements[..size * size], &mut self.pivot[..size], element);
    }

    /// Replaces the right-hand side `x` by the solution.
    pub fn solve(&self, x: &mut [f64]) {
        substitute(&self.elements[..self.size * self.size], &self.pivot[..self.size], x);
    }
}

/// LU factors of four complex square matrices of like sizes and signs. All four have the same pivots, those of the largest
/// sums of absolute values.
#[derive(Clone, Debug)]
pub struct FourFactors {
    size: usize,
    /// L (below the diagonal; its diagonal is 1), the reciprocals of the diagonal of U, and U, by columns.
    elements: Vec<Complex4>,
    /// The row that was exchanged with each row.
    pivot: Vec<usize>,
}

impl FourFactors {
    /// Memory for matrices of up to `rows` rows.
    pub fn with_capacity(rows: usize) -> Self {
        Self { size: 0, elements: vec![Complex4::ZERO; rows * rows], pivot: vec![0; rows] }
    }

    /// Factorises the matrices of `size` rows with elements `element(i, j)`. If one of them is singular, its solutions are
    /// not finite.
    pub fn of(&mut self, size: usize, element: impl Fn(usize, usize) -> Complex4) {
        self.size = size;
        let matrices = &mut self.elements[..size * size];
        for (j, column) in matrices.chunks_exact_mut(size.max(1)).enumerate() {
            for (i, place) in column.iter_mut().enumerate() {
                *place = element(i, j);
            }
        }
        for k in 0..size {
            let (left, right) = matrices.split_at_mut((k + 1) * size);
            let column = &mut left[k * size..];
            let pivot = (k..size).max_by(|i, j| column[*i].size().total_cmp(&column[*j].size())).unwrap_or(k);
            self.pivot[k] = pivot;
            column.swap(k, pivot);
            column[k] = column[k].reciprocal();
            let (upper, lower) = column.split_at_mut(k + 1);
            for element in &mut *lower {
                *element = *element * upper[k];
            }
            for other in right.chunks_exact_mut(size) {
                other.swap(k, pivot);
                let (upper, rest) = other.split_at_mut(k + 1);
                subtract(rest, upper[k], lower);
            }
            for earlier in left[..k * size].chunks_exact_mut(size) {
                earlier.swap(k, pivot);
            }
        }
    }

    /// Replaces the right-hand sides `x` by the solutions.
    pub fn solve(&self, x: &mut [Complex4]) {
        let size = self.size;
        let column = |k: usize| &self.elements[k * size..][..size];
        for k in 0..size {
            x.swap(k, self.pivot[k]);
        }
        for k in 0..size {
            let (known, rest) = x.split_at_mut(k + 1);
            subtract(rest, known[k], &column(k)[k + 1..]);
        }
        for k in (0..size).rev() {
            let (rest, known) = x.split_at_mut(k);
            known[0] = known[0] * column(k)[k];
            subtract(rest, known[0], &column(k)[..k]);
        }
    }
}

/// Subtracts `factor` times the `others`.
fn subtract(from: &mut [Complex4], factor: Complex4, others: &[Complex4]) {
    for (from, other) in from.iter_mut().zip(others) {
        *from = *from - factor * *other;
    }
}

/// Factorises the square matrix with elements `element(i, j)` and as many rows as `pivot` has elements. Writes L (below the
/// diagonal; its diagonal is 1) and U into `factors`, by columns, and into `pivot[k]` the row that was exchanged with row k.
/// Returns the absolute value of the smallest pivot, which is 0 if the matrix is singular.
pub fn factorise(factors: &mut [f64], pivot: &mut [usize], element: impl Fn(usize, usize) -> f64) -> f64 {
    let size = pivot.len();
    let mut matrix = DMatrixViewMut::from_slice(factors, size, size);
    for (j, mut column) in matrix.column_iter_mut().enumerate() {
        for (i, place) in column.iter_mut().enumerate() {
            *place = element(i, j);
        }
    }
    let mut smallest = f64::INFINITY;
    for (k, pivot) in pivot.iter_mut().enumerate() {
        *pivot = k + matrix.view_range(k.., k).iamax();
        matrix.swap_rows(k, *pivot);
        let (mut left, mut right) = matrix.columns_range_pair_mut(k, k + 1..);
        let diagonal = left[k];
        smallest = smallest.min(diagonal.abs());
        let mut lower = left.rows_range_mut(k + 1..);
        lower /= diagonal;
        for mut column in right.column_iter_mut() {
            let top = column[k];
            column.rows_range_mut(k + 1..).axpy(-top, &lower, 1.0);
        }
    }
    smallest
}

/// Replaces the right-hand side `x` by the solution of the equations whose matrix has these `factors`.
pub fn substitute(factors: &[f64], pivot: &[usize], x: &mut [f64]) {
    let size = pivot.len();
    if size == 0 {
        return; // nalgebra requires at least one equation
    }
    for (k, &pivot) in pivot.iter().enumerate() {
        x.swap(k, pivot);
    }
    let matrix = DMatrixView::from_slice(factors, size, size);
    let mut x = DVectorViewMut::from_slice(x, size);
    let solved = matrix.solve_lower_triangular_with_diag_mut(&mut x, 1.0) && matrix.solve_upper_triangular_mut(&mut x);
    if !solved {
        x.fill(f64::NAN);
    }
}

/// Solves systems of `size` equations with one matrix for several right-hand sides (Gaussian elimination with partial
/// pivoting). Each of the `equations`, `width` numbers long, has a row of the matrix and then its number of each right-hand
/// side, which becomes the number of that solution. If the matrix is singular, the solutions are not finite. All sides together take
/// about half of the time of [`Factors`] (18 of 36 equations), which serves right-hand sides that come one after the other.
pub fn solve_rows(size: usize, width: usize, equations: &mut [f64]) {
    for k in 0..size {
        let of_size = |row: &usize| equations[row * width + k].abs();
        let pivot = (k..size).max_by(|i, j| of_size(i).total_cmp(&of_size(j))).unwrap_or(k);
        let (upper, lower) = equations.split_at_mut((k + 1) * width);
        let pivot_row = &mut upper[k * width..];
        if pivot > k {
            pivot_row.swap_with_slice(&mut lower[(pivot - k - 1) * width..][..width]);
        }
        let reciprocal = 1.0 / pivot_row[k];
        for row in lower.chunks_exact_mut(width) {
            let factor = -row[k] * reciprocal;
            if factor != 0.0 {
                add_multiple(&mut row[k + 1..], factor, &pivot_row[k + 1..]);
            }
        }
    }
    for k in (0..size).rev() {
        let (upper, lower) = equations.split_at_mut(k * width);
        let reciprocal = 1.0 / lower[k];
        let solution = &mut lower[size..width];
        solution.iter_mut().for_each(|number| *number *= reciprocal);
        for row in upper.chunks_exact_mut(width) {
            let factor = -row[k];
            if factor != 0.0 {
                add_multiple(&mut row[size..], factor, solution);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hilbert_matrix_with_its_rows_turned_is_solved() {
        // A row of zeros on the diagonal's place asks for pivots.
        let element = |i: usize, j: usize| 1.0 / (((i + 2) % 5 + j + 1) as f64) + if i == j { -0.2 } else { 0.0 };
        let exact = [1.0, -2.0, 3.0, 0.5, 4.0];
        let mut x = [0.0; 5];
        for (i, x) in x.iter_mut().enumerate() {
            *x = (0..5).map(|j| element(i, j) * exact[j]).sum();
        }
        let mut factors = Factors::with_capacity(8);
        factors.of(5, element);
        factors.solve(&mut x);
        for (found, exact) in x.iter().zip(&exact) {
            assert!((found - exact).abs() < 1e-11, "{found} is not {exact}");
        }
    }

    #[test]
    fn several_right_hand_sides_are_solved_together() {
        let element = |i: usize, j: usize| 1.0 / (((i + 2) % 5 + j + 1) as f64) + if i == j { -0.2 } else { 0.0 };
        let exact = |j: usize, side: usize| (j * j) as f64 - 1.5 * side as f64;
        let (size, width) = (5, 8);
        let number = |at: usize| match (at / width, at % width) {
            (i, j) if j < size => element(i, j),
            (i, j) => (0..size).map(|k| element(i, k) * exact(k, j - size)).sum(),
        };
        let mut equations: Vec<f64> = (0..size * width).map(number).collect();
        solve_rows(size, width, &mut equations);
        for (j, row) in equations.chunks(width).enumerate() {
            for (side, found) in row[size..].iter().enumerate() {
                let exact = exact(j, side);
                assert!((found - exact).abs() < 1e-10, "{found} is not {exact}");
            }
        }
        let mut singular: Vec<f64> = (0..6).map(|at| f64::from(at / 3 + at % 3)).collect();
        singular.splice(3..5, [0.0, 0.0]);
        solve_rows(2, 3, &mut singular);
        assert!(!singular[5].is_finite(), "{singular:?}");
    }

    #[test]
    fn four_complex_systems_are_solved_together() {
        let element = |i: usize, j: usize| {
            let number = |lane: usize| 1.0 / (((i + 2) % 5 + j + 1 + lane) as f64);
            let turned = if i == j { -0.2 } else { 0.1 };
            Complex4::of([0, 1, 2, 3].map(number), [turned, -turned, 2.0 * turned, 0.0])
        };
        let exact = [1.0, -2.0, 3.0, 0.5, 4.0].map(|re| Complex4::of([re, -re, 2.0, re], [0.5, re, 1.0, 0.0]));
        let mut x = [Complex4::ZERO; 5];
        for (i, x) in x.iter_mut().enumerate() {
            *x = (0..5).fold(Complex4::ZERO, |sum, j| sum + element(i, j) * exact[j]);
        }
        let mut factors = FourFactors::with_capacity(8);
        factors.of(5, element);
        factors.solve(&mut x);
        for (found, exact) in x.iter().zip(&exact) {
            assert!((*found - *exact).size() < 1e-9, "{found:?} is not {exact:?}");
        }
    }

    #[test]
    fn a_singular_matrix_has_no_finite_solution() {
        let mut factors = Factors::with_capacity(3);
        factors.of(3, |i, j| (i + j) as f64);
        let mut x = [1.0, 2.0, 4.0];
        factors.solve(&mut x);
        assert!(!x.iter().all(|x| x.is_finite() && x.abs() < 1e12), "{x:?}");
    }

    #[test]
    fn no_equations_have_no_solution() {
        let mut factors = Factors::with_capacity(0);
        factors.of(0, |_, _| 1.0);
        factors.solve(&mut []);
    }
}
