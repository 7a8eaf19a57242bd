//! Consistency checks of a modal table.

use super::modal::{MAX_MODES, ModalTable, functions, pairs};
use crate::model_description::number::number;
use std::fmt;

/// Relative tolerance for numbers that must be equal, for the rounding of an export.
const ROUNDING: f64 = 1e-3;
/// Relative tolerance for the symmetry of a matrix, whose two elements come from one number.
const SYMMETRY: f64 = 1e-9;

/// Errors of a modal table.
#[derive(Clone, Debug, PartialEq)]
pub enum TableError {
    /// There are more modes than supported.
    Modes {
        /// `bending` or `axial`.
        list: &'static str,
        /// Number of modes.
        found: usize,
    },
    /// A list or a row has another length than the numbers of modes require.
    Length {
        /// Name of the list or row.
        list: String,
        /// Length found.
        found: usize,
        /// Length required.
        wanted: usize,
    },
    /// A number is not possible.
    Value {
        /// Name of the number.
        name: String,
        /// Value found.
        found: f64,
        /// The allowed values, in words.
        allowed: String,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("rod.flexible.table: ")?;
        match self {
            Self::Modes { list, found } => write!(f, "{found} modes in {list}, more than {MAX_MODES}"),
            Self::Length { list, found, wanted } => write!(f, "{found} numbers in {list}, not {wanted}"),
            Self::Value { name, found, allowed } => {
                write!(f, "{name} = {} is not allowed: {allowed}", number(*found))
            }
        }
    }
}

impl std::error::Error for TableError {}

impl ModalTable {
    /// Checks that the table can be that of a rod.
    ///
    /// # Errors
    /// The first inconsistency.
    pub fn check(&self) -> Result<(), TableError> {
        self.check_lengths()?;
        above_zero("mass", self.mass)?;
        self.check_modes()?;
        self.check_integrals()
    }

    fn check_lengths(&self) -> Result<(), TableError> {
        for (list, found) in [("bending", self.bending.len()), ("axial", self.axial.len())] {
            if found > MAX_MODES {
                return Err(TableError::Modes { list, found });
            }
        }
        let bending = self.bending.len();
        let functions = functions(bending, self.axial.len());
        length("shortening", self.shortening.len(), pairs(bending))?;
        length("first", self.first.len(), functions)?;
        for (name, rows, columns) in [("second", &self.second, functions), ("coupling", &self.coupling, bending)] {
            length(&format!("the first column of {name}"), rows.len(), functions)?;
            for (index, row) in rows.iter().enumerate() {
                length(&format!("row {} of {name}", index + 1), row.len(), columns)?;
            }
        }
        Ok(())
    }

    fn check_modes(&self) -> Result<(), TableError> {
        let bending = self.bending.iter().map(|mode| (mode.frequency, mode.mass));
        let axial = self.axial.iter().map(|mode| (mode.frequency, mode.mass));
        for (kind, modes) in [("bending", bending.collect::<Vec<_>>()), ("axial", axial.collect())] {
            let mut before = 0.0;
            for (index, (frequency, mass)) in modes.into_iter().enumerate() {
                let named = |what: &str| format!("{what} of {kind} mode {}", index + 1);
                above_zero(&named("frequency"), frequency)?;
                above_zero(&named("mass"), mass)?;
                let allowed = || format!("at least the {} rad/s of the mode before", number(before));
                value(frequency >= before, || named("frequency"), frequency, allowed)?;
                before = frequency;
            }
        }
        let shapes = self.bending.iter().flat_map(|mode| [mode.moment, mode.middle, mode.slope_start, mode.slope_end]);
        let others = shapes.chain(self.axial.iter().map(|mode| mode.end)).chain(self.shortening.iter().copied());
        others.into_iter().try_for_each(|number| {
            value(number.is_finite(), || "a number of a mode or of shortening".into(), number, finite)
        })
    }

    /// Checks that the integrals are inner products over the rod's mass, of 1, the functions B and the shapes φ. By the
    /// Schwarz inequality their magnitude is bounded by the squares of both functions; a wrong unit violates the bound.
    fn check_integrals(&self) -> Result<(), TableError> {
        let square = |row: usize| self.second[row][row];
        for row in 0..self.second.len() {
            above_zero(&place("second", row, row), square(row))?;
        }
        // The first row belongs to x, whose value at the end is the rod's length.
        let (about_end, first) = (square(0), self.first[0]);
        let least = first * first / self.mass;
        let allowed = || format!("above {}, what the mass would have at its centre", number(least));
        value(about_end > least, || place("second", 0, 0), about_end, allowed)?;
        for (index, mode) in self.axial.iter().enumerate() {
            let row = 1 + index;
            let agrees = (square(row) - mode.mass).abs() <= ROUNDING * mode.mass;
            let allowed = || format!("the mass of axial mode {row}, {}", number(mode.mass));
            value(agrees, || place("second", row, row), square(row), allowed)?;
        }
        for (index, mode) in self.bending.iter().enumerate() {
            within(|| format!("moment of bending mode {}", index + 1), mode.moment, self.mass * mode.mass)?;
        }
        for (row, (first, products)) in self.first.iter().zip(&self.second).enumerate() {
            within(|| format!("number {} of first", row + 1), *first, self.mass * square(row))?;
            for (column, product) in products.iter().enumerate() {
                let squares = square(row) * square(column);
                within(|| place("second", row, column), *product, squares)?;
                let mirrored = self.second[column][row];
                let symmetric = (product - mirrored).abs() <= SYMMETRY * squares.sqrt();
                let allowed = || format!("{}, as in the transposed place", number(mirrored));
                value(symmetric, || place("second", row, column), *product, allowed)?;
            }
            for (column, mode) in self.bending.iter().enumerate() {
                let product = self.coupling[row][column];
                within(|| place("coupling", row, column), product, square(row) * mode.mass)?;
            }
        }
        Ok(())
    }
}

fn place(matrix: &str, row: usize, column: usize) -> String {
    format!("row {}, column {} of {matrix}", row + 1, column + 1)
}

fn finite() -> String {
    "a finite number".to_owned()
}

fn length(list: &str, found: usize, wanted: usize) -> Result<(), TableError> {
    if found == wanted { Ok(()) } else { Err(TableError::Length { list: list.to_owned(), found, wanted }) }
}

fn above_zero(name: &str, found: f64) -> Result<(), TableError> {
    value(found > 0.0 && found.is_finite(), || name.to_owned(), found, || "above 0".to_owned())
}

/// Schwarz inequality: (∫f·g dm)² ≤ ∫f² dm · ∫g² dm.
fn within(name: impl FnOnce() -> String, product: f64, squares: f64) -> Result<(), TableError> {
    let most = squares.sqrt() * (1.0 + ROUNDING);
    value(product.abs() <= most, name, product, || format!("{} to {}", number(-most), number(most)))
}

fn value(
    holds: bool,
    name: impl FnOnce() -> String,
    found: f64,
    allowed: impl FnOnce() -> String,
) -> Result<(), TableError> {
    if holds { Ok(()) } else { Err(TableError::Value { name: name(), found, allowed: allowed() }) }
}

#[cfg(test)]
mod tests {
    use super::super::modal::{AxialMode, BendingMode};
    use super::*;

    /// Two orthonormal shapes and Γ11 of a rod of mass 1: integrals that satisfy the Schwarz inequality.
    fn table() -> ModalTable {
        let shape =
            BendingMode { frequency: 6e3, mass: 1.0, moment: 0.9, middle: 1.0, slope_start: 3.0, slope_end: -3.0 };
        ModalTable {
            mass: 1.0,
            bending: vec![shape],
            axial: vec![AxialMode { frequency: 7e4, mass: 1.0, end: 1.4 }],
            shortening: vec![2.5],
            first: vec![0.5, 0.9, 1.2],
            second: vec![vec![0.33, 0.4, 0.7], vec![0.4, 1.0, 1.3], vec![0.7, 1.3, 2.0]],
            coupling: vec![vec![0.4], vec![0.8], vec![1.1]],
        }
    }

    fn refused(edit: impl FnOnce(&mut ModalTable)) -> String {
        let mut table = table();
        edit(&mut table);
        let told = table.check().expect_err("a table of no rod").to_string();
        told.strip_prefix("rod.flexible.table: ").expect("the key").to_owned()
    }

    #[test]
    fn a_sound_table_passes() {
        assert_eq!(table().check(), Ok(()));
    }

    #[test]
    fn lists_have_the_lengths_that_the_modes_ask_for() {
        assert_eq!(refused(|t| t.first.push(0.0)), "4 numbers in first, not 3");
        assert_eq!(refused(|t| t.shortening.clear()), "0 numbers in shortening, not 1");
        assert_eq!(refused(|t| t.second.truncate(2)), "2 numbers in the first column of second, not 3");
        assert_eq!(refused(|t| t.second[1].truncate(2)), "2 numbers in row 2 of second, not 3");
        assert_eq!(refused(|t| t.coupling[2].push(0.0)), "2 numbers in row 3 of coupling, not 1");
        assert_eq!(refused(|t| t.coupling.push(vec![])), "4 numbers in the first column of coupling, not 3");
        assert_eq!(refused(|t| t.bending = vec![t.bending[0]; 9]), "9 modes in bending, more than 8");
    }

    #[test]
    fn masses_and_frequencies_are_above_zero_and_frequencies_rise() {
        assert_eq!(refused(|t| t.mass = 0.0), "mass = 0 is not allowed: above 0");
        let told = refused(|t| t.bending[0].frequency = -1.0);
        assert_eq!(told, "frequency of bending mode 1 = -1 is not allowed: above 0");
        let told = refused(|t| t.axial[0].mass = f64::INFINITY);
        assert_eq!(told, "mass of axial mode 1 = inf is not allowed: above 0");
        assert!(refused(|t| t.bending[0].middle = f64::NAN).ends_with("a finite number"));
        assert!(refused(|t| t.shortening[0] = f64::INFINITY).ends_with("a finite number"));
        let mut falling = table();
        falling.axial.push(AxialMode { frequency: 6e4, ..falling.axial[0] });
        let told = falling.check_modes().expect_err("a mode out of order").to_string();
        assert!(
            told.ends_with(
                "frequency of axial mode 2 = 60000 is not allowed: at least the 70000 rad/s of the mode before"
            ),
            "{told}"
        );
    }

    #[test]
    fn integrals_agree_with_each_other() {
        let told = refused(|t| t.second[2][0] = 0.6);
        assert_eq!(told, "row 1, column 3 of second = 0.7 is not allowed: 0.6, as in the transposed place");
        let told = refused(|t| t.second[1][1] = 1.1);
        assert_eq!(told, "row 2, column 2 of second = 1.1 is not allowed: the mass of axial mode 1, 1");
        assert!(refused(|t| t.second[0][0] = 0.0).starts_with("row 1, column 1 of second = 0 is not allowed: above 0"));
        // Millimetres in one place and metres in the others.
        let told = refused(|t| t.first[0] = 500.0);
        let wanted =
            "row 1, column 1 of second = 0.33 is not allowed: above 2.5e5, what the mass would have at its centre";
        assert_eq!(told, wanted);
        assert!(refused(|t| t.first[2] = 500.0).starts_with("number 3 of first = 500 is not allowed: -1.41"));
        assert!(refused(|t| t.bending[0].moment = 900.0).starts_with("moment of bending mode 1 = 900 is not allowed"));
        assert!(refused(|t| t.coupling[2][0] = 1.5).starts_with("row 3, column 1 of coupling = 1.5 is not allowed"));
        assert!(refused(|t| t.second[0][2] = f64::NAN).starts_with("row 1, column 3 of second = NaN is not allowed"));
    }
}
