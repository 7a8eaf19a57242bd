//! Linear complementarity problem w = M·z + q, w ≥ 0, z ≥ 0, w·z = 0, by Lemke's method (C. E. Lemke, Management
//! Science 11 (1965) 681): a covering column for the negative q enters the basis first, then the complement of
//! whichever variable has left, until the covering variable leaves. Redundant contacts cause ties, which are broken
//! lexicographically, so that no basis recurs (R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity
//! Problem, Academic Press 1992, 4.4 and 4.9).

/// Maximum number of unknowns.
pub const MAX_UNKNOWNS: usize = 28;

/// The elements of a problem are scaled to about 1; an element below this is a rounding error.
const MIN_PIVOT: f64 = 1e-11;
/// Ratios that differ by less than this are tied.
const TIE: f64 = 1e-12;
/// A covering variable below this is a rounding error.
const ROUNDING: f64 = 1e-9;
/// Maximum number of pivots per unknown; about one is needed.
const MAX_PIVOTS_PER_UNKNOWN: usize = 30;
/// Width of the tableau: the right-hand side, w, z and the covering variable.
const WIDTH: usize = 2 * MAX_UNKNOWNS + 2;
/// Column of the right-hand side. The columns of w follow, so that a row starts with the elements that decide the
/// lexicographic order.
const RIGHT_HAND_SIDE: usize = 0;

/// M and q; the first `size` rows and columns are used.
pub struct LinearComplementarity {
    /// Number of unknowns.
    pub size: usize,
    /// M.
    pub matrix: [[f64; MAX_UNKNOWNS]; MAX_UNKNOWNS],
    /// q.
    pub vector: [f64; MAX_UNKNOWNS],
}

struct Tableau {
    size: usize,
    rows: [[f64; WIDTH]; MAX_UNKNOWNS],
    /// Column of each row's basic variable.
    basis: [usize; MAX_UNKNOWNS],
}

impl LinearComplementarity {
    /// The solution z, or `None` if the method ends in a ray. For a copositive M this happens only where there may be
    /// no solution. `cover_of` gives the positive elements of the covering column; each choice leads along a different
    /// path.
    pub fn solve(&self, cover_of: impl Fn(usize) -> f64) -> Option<[f64; MAX_UNKNOWNS]> {
        let n = self.size;
        if self.vector.iter().take(n).all(|&q| q >= 0.0) {
            return Some([0.0; MAX_UNKNOWNS]);
        }
        let mut tableau = Tableau { size: n, rows: [[0.0; WIDTH]; MAX_UNKNOWNS], basis: [0; MAX_UNKNOWNS] };
        let cover = 2 * n + 1;
        for (i, row) in tableau.rows.iter_mut().enumerate().take(n) {
            // w − M·z − d·cover = q
            row[RIGHT_HAND_SIDE] = self.vector[i];
            row[1 + i] = 1.0;
            for j in 0..n {
                row[1 + n + j] = -self.matrix[i][j];
            }
            row[cover] = -cover_of(i);
            tableau.basis[i] = 1 + i;
        }
        let mut row = (1..n).fold(0, |least, i| if tableau.precedes(i, least, cover, -1.0) { i } else { least });
        let mut entering = cover;
        for _ in 0..MAX_PIVOTS_PER_UNKNOWN * n {
            let leaving_variable = tableau.pivot(row, entering);
            if leaving_variable == cover {
                return Some(tableau.unknowns());
            }
            entering = if leaving_variable <= n { leaving_variable + n } else { leaving_variable - n };
            match tableau.leaving(entering, cover) {
                Some(leaving) => row = leaving,
                // Contacts that face each other leave no clearance but for rounding: the covering variable stays, near
                // zero.
                None => return (tableau.value(cover) <= ROUNDING).then(|| tableau.unknowns()),
            }
        }
        None
    }
}

impl Tableau {
    /// The row whose variable reaches zero first as `entering` grows; the covering variable's row if it is tied.
    fn leaving(&self, entering: usize, cover: usize) -> Option<usize> {
        let mut first = None;
        for row in (0..self.size).filter(|&row| self.rows[row][entering] > MIN_PIVOT) {
            if first.is_none_or(|first| self.precedes(row, first, entering, 1.0)) {
                first = Some(row);
            }
        }
        let ratio = |row: usize| self.rows[row][RIGHT_HAND_SIDE] / self.rows[row][entering];
        let last = (0..self.size).find(|&row| self.basis[row] == cover && self.rows[row][entering] > MIN_PIVOT);
        match (first, last) {
            (Some(first), Some(last)) if ratio(last) <= ratio(first) + TIE => Some(last),
            _ => first,
        }
    }

    /// Whether row `one`, divided by `sign` times its element in `column`, is lexicographically less than row `other`.
    fn precedes(&self, one: usize, other: usize, column: usize, sign: f64) -> bool {
        let share = |row: usize, place: usize| self.rows[row][place] / (sign * self.rows[row][column]);
        for place in RIGHT_HAND_SIDE..=self.size {
            let (x, y) = (share(one, place), share(other, place));
            if (x - y).abs() > TIE * (1.0 + x.abs().max(y.abs())) {
                return x < y;
            }
        }
        false
    }

    /// Brings `entering` into the basis in place of the variable of `row`, which is returned.
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

    /// Value of a variable in the present basis.
    fn value(&self, variable: usize) -> f64 {
        let row = (0..self.size).find(|&row| self.basis[row] == variable);
        row.map_or(0.0, |row| self.rows[row][RIGHT_HAND_SIDE])
    }

    fn unknowns(&self) -> [f64; MAX_UNKNOWNS] {
        let mut z = [0.0; MAX_UNKNOWNS];
        for (row, &variable) in self.rows.iter().zip(&self.basis).take(self.size) {
            if variable > self.size && variable <= 2 * self.size {
                z[variable - self.size - 1] = row[RIGHT_HAND_SIDE].max(0.0);
            }
        }
        z
    }
}
