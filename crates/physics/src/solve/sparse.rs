//! Symmetric matrices on a fixed pattern.

use super::linear::Tangent;
use super::reduction::{Local, Reduction};
use crate::{Tensor, parallel};

/// The lower triangle of a symmetric matrix by columns. The pattern is found once from which rows
/// are coupled; values are gathered column by column, so that they are the same to the bit for any
/// number of threads.
#[derive(Clone, Debug)]
pub struct SparseMatrix {
    /// Column `d` has the entries from `offsets[d]` to `offsets[d + 1]`.
    offsets: Vec<usize>,
    /// Row of each entry, ascending in a column, the first on the diagonal.
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl SparseMatrix {
    /// The pattern of a tangent in reduced unknowns, with zeros. `coupled[a]` are the rows that
    /// row a shares a block with, itself among them.
    pub fn new<const D: usize>(reduction: &Reduction<D>, coupled: &[Vec<u32>]) -> Self {
        let mut offsets = vec![0];
        let mut rows = Vec::new();
        for (first, last, members) in reduction.groups() {
            let all = coupled_unknowns(reduction, members, coupled);
            for column in first..last {
                let from = all.partition_point(|&row| row < column);
                rows.extend(all[from..].iter().map(|&row| row as usize));
                offsets.push(rows.len());
            }
        }
        let values = vec![0.0; rows.len()];
        Self { offsets, rows, values }
    }

    /// A pattern by columns, each with its rows in ascending order, the first on the diagonal; with
    /// zeros.
    pub(crate) fn of_columns(columns: impl Iterator<Item = Vec<usize>>) -> Self {
        let (mut offsets, mut rows) = (vec![0], Vec::new());
        for column in columns {
            rows.extend(column);
            offsets.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        Self { offsets, rows, values }
    }

    /// Takes the values of all entries in, column by column.
    pub(crate) fn set_values(&mut self, values: Vec<f64>) {
        debug_assert_eq!(values.len(), self.rows.len(), "one value an entry");
        self.values = values;
    }

    /// Raises each entry on the diagonal by a share of itself, and puts 1 where it is zero.
    pub(super) fn regularise(&mut self, share: f64) {
        for column in 0..self.len() {
            let entry = &mut self.values[self.offsets[column]];
            *entry = if *entry == 0.0 { 1.0 } else { *entry + share * entry.abs() };
        }
    }

    /// Number of rows and columns.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Entries of the lower triangle.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// First entry of each column, rows and values of all entries.
    pub fn parts(&self) -> (&[usize], &[usize], &[f64]) {
        (&self.offsets, &self.rows, &self.values)
    }

    /// The entries on the diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        self.offsets[..self.len()].iter().map(|&first| self.values[first]).collect()
    }

    /// Adds `shift` to each entry on the diagonal.
    pub fn add_to_diagonal(&mut self, shift: f64) {
        for column in 0..self.len() {
            self.values[self.offsets[column]] += shift;
        }
    }

    /// Gathers the values of a tangent.
    pub fn assemble<const D: usize, T: Tangent<D>>(
        &mut self,
        reduction: &Reduction<D>,
        tangent: &T,
    ) {
        let unknowns = self.len();
        let mut rest = self.values.as_mut_slice();
        let mut columns = Vec::new();
        for (first, last, members) in reduction.groups() {
            let (first, last) = (first as usize, last as usize);
            let length = self.offsets[last] - self.offsets[first];
            let (values, after) = rest.split_at_mut(length);
            rest = after;
            columns.push(Columns { first, last, members, values });
        }
        let (offsets, rows) = (&self.offsets, &self.rows);
        parallel::for_each_chunk(&mut columns, |_, columns| {
            let mut place = vec![0; unknowns];
            for group in columns {
                gather(group, (offsets, rows), &mut place, reduction, tangent);
            }
        });
    }

    /// `product = K vector`. On one thread.
    pub fn apply(&self, vector: &[f64], product: &mut [f64]) {
        product.fill(0.0);
        for column in 0..self.len() {
            let range = self.offsets[column]..self.offsets[column + 1];
            let entries = self.rows[range.clone()].iter().zip(&self.values[range]);
            let mut sum = 0.0;
            for (&row, &value) in entries {
                sum += value * vector[row];
                if row != column {
                    product[row] += value * vector[column];
                }
            }
            product[column] += sum;
        }
    }
}

/// Columns of one group with their values.
struct Columns<'a> {
    first: usize,
    last: usize,
    members: &'a [u32],
    values: &'a mut [f64],
}

fn gather<const D: usize, T: Tangent<D>>(
    group: &mut Columns<'_>,
    (offsets, rows): (&[usize], &[usize]),
    place: &mut [usize],
    reduction: &Reduction<D>,
    tangent: &T,
) {
    group.values.fill(0.0);
    let base = offsets[group.first];
    // Columns of a group have the same rows but for those above their diagonals.
    let all = &rows[base..offsets[group.first + 1]];
    all.iter().enumerate().for_each(|(index, &row)| place[row] = index);
    for &a in group.members {
        let a = a as usize;
        tangent.add_row(a, &mut |b: u32, block: &Tensor<D>| {
            let b = b as usize;
            let block = reduction.frame(a).tr_mul(&(block * reduction.frame(b)));
            for (i, own) in reduction.locals(a).iter().enumerate() {
                let &Local::Free(column) = own else { continue };
                let column = column as usize;
                if !(group.first..group.last).contains(&column) {
                    continue;
                }
                for (j, other) in reduction.locals(b).iter().enumerate() {
                    if let &Local::Free(row) = other
                        && row as usize >= column
                    {
                        let skipped = column - group.first;
                        let entry = offsets[column] - base + place[row as usize] - skipped;
                        group.values[entry] += block[(i, j)];
                    }
                }
            }
        });
    }
}

/// The unknowns, in ascending order, that those of a group share an entry with.
fn coupled_unknowns<const D: usize>(
    reduction: &Reduction<D>,
    members: &[u32],
    coupled: &[Vec<u32>],
) -> Vec<u32> {
    let others = members.iter().flat_map(|&a| &coupled[a as usize]);
    let mut all: Vec<u32> = others
        .flat_map(|&b| *reduction.locals(b as usize))
        .filter_map(|local| match local {
            Local::Free(number) => Some(number),
            Local::Held => None,
        })
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}
