//! Lists without some of their pairs.

use super::NeighborList;

impl NeighborList {
    /// The list with only those entries `(a, b)` for which `keep(a, b)` holds.
    #[must_use]
    pub fn retain(&self, keep: impl Fn(u32, u32) -> bool) -> Self {
        let mut offsets = Vec::with_capacity(self.len() + 1);
        let mut indices = Vec::with_capacity(self.pairs());
        offsets.push(0);
        for a in 0..self.len() {
            indices.extend(self.row(a).iter().copied().filter(|&b| keep(a as u32, b)));
            offsets.push(indices.len());
        }
        Self::from_arrays(offsets, indices)
    }
}
