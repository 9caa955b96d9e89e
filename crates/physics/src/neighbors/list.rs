//! Flat neighbour lists.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::parallel::{CHUNK, for_each_long_span};

/// Entries that a chunk of rows makes before it compares the sum of all chunks with the limit.
const REPORT: usize = 1 << 16;
/// An array that is too short becomes longer than needed by one part in this many.
const SPARE: usize = 8;

/// For each particle the numbers of its neighbours, all rows in one array.
///
/// Rows are in ascending order and never hold the particle itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NeighborList {
    /// Row `a` is `indices[offsets[a]..offsets[a + 1]]`.
    offsets: Vec<usize>,
    indices: Vec<u32>,
}

/// How many neighbours particles have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighborStatistics {
    /// Fewest neighbours of a particle.
    pub least: usize,
    /// Mean over all particles.
    pub mean: f64,
    /// Most neighbours of a particle.
    pub most: usize,
}

impl Default for NeighborList {
    fn default() -> Self {
        Self { offsets: vec![0], indices: Vec::new() }
    }
}

impl NeighborList {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Neighbours of particle `a`, in ascending order.
    #[inline]
    pub fn row(&self, a: usize) -> &[u32] {
        &self.indices[self.range(a)]
    }

    /// Where the row of particle `a` is in [`Self::indices`], and in any array over entries.
    #[inline]
    pub fn range(&self, a: usize) -> Range<usize> {
        self.offsets[a]..self.offsets[a + 1]
    }

    /// Number of entries of all rows; a symmetric list holds each pair twice.
    pub fn pairs(&self) -> usize {
        self.indices.len()
    }

    /// First entry of each row, and after the last one the number of entries: `len + 1` numbers.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// All rows one after the other.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Least, mean and most neighbours; all zero without particles.
    pub fn statistics(&self) -> NeighborStatistics {
        let lengths = || self.offsets.windows(2).map(|ends| ends[1] - ends[0]);
        NeighborStatistics {
            least: lengths().min().unwrap_or(0),
            mean: self.pairs() as f64 / self.len().max(1) as f64,
            most: lengths().max().unwrap_or(0),
        }
    }

    /// The neighbours of some particles that are not among them, in ascending order.
    pub fn beside(&self, own: &Range<usize>) -> Vec<usize> {
        let all = self.indices[self.offsets[own.start]..self.offsets[own.end]].iter();
        let mut others: Vec<usize> =
            all.map(|&b| b as usize).filter(|b| !own.contains(b)).collect();
        others.sort_unstable();
        others.dedup();
        others
    }

    /// A list from its arrays, which the caller has made by the rules above.
    pub(crate) fn from_arrays(offsets: Vec<usize>, indices: Vec<u32>) -> Self {
        debug_assert_eq!(offsets.last(), Some(&indices.len()));
        Self { offsets, indices }
    }

    /// A list of `count` rows, each appended to the vector by `append(state, row, vector)` in
    /// ascending order. Every chunk of rows has a state of its own.
    ///
    /// `None` where there are more than `limit` entries in all; memory stays within reach of it.
    pub(super) fn from_rows<S: Default + Send>(
        count: usize,
        limit: usize,
        append: impl Fn(&mut S, usize, &mut Vec<u32>) + Sync,
    ) -> Option<Self> {
        let (mut rows, mut list) = (Rows::default(), Self::default());
        rows.make([count, limit], append).then(|| {
            rows.join(&mut list);
            list
        })
    }

    /// Adds empty rows behind the others, or takes rows off, until there are so many.
    pub(super) fn resize(&mut self, count: usize) {
        self.offsets.resize(count + 1, self.indices.len());
    }

    /// All rows one after the other, to write others in.
    pub(super) fn indices_mut(&mut self) -> &mut [u32] {
        &mut self.indices
    }
}

/// Rows in chunks, each of which has a state of its own, and the arrays of which serve for the next rows.
#[derive(Default)]
pub(super) struct Rows<S> {
    offsets: Vec<usize>,
    chunks: Vec<Chunk<S>>,
}

#[derive(Default)]
struct Chunk<S> {
    state: S,
    rows: Vec<u32>,
}

impl<S: Default + Send> Rows<S> {
    /// Makes the rows of a list, as [`NeighborList::from_rows`]; whether there are no more entries than the limit.
    pub fn make(
        &mut self,
        [count, limit]: [usize; 2],
        append: impl Fn(&mut S, usize, &mut Vec<u32>) + Sync,
    ) -> bool {
        let (made, is_full) = (AtomicUsize::new(0), AtomicBool::new(false));
        let Self { offsets, chunks } = self;
        match offsets.capacity() > count {
            true => {
                offsets.clear();
                offsets.resize(count + 1, 0);
            }
            false => *offsets = vec![0; count + 1],
        }
        chunks.resize_with(count.div_ceil(CHUNK), Chunk::default);
        let each = offsets[1..].par_chunks_mut(CHUNK).zip(chunks.par_iter_mut()).enumerate();
        each.for_each(|(chunk, (ends, Chunk { state, rows }))| {
            rows.clear();
            let (mut before, last) = (0, ends.len() - 1);
            for (row, end) in ends.iter_mut().enumerate() {
                if is_full.load(Ordering::Relaxed) {
                    return;
                }
                append(state, chunk * CHUNK + row, rows);
                *end = rows.len();
                // Whether the sum over all threads passes the limit does not depend on the
                // order in which they report.
                if row == last || rows.len() - before > REPORT {
                    let more = rows.len() - before;
                    before = rows.len();
                    if made.fetch_add(more, Ordering::Relaxed) + more > limit {
                        is_full.store(true, Ordering::Relaxed);
                    }
                }
            }
        });
        !is_full.into_inner()
    }

    /// Puts the rows that were made last together.
    pub fn join(&mut self, list: &mut NeighborList) {
        std::mem::swap(&mut self.offsets, &mut list.offsets);
        let (chunks, NeighborList { offsets, indices }) = (&mut self.chunks, list);
        let (count, mut first) = (offsets.len() - 1, 0);
        for (ends, Chunk { rows, .. }) in offsets[1..].chunks_mut(CHUNK).zip(&*chunks) {
            ends.iter_mut().for_each(|end| *end += first);
            first += rows.len();
        }
        if indices.capacity() < first {
            // The second time with some more than is needed, as lists that follow are about as long.
            let spare = if indices.capacity() > 0 { first / SPARE } else { 0 };
            indices.clear();
            indices.reserve_exact(first + spare);
        }
        indices.resize(first, 0);
        let start = |chunk: usize| offsets[(chunk * CHUNK).min(count)];
        for_each_long_span(indices, chunks, &start, |indices, Chunk { rows, .. }| {
            indices.copy_from_slice(rows);
        });
    }

    /// The states of all chunks.
    pub fn states(&mut self) -> impl Iterator<Item = &mut S> {
        self.chunks.iter_mut().map(|chunk| &mut chunk.state)
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        let rows = |chunk: &Chunk<S>| size_of_val(chunk.rows.as_slice());
        size_of_val(self.offsets.as_slice()) + self.chunks.iter().map(rows).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_on_the_entries_of_all_rows() {
        let rows = |limit| {
            let append = |(): &mut (), a, rows: &mut Vec<u32>| rows.extend([1, 2, a as u32]);
            NeighborList::from_rows(3000, limit, append)
        };
        assert_eq!(rows(9000).map(|list| list.pairs()), Some(9000));
        assert_eq!(rows(8999), None);
        // A few rows without end: stopped long before all are made.
        let long = |(): &mut (), _, rows: &mut Vec<u32>| rows.extend(0..1 << 20);
        assert_eq!(NeighborList::from_rows(1 << 30, 1 << 21, long), None);
    }
}
