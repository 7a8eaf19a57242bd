//! Systems of linear equations in room of fixed size.

/// L·U factors of a square matrix with rows exchanged (Gaussian elimination with partial pivoting).
pub struct Factors<const N: usize> {
    size: usize,
    rows: [[f64; N]; N],
    /// The row that was exchanged with row k.
    pivot: [usize; N],
}

impl<const N: usize> Factors<N> {
    /// Of no matrix.
    pub const NONE: Self = Self { size: 0, rows: [[0.0; N]; N], pivot: [0; N] };

    /// Factorises the matrix of `size` rows with these elements. A singular one gives solutions that
    /// are not finite.
    pub fn of(&mut self, size: usize, element: impl Fn(usize, usize) -> f64) {
        self.size = size;
        for (i, row) in self.rows.iter_mut().enumerate().take(size) {
            for (j, place) in row.iter_mut().enumerate().take(size) {
                *place = element(i, j);
            }
        }
        for k in 0..size {
            let by_size = |i: &usize, j: &usize| self.rows[*i][k].abs().total_cmp(&self.rows[*j][k].abs());
            let pivot = (k..size).max_by(by_size).unwrap_or(k);
            self.pivot[k] = pivot;
            self.rows.swap(k, pivot);
            let (above, below) = self.rows.split_at_mut(k + 1);
            let top = &above[k];
            for row in below.iter_mut().take(size - k - 1) {
                let factor = row[k] / top[k];
                row[k] = factor;
                if factor != 0.0 {
                    for (element, top) in row[k + 1..size].iter_mut().zip(&top[k + 1..size]) {
                        *element -= factor * top;
                    }
                }
            }
        }
    }

    /// Replaces the right side `x` by the solution.
    pub fn solve(&self, x: &mut [f64]) {
        for k in 0..self.size {
            x.swap(k, self.pivot[k]);
        }
        for i in 0..self.size {
            let (known, rest) = x.split_at_mut(i);
            rest[0] -= self.rows[i].iter().zip(&*known).map(|(l, x)| l * x).sum::<f64>();
        }
        for i in (0..self.size).rev() {
            let (rest, known) = x.split_at_mut(i + 1);
            let sum = self.rows[i][i + 1..self.size].iter().zip(&*known).map(|(u, x)| u * x).sum::<f64>();
            rest[i] = (rest[i] - sum) / self.rows[i][i];
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
        let mut factors = Factors::<8>::NONE;
        factors.of(5, element);
        factors.solve(&mut x);
        for (found, exact) in x.iter().zip(&exact) {
            assert!((found - exact).abs() < 1e-11, "{found} is not {exact}");
        }
    }
}
