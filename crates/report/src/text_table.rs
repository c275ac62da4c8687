//! Tables for people: aligned columns of text. `typeset` has the same tables for documents.

use std::fmt;
use std::iter::zip;

/// Text between two columns.
const GAP: &str = "  ";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// Head of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    title: String,
    unit: String,
    side: Side,
}

impl Column {
    /// A column of words.
    pub(crate) fn words(title: &str) -> Self {
        Self { title: title.to_owned(), unit: String::new(), side: Side::Left }
    }

    /// A column of numbers in a unit.
    pub(crate) fn numbers(title: &str, unit: &str) -> Self {
        Self { title: title.to_owned(), unit: unit.to_owned(), side: Side::Right }
    }

    /// Title of the column.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Unit; empty without one.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Whether the column has numbers, which are aligned to the right.
    pub fn is_number(&self) -> bool {
        self.side == Side::Right
    }
}

/// A line of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Row {
    /// One cell for each column.
    Cells(Vec<String>),
    /// The first cell, and text across all the others.
    Words(String, String),
}

/// A table for people. Its `Display` aligns the columns with spaces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextTable {
    columns: Vec<Column>,
    rows: Vec<Row>,
}

impl TextTable {
    pub(crate) fn new(columns: Vec<Column>) -> Self {
        Self { columns, rows: Vec::new() }
    }

    /// A row with one cell for each column.
    pub(crate) fn push(&mut self, cells: Vec<String>) {
        self.rows.push(Row::Cells(cells));
    }

    /// A row with text in place of numbers.
    pub(crate) fn push_words(&mut self, first: String, words: String) {
        self.rows.push(Row::Words(first, words));
    }

    /// Heads of the columns.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Rows.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Whether any column has a unit.
    pub fn has_units(&self) -> bool {
        self.columns.iter().any(|column| !column.unit.is_empty())
    }

    /// Titles, units, a rule and the rows. Each line ends with a line feed, and no line ends with a space.
    pub(crate) fn render(&self) -> String {
        let widths = self.widths();
        let line = |cells: Vec<&str>| -> String {
            let padded: Vec<String> = zip(zip(&self.columns, &widths), cells)
                .map(|((column, &width), cell)| {
                    let space = " ".repeat(width.saturating_sub(width_of(cell)));
                    if column.side == Side::Left { format!("{cell}{space}") } else { format!("{space}{cell}") }
                })
                .collect();
            format!("{}\n", padded.join(GAP).trim_end())
        };
        let mut text = line(self.columns.iter().map(|column| column.title.as_str()).collect());
        if self.has_units() {
            text += &line(self.columns.iter().map(|column| column.unit.as_str()).collect());
        }
        let total = widths.iter().sum::<usize>() + GAP.len() * widths.len().saturating_sub(1);
        text += &format!("{}\n", "─".repeat(total));
        for row in &self.rows {
            text += &match row {
                Row::Cells(cells) => line(cells.iter().map(String::as_str).collect()),
                Row::Words(first, words) => {
                    let space = " ".repeat(widths.first().map_or(0, |width| width.saturating_sub(width_of(first))));
                    format!("{first}{space}{GAP}{words}\n")
                }
            };
        }
        text
    }

    fn widths(&self) -> Vec<usize> {
        let mut widths: Vec<usize> =
            self.columns.iter().map(|column| width_of(&column.title).max(width_of(&column.unit))).collect();
        for row in &self.rows {
            match row {
                Row::Cells(cells) => {
                    for (width, cell) in zip(&mut widths, cells) {
                        *width = (*width).max(width_of(cell));
                    }
                }
                Row::Words(first, _) => {
                    if let Some(width) = widths.first_mut() {
                        *width = (*width).max(width_of(first));
                    }
                }
            }
        }
        widths
    }
}

impl fmt::Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render())
    }
}

/// Number of characters, which is the width of all letters of our output in a terminal. Wide letters in file names shift their row.
pub(crate) fn width_of(text: &str) -> usize {
    text.chars().count()
}

/// Text in lines of at most `width` characters; a longer word has a line of its own.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width_of(line) + 1 + width_of(word) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_lines_end_without_spaces() {
        let mut table = TextTable::new(vec![Column::words("file"), Column::numbers("speed", "rev/s")]);
        table.push(vec!["a.wav".to_owned(), "60.17".to_owned()]);
        table.push(vec!["long name.wav".to_owned(), "1.5 ± 0.2".to_owned()]);
        table.push_words("b.wav".to_owned(), "no rotor tone".to_owned());
        let expected = "\
file               speed
                   rev/s
────────────────────────
a.wav              60.17
long name.wav  1.5 ± 0.2
b.wav          no rotor tone
";
        assert_eq!(table.render(), expected);
    }

    #[test]
    fn words_are_wrapped_and_none_is_lost() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("unbreakable a", 3), ["unbreakable", "a"]);
        assert!(wrapped(" ", 10).is_empty());
    }
}
