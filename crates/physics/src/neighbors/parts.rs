//! Which particles hang together.

use super::NeighborList;

impl NeighborList {
    /// The number of the part that each particle belongs to: those that see each other, from one to the
    /// next, whichever of two sees the other. Parts are numbered in the order of their first particles.
    pub fn parts(&self) -> Vec<u32> {
        let mut parent: Vec<u32> = (0..self.len() as u32).collect();
        for a in 0..self.len() {
            for &b in self.row(a) {
                let (one, other) = (root(&mut parent, a as u32), root(&mut parent, b));
                // The first particle of a part stands for it.
                parent[one.max(other) as usize] = one.min(other);
            }
        }
        let mut numbers = vec![u32::MAX; parent.len()];
        let mut next = 0;
        for a in 0..parent.len() {
            let first = root(&mut parent, a as u32) as usize;
            if numbers[first] == u32::MAX {
                numbers[first] = next;
                next += 1;
            }
            numbers[a] = numbers[first];
        }
        numbers
    }
}

/// The particle that stands for the part of `a`; the way there is halved.
fn root(parent: &mut [u32], mut a: u32) -> u32 {
    while parent[a as usize] != a {
        parent[a as usize] = parent[parent[a as usize] as usize];
        a = parent[a as usize];
    }
    a
}

#[cfg(test)]
mod tests {
    use crate::Vector;
    use crate::neighbors::{Domain, search};

    /// Two clusters and a particle by itself; a periodic box joins the clusters.
    #[test]
    fn parts_are_what_hangs_together() {
        let positions = [0.0, 5.0, 0.4, 9.6, 0.8, 9.2].map(Vector::<1>::new);
        let parts = |domain: &Domain<1>| {
            let list = search(&positions, &[0.5; 6], domain).expect("sound positions");
            list.parts()
        };
        assert_eq!(parts(&Domain::open()), [0, 1, 0, 2, 0, 2]);
        let around = Domain::new([Some([0.0, 10.0])]).expect("a sound box");
        assert_eq!(parts(&around), [0, 1, 0, 0, 0, 0]);
    }
}
