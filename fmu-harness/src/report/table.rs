//! Text in columns for the terminal.

/// Lines of cells: the first column flush left, the others flush right.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table(Vec<Vec<String>>);

impl Table {
    /// Adds a line.
    pub fn row<const N: usize>(&mut self, cells: [impl Into<String>; N]) {
        self.0.push(cells.map(Into::into).into());
    }

    /// Adds a line of as many cells as there are.
    pub fn line(&mut self, cells: Vec<String>) {
        self.0.push(cells);
    }

    /// Its lines, cell by cell.
    pub fn lines(&self) -> &[Vec<String>] {
        &self.0
    }

    /// The lines, aligned.
    pub fn print(&self) -> String {
        let columns = self.0.iter().map(Vec::len).max().unwrap_or_default();
        let width = |column: usize| self.0.iter().filter_map(|row| Some(row.get(column)?.chars().count())).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or_default()).collect();
        let mut text = String::new();
        for row in &self.0 {
            let mut line = String::from(" ");
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let padding = " ".repeat(width - cell.chars().count());
                line += &if column == 0 { format!(" {cell}{padding}") } else { format!("   {padding}{cell}") };
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }

    /// The same for a Markdown page; the first line is the head.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let Some((head, rows)) = self.0.split_first() else { return String::new() };
        let alignment = format!("|---|{}\n", "--:|".repeat(head.len().saturating_sub(1)));
        line(head) + &alignment + &rows.iter().map(|row| line(row)).collect::<String>()
    }
}
