//! Tables for people. `table_lines` shows them in a terminal, `typeset` in documents.

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
    pub fn words(title: &str) -> Self {
        Self { title: title.to_owned(), unit: String::new(), side: Side::Left }
    }

    /// A column of numbers in a unit.
    pub fn numbers(title: &str, unit: &str) -> Self {
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

/// A table for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextTable {
    columns: Vec<Column>,
    rows: Vec<Row>,
}

impl TextTable {
    /// A table without rows.
    pub fn new(columns: Vec<Column>) -> Self {
        Self { columns, rows: Vec::new() }
    }

    /// A row with one cell for each column.
    pub fn push(&mut self, cells: Vec<String>) {
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
}
