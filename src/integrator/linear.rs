//! Systems of linear equations, solved without allocation.

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
