//! Time series with one row for each communication point and one column for each variable; read and written as CSV.

use anyhow::{Context, Result, bail};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// A table of numbers whose first column is time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    names: Vec<String>,
    /// [s]
    times: Vec<f64>,
    /// Values by column and row.
    columns: Vec<Vec<f64>>,
}

impl Trajectory {
    /// An empty table with these columns and time.
    pub fn new(names: impl IntoIterator<Item = String>) -> Self {
        let names: Vec<String> = names.into_iter().collect();
        let columns = vec![Vec::new(); names.len()];
        Self { names, times: Vec::new(), columns }
    }

    /// Adds one row.
    pub fn push(&mut self, time: f64, row: &[f64]) {
        assert_eq!(row.len(), self.columns.len(), "a row has one value for each column");
        self.times.push(time);
        self.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(*value));
    }

    /// [s] The communication points.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Names of the columns, without time.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// The column of this name.
    pub fn column(&self, name: &str) -> Result<&[f64]> {
        let place = self.names.iter().position(|own| own == name);
        place.map(|place| self.columns[place].as_slice()).with_context(|| format!("no column `{name}`"))
    }

    /// Writes `time` and every column. Each number has the fewest digits that give the same number when read.
    pub fn write_csv(&self, file: &Path) -> Result<()> {
        let context = || format!("cannot write {}", file.display());
        let mut out = BufWriter::new(File::create(file).with_context(context)?);
        write!(out, "time").with_context(context)?;
        self.names.iter().try_for_each(|name| write!(out, ",{}", quoted(name))).with_context(context)?;
        for (row, time) in self.times.iter().enumerate() {
            write!(out, "\n{}", Shortest(*time)).with_context(context)?;
            for column in &self.columns {
                write!(out, ",{}", Shortest(column[row])).with_context(context)?;
            }
        }
        writeln!(out).with_context(context)?;
        out.flush().with_context(context)
    }

    /// Reads a CSV file whose first column is strictly increasing time. An error names the line.
    pub fn read_csv(file: &Path) -> Result<Self> {
        let shown = file.display();
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_path(file)
            .with_context(|| format!("cannot read {shown}"))?;
        let header = reader.headers().with_context(|| shown.to_string())?.clone();
        if header.get(0) != Some("time") {
            bail!("{shown}, line 1: the first column is `{}`, but must be `time`", header.get(0).unwrap_or_default());
        }
        let mut trajectory = Self::new(header.iter().skip(1).map(str::to_owned));
        for record in reader.records() {
            let record = record.with_context(|| shown.to_string())?;
            let line = record.position().map_or(0, csv::Position::line);
            let numbers: Vec<f64> = (record.iter().zip(&header))
                .map(|(text, name)| match text.parse::<f64>() {
                    Ok(number) if number.is_finite() => Ok(number),
                    _ => bail!("{shown}, line {line}, column `{name}`: `{text}` is not a finite number"),
                })
                .collect::<Result<_>>()?;
            let (time, row) = (numbers[0], &numbers[1..]);
            if trajectory.times.last().is_some_and(|last| time <= *last) {
                bail!("{shown}, line {line}: time {time} s does not increase");
            }
            trajectory.push(time, row);
        }
        if trajectory.is_empty() {
            bail!("{shown}: there are no rows");
        }
        Ok(trajectory)
    }
}

/// Quotes a name that contains commas, such as `a[1,2]`.
fn quoted(name: &str) -> String {
    if name.contains([',', '"']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.into() }
}

/// The number without or with an exponent, whichever is shorter.
struct Shortest(f64);

impl std::fmt::Display for Shortest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Between these bounds the form without exponent is at most four characters longer.
        if self.0 == 0.0 || (1e-3..1e9).contains(&self.0.abs()) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_gives_back_the_same_bits() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        let mut trajectory = Trajectory::new(["slider.x".to_owned(), "matrix[1,2]".to_owned()]);
        trajectory.push(0.0, &[1.0 / 3.0, -5e-324]);
        trajectory.push(1e-5, &[f64::MAX, -0.0]);
        trajectory.push(0.1 + 0.2, &[123456.789, 1.0e-3]);
        trajectory.write_csv(file.path()).expect("written");
        let read = Trajectory::read_csv(file.path()).expect("read");
        assert_eq!(read, trajectory);
        let bits = |t: &Trajectory| t.columns.concat().iter().map(|number| number.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&trajectory));
    }

    #[test]
    fn a_bad_csv_is_refused_with_its_line() {
        let complaint = |text: &str| {
            let file = tempfile::NamedTempFile::new().expect("a temporary file");
            std::fs::write(file.path(), text).expect("written");
            format!("{:#}", Trajectory::read_csv(file.path()).expect_err("a bad file"))
        };
        assert!(complaint("t,a\n0,1\n").contains("line 1: the first column is `t`, but must be `time`"));
        assert!(complaint("time,a\n0,1\n1,one\n").contains("line 3, column `a`: `one` is not a finite number"));
        assert!(complaint("time,a\n0,1\n0,2\n").contains("line 3: time 0 s does not increase"));
        assert!(complaint("time,a\n0,1\n1\n").contains("line: 3"));
        assert!(complaint("time,a\n").contains("no row"));
    }
}
