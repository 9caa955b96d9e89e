//! Tables and reference curves from CSV files, with errors that name file, line and column.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use csv::{ByteRecord, Position, ReaderBuilder, Trim};

use super::{Column, Table};

/// Most columns that are read, so that a file of commas does not fill the memory.
const MAX_COLUMNS: usize = 10_000;

/// A CSV file could not be read as a table of numbers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The operating system refuses.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file is too large to be what it should be.
    #[error(
        "{} is larger than {limit} bytes, the limit for a table. Use a shorter one",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Most bytes that are read.
        limit: u64,
    },
    /// No table of piola's or of a paper is as wide.
    #[error(
        "{}, line {line}: {got} columns, more than the {MAX_COLUMNS} that a table may have",
        path.display()
    )]
    TooWide {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Columns found.
        got: usize,
    },
    /// A cell does not hold a number.
    #[error(
        "{}, line {line}, column {column}: expected a number, got {got:?}{}",
        path.display(),
        separator_hint(got)
    )]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column of the table, from 1.
        column: usize,
        /// Start of the text found.
        got: String,
    },
    /// A row is longer or shorter than those before.
    #[error(
        "{}, line {line}: {got} columns where the lines before have {expected}. Every line needs \
         the same number of columns, separated by commas",
        path.display()
    )]
    Ragged {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Columns of the lines before.
        expected: usize,
        /// Columns found.
        got: usize,
    },
    /// There is not one row of numbers.
    #[error("{} holds no row of numbers", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A curve needs an abscissa and at least one ordinate.
    #[error(
        "{} has one column where a curve needs two: the abscissa and the value, separated by a \
         comma",
        path.display()
    )]
    NoOrdinate {
        /// The file.
        path: PathBuf,
    },
    /// A curve's abscissa must grow, and its numbers must be finite.
    #[error(
        "{}, line {line}, column {column}: {got} is not {expected}. A curve has finite numbers, \
         and its first column grows from line to line",
        path.display()
    )]
    NotACurve {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column of the table, from 1.
        column: usize,
        /// Number found.
        got: f64,
        /// What it should be: `finite` or `larger than X`.
        expected: String,
    },
}

/// A curve given by points, for example a reference to compare with.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// First column: finite and growing.
    pub abscissa: Vec<f64>,
    /// Second column: finite.
    pub ordinate: Vec<f64>,
}

impl Curve {
    /// Reads the first two columns of a CSV file, as [`Table::read_csv`] reads it.
    ///
    /// # Errors
    /// Those of [`Table::read_csv`]; besides, a file with one column or without rows, and numbers
    /// that are not finite or an abscissa that does not grow.
    pub fn read_csv(path: &Path) -> Result<Self, TableError> {
        let NumberedTable { table, lines } = read(path, Table::MAX_CSV_BYTES)?;
        if table.is_empty() {
            return Err(TableError::Empty { path: path.into() });
        }
        if table.columns().len() < 2 {
            return Err(TableError::NoOrdinate { path: path.into() });
        }
        let mut curve = Self { abscissa: Vec::new(), ordinate: Vec::new() };
        for (row, &line) in table.rows().zip(&lines) {
            let fail = |column: usize, expected: String| {
                let (path, got) = (path.into(), row[column - 1]);
                Err(TableError::NotACurve { path, line, column, got, expected })
            };
            if let Some(bad) = row[..2].iter().position(|value| !value.is_finite()) {
                return fail(bad + 1, "finite".into());
            }
            match curve.abscissa.last() {
                Some(&last) if row[0] <= last => return fail(1, format!("larger than {last:?}")),
                _ => {}
            }
            curve.abscissa.push(row[0]);
            curve.ordinate.push(row[1]);
        }
        Ok(curve)
    }
}

/// A table with the line of each row in its file.
pub(super) struct NumberedTable {
    pub table: Table,
    pub lines: Vec<u64>,
}

/// Reads a table from a CSV file of at most `limit` bytes.
pub(super) fn read(path: &Path, limit: u64) -> Result<NumberedTable, TableError> {
    let fail = |source| TableError::Io { path: path.into(), source };
    let mut bytes = Vec::new();
    // One byte above the limit tells a file of just that size from a larger one.
    File::open(path).map_err(fail)?.take(limit + 1).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > limit {
        return Err(TableError::TooLarge { path: path.into(), limit });
    }
    parse(path, &bytes)
}

fn parse(path: &Path, bytes: &[u8]) -> Result<NumberedTable, TableError> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(bytes);
    let mut table = NumberedTable { table: Table::default(), lines: Vec::new() };
    let mut record = ByteRecord::new();
    let mut row = Vec::new();
    let mut first = true;
    loop {
        match reader.read_byte_record(&mut record) {
            Ok(true) => {}
            Ok(false) => return Ok(table),
            Err(error) => {
                return Err(TableError::Io { path: path.into(), source: error.into() });
            }
        }
        if record.len() == 1 && record[0].is_empty() {
            continue; // a line of blanks
        }
        let line = record.position().map_or(0, |position| line_of_record(bytes, position));
        if record.len() > MAX_COLUMNS {
            return Err(TableError::TooWide { path: path.into(), line, got: record.len() });
        }
        if std::mem::take(&mut first) {
            let header = record.iter().all(|cell| number(cell).is_none());
            let columns = (1..).zip(&record).map(|(place, cell)| match header {
                true => column_of_header(&String::from_utf8_lossy(cell)),
                false => Column::new(place.to_string(), ""),
            });
            table.table = Table::new(columns.collect());
            if header {
                continue;
            }
        }
        row.clear();
        for (cell, column) in record.iter().zip(1..) {
            row.push(number(cell).ok_or_else(|| {
                let got = String::from_utf8_lossy(cell).chars().take(40).collect();
                TableError::NotANumber { path: path.into(), line, column, got }
            })?);
        }
        table.table.push_row(&row).map_err(|expected| TableError::Ragged {
            path: path.into(),
            line,
            expected,
            got: row.len(),
        })?;
        table.lines.push(line);
    }
}

/// The line on which the record at `position` starts. The reader counts from where the record
/// before ended, which is ahead of skipped lines.
fn line_of_record(bytes: &[u8], position: &Position) -> u64 {
    let mut line = position.line();
    let mut comment = false;
    for byte in &bytes[(position.byte() as usize).min(bytes.len())..] {
        match byte {
            b'\n' => (line, comment) = (line + 1, false),
            b'\r' => {}
            b'#' => comment = true,
            _ if comment => {}
            _ => break,
        }
    }
    line
}

fn number(cell: &[u8]) -> Option<f64> {
    str::from_utf8(cell).ok()?.parse().ok()
}

/// The column that `name [unit]` stands for.
fn column_of_header(text: &str) -> Column {
    let split = text.strip_suffix(']').and_then(|text| text.rsplit_once('['));
    match split {
        Some((name, unit)) => Column::new(name.trim_end(), unit),
        None => Column::new(text, ""),
    }
}

/// What to do about the commonest fault: columns separated otherwise.
fn separator_hint(got: &str) -> &'static str {
    if got.contains([';', '\t', ' ']) {
        "; separate columns by commas, and use a point in decimals"
    } else {
        ""
    }
}
