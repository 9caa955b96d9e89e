//! Tables of numbers with a name and a unit for each column, written as CSV.

use std::io;
use std::path::Path;

use super::csv_reader::{self, TableError};
use super::{OutputError, atomic};

/// Name and unit of one column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, for example `top.displacement.y`.
    pub name: String,
    /// SI unit, `1` for a pure number; empty if unknown.
    pub unit: String,
}

impl Column {
    /// A column called `name` in `unit`.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }

    /// The column as it stands in a header: `name [unit]`.
    pub fn header(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }
}

/// A table of numbers, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
    rows: Vec<f64>,
}

impl Table {
    /// A table without rows.
    pub fn new(columns: Vec<Column>) -> Self {
        Self { columns, rows: Vec::new() }
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len().checked_div(self.columns.len()).unwrap_or(0)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Appends a row.
    ///
    /// # Errors
    /// `row` has not one number for each column: the number of columns is returned, and the table
    /// is as before.
    pub fn push_row(&mut self, row: &[f64]) -> Result<(), usize> {
        if row.len() != self.columns.len() {
            return Err(self.columns.len());
        }
        self.rows.extend_from_slice(row);
        Ok(())
    }

    /// All numbers, row by row.
    pub fn numbers(&self) -> &[f64] {
        &self.rows
    }

    /// Replaces all rows by those of `numbers`, row by row.
    ///
    /// # Errors
    /// They are not whole rows: the number of columns is returned, and the table is as before.
    pub fn set_numbers(&mut self, numbers: Vec<f64>) -> Result<(), usize> {
        match numbers.len().checked_rem(self.columns.len()) {
            Some(0) => {
                self.rows = numbers;
                Ok(())
            }
            _ => Err(self.columns.len()),
        }
    }

    /// Removes the rows whose first number is larger than `last`.
    pub fn truncate_after(&mut self, last: f64) {
        let kept = self.rows().filter(|row| row.first().is_some_and(|first| *first <= last));
        self.rows = kept.flatten().copied().collect();
    }

    /// The rows, in order.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[f64]> + ExactSizeIterator {
        // A table without columns has no rows; chunks of one keep the iterator defined.
        self.rows.chunks_exact(self.columns.len().max(1))
    }

    /// Number of the column called `name`.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The numbers of column `index`, from the first row to the last; nothing if there is no such
    /// column.
    pub fn column(&self, index: usize) -> impl DoubleEndedIterator<Item = f64> + '_ {
        self.rows().filter_map(move |row| row.get(index).copied())
    }

    /// The numbers of the column called `name`.
    pub fn values(&self, name: &str) -> Option<Vec<f64>> {
        Some(self.column(self.index(name)?).collect())
    }

    /// Writes the table as CSV to the file `path`, whole at each call, and returns its length in
    /// bytes. The header is `time [s],top.displacement.y [m]`; numbers are the shortest that read
    /// back to the same bits.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<u64, OutputError> {
        atomic::write_file(path, |out| self.write_to(out))
    }

    /// Writes the table as CSV to `out`.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_to(&self, out: impl io::Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(out);
        if !self.columns.is_empty() {
            writer.write_record(self.columns.iter().map(Column::header))?;
        }
        for row in self.rows() {
            writer.write_record(row.iter().map(|value| format!("{value:?}")))?;
        }
        writer.flush()
    }

    /// Reads a table from the CSV file `path`: numbers separated by commas, the first line
    /// optionally a header of names, each optionally with a unit in brackets. Empty lines and
    /// lines that start with `#` are skipped. Without a header columns are called `1`, `2`, ...
    ///
    /// # Errors
    /// The file cannot be read, is larger than [`MAX_CSV_BYTES`](Self::MAX_CSV_BYTES), or holds
    /// something other than numbers in rows of equal length.
    pub fn read_csv(path: &Path) -> Result<Self, TableError> {
        Ok(csv_reader::read(path, Self::MAX_CSV_BYTES)?.table)
    }

    /// Largest file that [`read_csv`](Self::read_csv) reads: 64 MiB.
    pub const MAX_CSV_BYTES: u64 = 64 << 20;
}
