//! Flat neighbour lists.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::parallel::CHUNK;

/// Entries that a chunk of rows makes before it compares the sum of all chunks with the limit.
const REPORT: usize = 1 << 16;

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

    /// The offsets and the indices.
    pub(super) fn into_arrays(self) -> (Vec<usize>, Vec<u32>) {
        (self.offsets, self.indices)
    }

    /// A list of `count` rows, each appended to the vector by `append(state, row, vector)` in
    /// ascending order. Every chunk of rows starts with a state of its own from `start`.
    ///
    /// `None` where there are more than `limit` entries in all; memory stays within reach of it.
    pub(super) fn from_rows<S>(
        count: usize,
        limit: usize,
        start: impl Fn() -> S + Sync,
        append: impl Fn(&mut S, usize, &mut Vec<u32>) + Sync,
    ) -> Option<Self> {
        let made = AtomicUsize::new(0);
        let mut offsets = vec![0; count + 1];
        let chunks: Option<Vec<Vec<u32>>> = offsets[1..]
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, ends)| {
                let mut state = start();
                let (mut rows, mut before) = (Vec::new(), 0);
                let last = ends.len() - 1;
                for (row, end) in ends.iter_mut().enumerate() {
                    append(&mut state, chunk * CHUNK + row, &mut rows);
                    *end = rows.len();
                    // Whether the sum over all threads passes the limit does not depend on the
                    // order in which they report.
                    if row == last || rows.len() - before > REPORT {
                        let more = rows.len() - before;
                        before = rows.len();
                        if made.fetch_add(more, Ordering::Relaxed) + more > limit {
                            return None;
                        }
                    }
                }
                Some(rows)
            })
            .collect();
        let chunks = chunks?;
        let mut first = 0;
        for (ends, rows) in offsets[1..].chunks_mut(CHUNK).zip(&chunks) {
            ends.iter_mut().for_each(|end| *end += first);
            first += rows.len();
        }
        Some(Self::from_arrays(offsets, concatenate(chunks, first)))
    }
}

/// Joins chunks of `length` numbers in all, on all threads.
fn concatenate(chunks: Vec<Vec<u32>>, length: usize) -> Vec<u32> {
    let mut joined = vec![0; length];
    let mut rest = joined.as_mut_slice();
    let mut parts = Vec::with_capacity(chunks.len());
    for chunk in chunks {
        let (part, after) = rest.split_at_mut(chunk.len());
        parts.push((part, chunk));
        rest = after;
    }
    parts.into_par_iter().for_each(|(part, chunk)| part.copy_from_slice(&chunk));
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_on_the_entries_of_all_rows() {
        let rows = |limit| {
            NeighborList::from_rows(3000, limit, || (), |(), a, rows| rows.extend([1, 2, a as u32]))
        };
        assert_eq!(rows(9000).map(|list| list.pairs()), Some(9000));
        assert_eq!(rows(8999), None);
        // A few rows without end: stopped long before all are made.
        let long = |(): &mut (), _, rows: &mut Vec<u32>| rows.extend(0..1 << 20);
        assert_eq!(NeighborList::from_rows(1 << 30, 1 << 21, || (), long), None);
    }
}
