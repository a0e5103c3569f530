//! CSV files with columns of their own, read with the place of each mistake.

use thiserror::Error;

use crate::record::number::{parse, parse_mm};

/// Names of a table's columns, in their order.
pub type Columns = &'static [&'static str];

/// What is wrong with a table, and where. Lines and columns count from 1, columns in fields.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TableError {
    /// Another first line.
    #[error("line 1: `{found}`: expected the columns {}", names.join(","))]
    Header {
        /// What stands there, cut to a readable length.
        found: String,
        /// The table's columns.
        names: Columns,
    },
    /// Too few fields, or too many.
    #[error("line {line}: {found} columns: expected {}, {}", names.len(), names.join(","))]
    Columns {
        /// Which line.
        line: usize,
        /// How many fields it has.
        found: usize,
        /// The table's columns.
        names: Columns,
    },
    /// A field that is not as its column wants it.
    #[error("line {line}, column {column} ({}): `{found}`: expected {expected}", names[column - 1])]
    Field {
        /// Which line.
        line: usize,
        /// Which field.
        column: usize,
        /// What stands there, cut to a readable length.
        found: String,
        /// What could stand there.
        expected: &'static str,
        /// The table's columns.
        names: Columns,
    },
}

/// A row with its fields.
#[derive(Debug, Clone)]
pub(super) struct Row<'a> {
    line: usize,
    fields: Vec<&'a str>,
    names: Columns,
}

/// The rows of a table. Empty lines and lines that begin with `#` are skipped.
pub(super) fn rows(text: &str, names: Columns) -> Result<Vec<Row<'_>>, TableError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let header = lines.next().map_or("", |(_, line)| line);
    if !header.split(',').map(str::trim).eq(names.iter().copied()) {
        return Err(TableError::Header { found: cut(header), names });
    }
    let holds = |(_, content): &(usize, &str)| !content.is_empty() && !content.starts_with('#');
    lines.filter(holds).map(|(line, content)| Row::new(line, content, names)).collect()
}

impl<'a> Row<'a> {
    fn new(line: usize, content: &'a str, names: Columns) -> Result<Self, TableError> {
        let fields: Vec<&str> = content.split(',').map(str::trim).collect();
        if fields.len() != names.len() {
            return Err(TableError::Columns { line, found: fields.len(), names });
        }
        Ok(Self { line, fields, names })
    }

    /// That a field, counted from 0, is not as expected.
    pub(super) fn error(&self, index: usize, expected: &'static str) -> TableError {
        let (line, names) = (self.line, self.names);
        TableError::Field { line, column: index + 1, found: cut(self.fields[index]), expected, names }
    }

    /// A number; NaN for an empty field.
    pub(super) fn number(&self, index: usize, expected: &'static str) -> Result<f64, TableError> {
        parse(self.fields[index]).ok_or_else(|| self.error(index, expected))
    }

    /// A length in metres; NaN for an empty field.
    pub(super) fn length(&self, index: usize, expected: &'static str) -> Result<f64, TableError> {
        parse_mm(self.fields[index]).ok_or_else(|| self.error(index, expected))
    }

    /// A whole number.
    pub(super) fn whole(&self, index: usize) -> Result<i64, TableError> {
        self.fields[index].parse().map_err(|_| self.error(index, "a whole number"))
    }
}

fn cut(text: &str) -> String {
    text.chars().take(60).collect()
}
