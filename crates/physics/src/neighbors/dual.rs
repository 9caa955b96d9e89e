//! Dual and symmetric lists.

use super::{MOST_ENTRIES, NeighborError, NeighborList};

impl NeighborList {
    /// The dual list: row `a` holds all particles whose rows hold `a`, that is, whose supports
    /// contain it.
    pub fn dual(&self) -> Self {
        let mut offsets = vec![0; self.len() + 1];
        for &b in self.indices() {
            offsets[b as usize + 1] += 1;
        }
        for row in 0..self.len() {
            offsets[row + 1] += offsets[row];
        }
        let mut next = offsets.clone();
        let mut indices = vec![0; self.pairs()];
        // Rows are visited in ascending order, so those of the dual list come out so, too.
        for a in 0..self.len() {
            for &b in self.row(a) {
                indices[next[b as usize]] = a as u32;
                next[b as usize] += 1;
            }
        }
        Self::from_arrays(offsets, indices)
    }

    /// The smallest symmetric list that holds this one: the union with its dual.
    pub fn symmetric_closure(self) -> Self {
        if self.visit_reverse(|_| ()).is_ok() {
            return self;
        }
        let dual = self.dual();
        let append = |_: &mut (), a, rows: &mut Vec<u32>| merge(self.row(a), dual.row(a), rows);
        Self::from_rows(self.len(), usize::MAX, append).expect("there is no limit")
    }

    /// For entry `k` of the list, neighbour `b` of `a`, the entry of `a` in the row of `b`.
    ///
    /// # Errors
    /// [`NeighborError::NotSymmetric`] where there is none, [`NeighborError::TooManyEntries`] where
    /// entries cannot be numbered with 32 bits.
    pub fn reverse_entries(&self) -> Result<Vec<u32>, NeighborError> {
        if self.pairs() > MOST_ENTRIES {
            let (particles, most) = (self.len(), MOST_ENTRIES);
            return Err(NeighborError::TooManyEntries { particles, most });
        }
        let mut reverse = Vec::with_capacity(self.pairs());
        self.visit_reverse(|entry| reverse.push(entry as u32))?;
        Ok(reverse)
    }

    /// Calls `found` with the reverse of each entry in order.
    fn visit_reverse(&self, mut found: impl FnMut(usize)) -> Result<(), NeighborError> {
        // In a symmetric list the row of `b` is met in ascending order of `a`, so that one
        // position a row, moved on at each meeting, always points at the entry of `a`.
        let mut next = self.offsets().to_vec();
        for a in 0..self.len() {
            for &b in self.row(a) {
                let neighbor = b as usize;
                let entry = next[neighbor];
                let met = self.indices()[..self.offsets()[neighbor + 1]].get(entry);
                if met != Some(&(a as u32)) {
                    return Err(self.asymmetry(a, neighbor));
                }
                next[neighbor] += 1;
                found(entry);
            }
        }
        Ok(())
    }

    /// Names the entry without a reverse, met when `neighbor` in the row of `particle` had none.
    fn asymmetry(&self, particle: usize, neighbor: usize) -> NeighborError {
        if self.row(neighbor).binary_search(&(particle as u32)).is_err() {
            return NeighborError::NotSymmetric { particle, neighbor };
        }
        // The row of `neighbor` holds an earlier particle that does not hold `neighbor`.
        let missing = |&&c: &&u32| self.row(c as usize).binary_search(&(neighbor as u32)).is_err();
        let earlier = self.row(neighbor).iter().find(missing).copied().unwrap_or_default();
        NeighborError::NotSymmetric { particle: neighbor, neighbor: earlier as usize }
    }
}

/// Appends the union of two ascending rows in ascending order.
fn merge(mut left: &[u32], mut right: &[u32], union: &mut Vec<u32>) {
    while let (Some(&l), Some(&r)) = (left.first(), right.first()) {
        union.push(l.min(r));
        left = &left[usize::from(l <= r)..];
        right = &right[usize::from(r <= l)..];
    }
    union.extend_from_slice(left);
    union.extend_from_slice(right);
}
