//! Flat neighbour lists.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::parallel::{CHUNK, for_each_long_span};

/// Entries that a chunk of rows makes before it compares the sum of all chunks with the limit.
const REPORT: usize = 1 << 16;
/// One part in this many of an array may be longer than needed.
const SPARE: usize = 4;

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
        let mut rows = Rows::default();
        rows.make([count, limit], append).then(|| rows.join())
    }
}

/// Rows in chunks, the arrays of which serve for the next rows, too.
#[derive(Default)]
pub(super) struct Rows<S> {
    /// Where each row begins among the entries of all, and their number.
    offsets: Vec<usize>,
    /// Those of [`CHUNK`] rows each, and perhaps some that have none now.
    chunks: Vec<Chunk<S>>,
}

/// Some rows, with what making them takes.
#[derive(Default)]
struct Chunk<S> {
    state: S,
    rows: Vec<u32>,
}

impl<S: Default + Send> Rows<S> {
    /// So many rows without entries.
    pub fn clear(&mut self, count: usize) {
        self.chunks.iter_mut().for_each(|chunk| chunk.rows.clear());
        self.offsets.clear();
        self.offsets.resize(count + 1, 0);
    }

    /// Makes `count` rows, as [`NeighborList::from_rows`]. There are none left where there would be too many entries.
    pub fn make(
        &mut self,
        [count, limit]: [usize; 2],
        append: impl Fn(&mut S, usize, &mut Vec<u32>) + Sync,
    ) -> bool {
        let (made, is_full) = (AtomicUsize::new(0), AtomicBool::new(false));
        self.clear(count);
        let Self { offsets, chunks } = self;
        let number = count.div_ceil(CHUNK);
        chunks.resize_with(number.max(chunks.len()), Chunk::default);
        let chunks = &mut chunks[..number];
        let each = offsets[1..].par_chunks_mut(CHUNK).zip(chunks.par_iter_mut()).enumerate();
        each.for_each(|(chunk, (ends, Chunk { state, rows }))| {
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
            // With a little more than is needed now, as rows that follow are about as long.
            if rows.capacity() > rows.len() + rows.len() / SPARE {
                rows.shrink_to(rows.len() + rows.len() / (2 * SPARE));
            }
        });
        if is_full.into_inner() {
            self.clear(0);
            return false;
        }
        let mut first = 0;
        for (ends, Chunk { rows, .. }) in offsets[1..].chunks_mut(CHUNK).zip(chunks) {
            ends.iter_mut().for_each(|end| *end += first);
            first += rows.len();
        }
        true
    }

    /// Adds rows without entries behind the others until there are so many.
    pub fn extend(&mut self, count: usize) {
        self.offsets.resize(count + 1, self.entries());
    }

    /// The rows as a list.
    fn join(self) -> NeighborList {
        let Self { offsets, mut chunks } = self;
        let (count, length) = (offsets.len() - 1, offsets[offsets.len() - 1]);
        let mut indices = vec![0; length];
        let start = |chunk: usize| offsets[(chunk * CHUNK).min(count)];
        for_each_long_span(&mut indices, &mut chunks, &start, |indices, chunk| {
            indices.copy_from_slice(&chunk.rows);
        });
        NeighborList { offsets, indices }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.offsets.len() < 2
    }

    /// Number of entries of all rows.
    pub fn entries(&self) -> usize {
        self.offsets.last().copied().unwrap_or_default()
    }

    /// Number of entries of the rows before `row`.
    #[inline]
    pub fn offset(&self, row: usize) -> usize {
        self.offsets[row]
    }

    /// The entries of a row.
    #[inline]
    pub fn row(&self, row: usize) -> &[u32] {
        let (begin, end) = (self.offsets[row], self.offsets[row + 1]);
        if begin == end {
            return &[];
        }
        let first = self.offsets[row / CHUNK * CHUNK];
        &self.chunks[row / CHUNK].rows[begin - first..end - first]
    }

    /// All entries, to write others in.
    pub fn each_mut(&mut self) -> impl Iterator<Item = &mut u32> {
        self.chunks.iter_mut().flat_map(|chunk| &mut chunk.rows)
    }

    /// The states of all chunks.
    pub fn states(&mut self) -> impl Iterator<Item = &mut S> {
        self.chunks.iter_mut().map(|chunk| &mut chunk.state)
    }

    /// Bytes of all rows.
    pub fn memory(&self) -> usize {
        let entries: usize = self.chunks.iter().map(|chunk| chunk.rows.capacity()).sum();
        self.offsets.capacity() * size_of::<usize>() + entries * size_of::<u32>()
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
