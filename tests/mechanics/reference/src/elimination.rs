//! Gauss: a dense linear system with partial pivoting, sparing what is 0.

/// Nine rows of constraints under all coordinates.
const LARGEST: usize = crate::coordinates::COORDINATES + 9;

/// A square matrix with the right side as its last column.
pub struct System {
    size: usize,
    rows: [[f64; LARGEST + 1]; LARGEST],
}

impl System {
    pub fn new(size: usize) -> Self {
        Self { size, rows: [[0.0; LARGEST + 1]; LARGEST] }
    }

    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row][column] = value;
    }

    pub fn set_right(&mut self, row: usize, value: f64) {
        self.rows[row][self.size] = value;
    }

    /// The solution in its first `size` places.
    pub fn solve(mut self) -> [f64; LARGEST] {
        let n = self.size;
        for pivot in 0..n {
            let greatest = (pivot..n)
                .max_by(|&a, &b| self.rows[a][pivot].abs().total_cmp(&self.rows[b][pivot].abs()))
                .unwrap_or(pivot);
            self.rows.swap(pivot, greatest);
            let (above, below) = self.rows.split_at_mut(pivot + 1);
            let top = &above[pivot];
            assert!(top[pivot] != 0.0, "the mechanism stands away from its singular positions");
            for row in &mut below[..n - pivot - 1] {
                let factor = row[pivot] / top[pivot];
                if factor != 0.0 {
                    for (entry, upper) in row[pivot..=n].iter_mut().zip(&top[pivot..=n]) {
                        *entry -= factor * upper;
                    }
                }
            }
        }
        let mut solution = [0.0; LARGEST];
        for pivot in (0..n).rev() {
            let row = &self.rows[pivot];
            let known: f64 = (pivot + 1..n).map(|column| row[column] * solution[column]).sum();
            solution[pivot] = (row[n] - known) / row[pivot];
        }
        solution
    }
}
