//! Matrices of blocks, row by row.

use super::linear::Tangent;
use crate::parallel::{self, Team};
use crate::{Tensor, Vector};

/// A square matrix of blocks on a fixed pattern, which is the same on both sides of the diagonal;
/// the blocks need not be. Each of several ranks has all of it, and makes the rows of its own particles.
#[derive(Clone, Debug)]
pub struct BlockMatrix<const D: usize> {
    /// Row a has the blocks from `offsets[a]` to `offsets[a + 1]`.
    offsets: Vec<usize>,
    /// Column of each block, ascending in a row.
    columns: Vec<u32>,
    values: Vec<Tensor<D>>,
    team: Team,
}

impl<const D: usize> BlockMatrix<D> {
    /// A pattern with blocks of zeros: the columns of each row in ascending order, its own among
    /// them.
    pub fn new(rows: impl Iterator<Item = Vec<u32>>) -> Self {
        let (mut offsets, mut columns) = (vec![0], Vec::new());
        for row in rows {
            columns.extend(row);
            offsets.push(columns.len());
        }
        let values = vec![Tensor::zeros(); columns.len()];
        Self { offsets, columns, values, team: Team::default() }
    }

    /// Shares the work with a team.
    pub(crate) fn share(&mut self, team: Team) {
        self.team = team;
    }

    /// Number of rows of blocks.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes that it takes.
    pub fn memory(&self) -> usize {
        size_of_val(self.offsets.as_slice())
            + size_of_val(self.columns.as_slice())
            + size_of_val(self.values.as_slice())
    }

    /// Replaces all blocks: `fill(a, add)` calls `add(b, block)` for those of row a, which add up
    /// where b comes again. A block outside of the pattern is left out.
    pub fn fill(&mut self, fill: impl Fn(usize, &mut dyn FnMut(u32, &Tensor<D>)) + Sync) {
        let own = self.team.share_of(self.len());
        let (offsets, columns) = (&self.offsets[own.start..], &self.columns);
        let (begin, end) = (offsets[0], offsets[own.len()]);
        let mut rows = vec![(); own.len()];
        let start = |row: usize| offsets[row] - begin;
        let values = &mut self.values[begin..end];
        parallel::for_each_span(values, &mut rows, &start, |first, values, rows| {
            values.fill(Tensor::zeros());
            for row in first..first + rows.len() {
                let columns = &columns[offsets[row]..offsets[row + 1]];
                let values = &mut values[offsets[row] - offsets[first]..][..columns.len()];
                fill(own.start + row, &mut |b, block| {
                    if let Ok(place) = columns.binary_search(&b) {
                        values[place] += block;
                    }
                });
            }
        });
        self.team.complete(&mut self.values, |a| self.offsets[a]);
    }

    /// The block of row a and column b, zero outside of the pattern.
    fn block(&self, a: usize, b: u32) -> Tensor<D> {
        let range = self.offsets[a]..self.offsets[a + 1];
        match self.columns[range.clone()].binary_search(&b) {
            Ok(place) => self.values[range.start + place],
            Err(_) => Tensor::zeros(),
        }
    }

    fn row(&self, a: usize) -> impl Iterator<Item = (u32, &Tensor<D>)> {
        let range = self.offsets[a]..self.offsets[a + 1];
        self.columns[range.clone()].iter().copied().zip(&self.values[range])
    }
}

impl<const D: usize> Tangent<D> for BlockMatrix<D> {
    fn coupled(&self, a: usize) -> Vec<u32> {
        self.columns[self.offsets[a]..self.offsets[a + 1]].to_vec()
    }

    fn add_row(&self, a: usize, add: &mut dyn FnMut(u32, &Tensor<D>)) {
        for (b, block) in self.row(a) {
            let opposite = self.block(b as usize, a as u32).transpose();
            add(b, &((block + opposite) * 0.5));
        }
    }

    fn apply(&mut self, direction: &[Vector<D>], product: &mut [Vector<D>]) {
        let matrix = &*self;
        self.team.fill(product, |first, product| {
            for (offset, product) in product.iter_mut().enumerate() {
                let terms = matrix.row(first + offset);
                *product = terms.map(|(b, block)| block * direction[b as usize]).sum();
            }
        });
    }

    fn diagonal(&self) -> Vec<Tensor<D>> {
        (0..self.len()).map(|a| self.block(a, a as u32)).collect()
    }

    fn is_symmetric(&self) -> bool {
        false
    }
}
