//! Systems of linear equations, solved without a new allocation.

/// L·U factors of a square matrix with rows exchanged (Gaussian elimination with partial pivoting).
#[derive(Clone, Debug, Default)]
pub struct Factors {
    size: usize,
    /// Row by row.
    elements: Vec<f64>,
    /// The row that was exchanged with row k.
    pivot: Vec<usize>,
}

impl Factors {
    /// With memory for matrices of up to so many rows.
    pub fn with_capacity(rows: usize) -> Self {
        Self { size: 0, elements: vec![0.0; rows * rows], pivot: vec![0; rows] }
    }

    /// Factorises the matrix of `size` rows with these elements. A singular one gives solutions that
    /// are not finite.
    pub fn of(&mut self, size: usize, element: impl Fn(usize, usize) -> f64) {
        self.size = size;
        let Self { elements, pivot, .. } = self;
        for i in 0..size {
            for (j, place) in elements[i * size..][..size].iter_mut().enumerate() {
                *place = element(i, j);
            }
        }
        for k in 0..size {
            let by_size = |i: &usize, j: &usize| elements[i * size + k].abs().total_cmp(&elements[j * size + k].abs());
            let largest = (k..size).max_by(by_size).unwrap_or(k);
            pivot[k] = largest;
            if largest > k {
                let (above, below) = elements.split_at_mut(largest * size);
                above[k * size..][..size].swap_with_slice(&mut below[..size]);
            }
            let (above, below) = elements.split_at_mut((k + 1) * size);
            let top = &above[k * size..];
            for row in below.chunks_exact_mut(size).take(size - k - 1) {
                let factor = row[k] / top[k];
                row[k] = factor;
                if factor != 0.0 {
                    for (element, top) in row[k + 1..].iter_mut().zip(&top[k + 1..]) {
                        *element -= factor * top;
                    }
                }
            }
        }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.elements[i * self.size..][..self.size]
    }

    /// Replaces the right side `x` by the solution.
    pub fn solve(&self, x: &mut [f64]) {
        for k in 0..self.size {
            x.swap(k, self.pivot[k]);
        }
        for i in 0..self.size {
            let (known, rest) = x.split_at_mut(i);
            rest[0] -= self.row(i).iter().zip(&*known).map(|(l, x)| l * x).sum::<f64>();
        }
        for i in (0..self.size).rev() {
            let (rest, known) = x.split_at_mut(i + 1);
            let sum = self.row(i)[i + 1..].iter().zip(&*known).map(|(u, x)| u * x).sum::<f64>();
            rest[i] = (rest[i] - sum) / self.row(i)[i];
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
}
