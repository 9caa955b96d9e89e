//! Sparse matrices by rows: what a field is multiplied with.

use std::fmt;
use std::io::{self, Write};

use crate::parallel;

/// Matrices of up to this many rows and columns are printed entry by entry.
const PRINTED: usize = 12;

/// A sparse matrix by rows, to hold, print, apply and export. Its products gather, so that they are
/// the same to the bit for any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseOperator {
    /// Row `a` has the entries from `offsets[a]` to `offsets[a + 1]`.
    offsets: Vec<usize>,
    /// Column of each entry, ascending in a row.
    columns: Vec<u32>,
    values: Vec<f64>,
    /// Number of columns.
    width: usize,
}

impl SparseOperator {
    /// A matrix of `width` columns from its rows, each of columns with their values. Entries of one
    /// column are added up; columns beyond the width are left out.
    pub fn from_rows(
        rows: impl IntoIterator<Item = impl IntoIterator<Item = (u32, f64)>>,
        width: usize,
    ) -> Self {
        let mut matrix = Self { offsets: vec![0], columns: Vec::new(), values: Vec::new(), width };
        for row in rows {
            let mut row: Vec<(u32, f64)> =
                row.into_iter().filter(|(column, _)| (*column as usize) < width).collect();
            row.sort_by_key(|(column, _)| *column);
            let first = matrix.columns.len();
            for (column, value) in row {
                let is_known =
                    matrix.columns.len() > first && matrix.columns.last() == Some(&column);
                match (is_known, matrix.values.last_mut()) {
                    (true, Some(sum)) => *sum += value,
                    _ => {
                        matrix.columns.push(column);
                        matrix.values.push(value);
                    }
                }
            }
            matrix.offsets.push(matrix.columns.len());
        }
        matrix
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.width
    }

    /// Number of entries that are stored.
    pub fn entries(&self) -> usize {
        self.columns.len()
    }

    /// Columns and values of a row, in ascending order of the columns.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = self.offsets[row]..self.offsets[row + 1];
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }

    /// The entry at a row and a column, zero where none is stored.
    pub fn entry(&self, row: usize, column: u32) -> f64 {
        let range = self.offsets[row]..self.offsets[row + 1];
        let found = self.columns[range.clone()].binary_search(&column);
        found.map_or(0.0, |place| self.values[range.start + place])
    }

    /// The product with a field, Elastodynamics (2.32); columns beyond its end count as zero.
    pub fn apply(&self, field: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.rows()];
        parallel::for_each_chunk(&mut product, |first, products| {
            for (offset, product) in products.iter_mut().enumerate() {
                let terms = self.row(first + offset);
                *product = terms
                    .map(|(column, value)| value * field.get(column as usize).unwrap_or(&0.0))
                    .sum();
            }
        });
        product
    }

    /// The matrix with rows and columns exchanged.
    #[must_use]
    pub fn transposed(&self) -> Self {
        let mut offsets = vec![0; self.width + 1];
        self.columns.iter().for_each(|&column| offsets[column as usize + 1] += 1);
        for column in 0..self.width {
            offsets[column + 1] += offsets[column];
        }
        let mut next = offsets.clone();
        let (mut columns, mut values) = (vec![0; self.entries()], vec![0.0; self.entries()]);
        for row in 0..self.rows() {
            for (column, value) in self.row(row) {
                let place = &mut next[column as usize];
                (columns[*place], values[*place]) = (row as u32, value);
                *place += 1;
            }
        }
        Self { offsets, columns, values, width: self.rows() }
    }

    /// Bytes of offsets, columns and values.
    pub fn memory(&self) -> usize {
        size_of_val(self.offsets.as_slice())
            + size_of_val(self.columns.as_slice())
            + size_of_val(self.values.as_slice())
    }

    /// Writes the matrix in the coordinate format of Matrix Market, which counts from one, with all
    /// digits.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_matrix_market(&self, mut writer: impl Write) -> io::Result<()> {
        writeln!(writer, "%%MatrixMarket matrix coordinate real general")?;
        writeln!(writer, "{} {} {}", self.rows(), self.width, self.entries())?;
        for row in 0..self.rows() {
            for (column, value) in self.row(row) {
                writeln!(writer, "{} {} {value:e}", row + 1, column + 1)?;
            }
        }
        Ok(())
    }
}

/// A small matrix entry by entry, of a larger one its size.
impl fmt::Display for SparseOperator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.rows().max(self.width) > PRINTED {
            return write!(
                f,
                "{} x {} matrix with {} entries",
                self.rows(),
                self.width,
                self.entries()
            );
        }
        for row in 0..self.rows() {
            for column in 0..self.width as u32 {
                write!(f, "{:>12.4e}", self.entry(row, column))?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
