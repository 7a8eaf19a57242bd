//! Linear complementarity, w = M·z + q with w ≥ 0, z ≥ 0, w·z = 0, by Lemke's method (C. E. Lemke, Management
//! Science 11 (1965) 681): a column that covers the negative q enters first, then the complement of what left, until
//! the cover leaves. Ties, which redundant contacts bring, are broken lexicographically, so that no basis comes twice
//! (R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem, Academic Press 1992, 4.4 and 4.9).

/// Most unknowns.
pub const MOST_UNKNOWNS: usize = 28;

/// A smaller element is zero but for rounding; the elements of a problem are scaled to about 1.
const LEAST_PIVOT: f64 = 1e-11;
/// Closer ratios are tied.
const TIE: f64 = 1e-12;
/// A cover below this is none but for rounding.
const ROUNDING: f64 = 1e-9;
/// Pivots per unknown, at most; it takes about one.
const PIVOTS: usize = 30;
/// Width of the tableau: the right side, w, z and the cover.
const WIDTH: usize = 2 * MOST_UNKNOWNS + 2;
/// Column of the right side. The columns of w follow, so that a row begins with what the order of rows is told by.
const RIGHT: usize = 0;

/// M and q, of which the first `size` rows and columns count.
pub struct LinearComplementarity {
    /// Number of unknowns.
    pub size: usize,
    /// M.
    pub matrix: [[f64; MOST_UNKNOWNS]; MOST_UNKNOWNS],
    /// q.
    pub vector: [f64; MOST_UNKNOWNS],
}

struct Tableau {
    size: usize,
    rows: [[f64; WIDTH]; MOST_UNKNOWNS],
    /// Column of each row's basic variable.
    basis: [usize; MOST_UNKNOWNS],
}

impl LinearComplementarity {
    /// z, or `None` where the method ends in a ray: for a copositive M only where there may be no solution. Any
    /// `cover` above 0 will do, each takes a way of its own.
    pub fn solve(&self, cover_of: impl Fn(usize) -> f64) -> Option<[f64; MOST_UNKNOWNS]> {
        let n = self.size;
        if self.vector.iter().take(n).all(|&q| q >= 0.0) {
            return Some([0.0; MOST_UNKNOWNS]);
        }
        let mut tableau = Tableau { size: n, rows: [[0.0; WIDTH]; MOST_UNKNOWNS], basis: [0; MOST_UNKNOWNS] };
        let cover = 2 * n + 1;
        for (i, row) in tableau.rows.iter_mut().enumerate().take(n) {
            // w − M·z − d·cover = q
            row[RIGHT] = self.vector[i];
            row[1 + i] = 1.0;
            for j in 0..n {
                row[1 + n + j] = -self.matrix[i][j];
            }
            row[cover] = -cover_of(i);
            tableau.basis[i] = 1 + i;
        }
        let mut row = (1..n).fold(0, |least, i| if tableau.precedes(i, least, cover, -1.0) { i } else { least });
        let mut entering = cover;
        for _ in 0..PIVOTS * n {
            let left = tableau.pivot(row, entering);
            if left == cover {
                return Some(tableau.unknowns());
            }
            entering = if left <= n { left + n } else { left - n };
            match tableau.leaving(entering, cover) {
                Some(leaving) => row = leaving,
                // Contacts face to face leave no room but for rounding: then the cover stays, at almost nothing.
                None => return (tableau.value(cover) <= ROUNDING).then(|| tableau.unknowns()),
            }
        }
        None
    }
}

impl Tableau {
    /// The row whose variable reaches zero first when `entering` grows; the cover's if it is among them.
    fn leaving(&self, entering: usize, cover: usize) -> Option<usize> {
        let mut first = None;
        for row in (0..self.size).filter(|&row| self.rows[row][entering] > LEAST_PIVOT) {
            if first.is_none_or(|first| self.precedes(row, first, entering, 1.0)) {
                first = Some(row);
            }
        }
        let ratio = |row: usize| self.rows[row][RIGHT] / self.rows[row][entering];
        let last = (0..self.size).find(|&row| self.basis[row] == cover && self.rows[row][entering] > LEAST_PIVOT);
        match (first, last) {
            (Some(first), Some(last)) if ratio(last) <= ratio(first) + TIE => Some(last),
            _ => first,
        }
    }

    /// Row `one` over `sign` times its element in `column` is lexicographically less than row `other`.
    fn precedes(&self, one: usize, other: usize, column: usize, sign: f64) -> bool {
        let share = |row: usize, place: usize| self.rows[row][place] / (sign * self.rows[row][column]);
        for place in RIGHT..=self.size {
            let (x, y) = (share(one, place), share(other, place));
            if (x - y).abs() > TIE * (1.0 + x.abs().max(y.abs())) {
                return x < y;
            }
        }
        false
    }

    /// Brings `entering` into the basis in the place of `row`'s variable, which is returned.
    fn pivot(&mut self, row: usize, entering: usize) -> usize {
        let width = 2 * self.size + 2;
        let per_pivot = 1.0 / self.rows[row][entering];
        for element in self.rows[row].iter_mut().take(width) {
            *element *= per_pivot;
        }
        self.rows[row][entering] = 1.0;
        let pivot_row = self.rows[row];
        for (_, other) in self.rows.iter_mut().enumerate().take(self.size).filter(|(i, _)| *i != row) {
            let factor = other[entering];
            if factor != 0.0 {
                for (element, pivot) in other.iter_mut().zip(&pivot_row).take(width) {
                    *element -= factor * pivot;
                }
                other[entering] = 0.0;
            }
        }
        std::mem::replace(&mut self.basis[row], entering)
    }

    /// Value of a variable.
    fn value(&self, variable: usize) -> f64 {
        let row = (0..self.size).find(|&row| self.basis[row] == variable);
        row.map_or(0.0, |row| self.rows[row][RIGHT])
    }

    fn unknowns(&self) -> [f64; MOST_UNKNOWNS] {
        let mut z = [0.0; MOST_UNKNOWNS];
        for (row, &variable) in self.rows.iter().zip(&self.basis).take(self.size) {
            if variable > self.size && variable <= 2 * self.size {
                z[variable - self.size - 1] = row[RIGHT].max(0.0);
            }
        }
        z
    }
}
