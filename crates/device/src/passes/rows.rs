//! Neighbour lists as a device reads them.

/// Rows of neighbours in one array, row `a` in `offsets[a]..offsets[a + 1]`.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// Where rows begin, with the end of the last.
    pub offsets: Vec<u32>,
    /// Neighbours.
    pub neighbors: Vec<u32>,
}

/// Rows that a warp reads together.
pub const SLICE: usize = 32;

/// Rows in slices of [`SLICE`]: entry k of row a is at `(first[a / SLICE] + k) SLICE + a % SLICE`, so
/// that threads of neighbouring rows read neighbouring numbers.
#[derive(Clone, Debug, Default)]
pub struct Sliced {
    /// Where slices begin, in units of a slice's width.
    pub first: Vec<u32>,
    /// Lengths of rows.
    pub length: Vec<u32>,
    /// Entries, with those that fill up.
    pub entries: usize,
}

impl Rows {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of a particle.
    #[inline]
    pub fn row(&self, a: usize) -> &[u32] {
        &self.neighbors[self.range(a)]
    }

    /// Where they stand.
    #[inline]
    pub fn range(&self, a: usize) -> std::ops::Range<usize> {
        self.offsets[a] as usize..self.offsets[a + 1] as usize
    }

    /// For entry k, neighbour b of a, the entry of a in the row of b, of a symmetric list with
    /// ascending rows.
    pub fn reverse(&self) -> Vec<u32> {
        let mut next = self.offsets.clone();
        let mut reverse = Vec::with_capacity(self.neighbors.len());
        for &b in &self.neighbors {
            reverse.push(next[b as usize]);
            next[b as usize] += 1;
        }
        reverse
    }

    /// Where entries go in slices.
    pub fn sliced(&self) -> Sliced {
        let length: Vec<u32> = self.offsets.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut first = vec![0];
        for slice in length.chunks(SLICE) {
            let longest = slice.iter().copied().max().unwrap_or(0);
            first.push(first.last().copied().unwrap_or(0) + longest);
        }
        let entries = first.last().copied().unwrap_or(0) as usize * SLICE;
        Sliced { first, length, entries }
    }

    /// Numbers of entries as they stand in slices.
    pub fn arranged<T: Copy>(&self, sliced: &Sliced, filler: T, of: impl Fn(usize) -> T) -> Vec<T> {
        let mut arranged = vec![filler; sliced.entries];
        for a in 0..self.len() {
            let first = sliced.first[a / SLICE] as usize;
            for (k, entry) in self.range(a).enumerate() {
                arranged[(first + k) * SLICE + a % SLICE] = of(entry);
            }
        }
        arranged
    }
}
