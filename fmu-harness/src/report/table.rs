//! Tables for the terminal and for Markdown.

use anyhow::{Result, ensure};

/// Rows of cells: the first column is left-aligned, the others are right-aligned. Below the table is a sentence for
/// each row whose numbers are missing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    lines: Vec<Vec<String>>,
    gaps: Vec<String>,
}

impl Table {
    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [impl Into<String>; N]) {
        self.lines.push(cells.map(Into::into).into());
    }

    /// Adds a row with any number of cells.
    pub fn line(&mut self, cells: Vec<String>) {
        self.lines.push(cells);
    }

    /// Adds a row whose numbers are missing. The reason is given below the table.
    pub fn gap(&mut self, cells: Vec<String>, why: &str) {
        let name = cells.first().cloned().unwrap_or_default();
        self.gaps.push(format!("{name} has no numbers: {why}"));
        self.line(cells);
    }

    /// Returns an error if rows of these tables have no numbers.
    ///
    /// # Errors
    /// With the number of such rows.
    pub fn complete<'a>(tables: impl IntoIterator<Item = &'a Self>) -> Result<()> {
        let gaps: usize = tables.into_iter().map(|table| table.gaps.len()).sum();
        ensure!(gaps == 0, "{gaps} of the rows above {} no numbers", if gaps == 1 { "has" } else { "have" });
        Ok(())
    }

    /// The cells of all rows.
    pub fn lines(&self) -> &[Vec<String>] {
        &self.lines
    }

    /// The rows as aligned text.
    pub fn print(&self) -> String {
        let columns = self.lines.iter().map(Vec::len).max().unwrap_or_default();
        let width = |column: usize| self.lines.iter().filter_map(|row| Some(row.get(column)?.chars().count())).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or_default()).collect();
        let mut text = String::new();
        for row in &self.lines {
            let mut line = String::from(" ");
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let padding = " ".repeat(width - cell.chars().count());
                line += &if column == 0 { format!(" {cell}{padding}") } else { format!("   {padding}{cell}") };
            }
            text += line.trim_end();
            text.push('\n');
        }
        text + &self.told_gaps()
    }

    /// The table in Markdown. The first row is the head.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let Some((head, rows)) = self.lines.split_first() else { return String::new() };
        let alignment = format!("|---|{}\n", "--:|".repeat(head.len().saturating_sub(1)));
        line(head) + &alignment + &rows.iter().map(|row| line(row)).collect::<String>() + &self.told_gaps()
    }

    /// The sentences below the table.
    fn told_gaps(&self) -> String {
        self.gaps.iter().map(|gap| format!("\n{gap}.\n")).collect()
    }
}
