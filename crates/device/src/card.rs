//! What a card needs at least for a pass, by what its maker says of it.

use crate::work::Work;

/// A card as its maker describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Card {
    /// Its name.
    pub name: &'static str,
    /// Bytes a second from and to its memory.
    pub bandwidth: f64,
    /// Operations a second in double precision without matrix units, a product with a sum counted as two.
    pub double: f64,
    /// The same in single precision.
    pub single: f64,
}

/// Cards by their data sheets: NVIDIA's of H100 SXM, H200 SXM and A100 80GB SXM, and its paper on the Ada architecture
/// (RTX 4090, in double precision a 64th of single); AMD's of MI250X, of which each half is a device, and MI300X, both
/// without matrix units.
pub const CARDS: [Card; 6] = [
    Card { name: "H100", bandwidth: 3.35e12, double: 34e12, single: 67e12 },
    Card { name: "H200", bandwidth: 4.8e12, double: 34e12, single: 67e12 },
    Card { name: "A100", bandwidth: 2.039e12, double: 9.7e12, single: 19.5e12 },
    Card { name: "RTX 4090", bandwidth: 1.008e12, double: 82.6e12 / 64.0, single: 82.6e12 },
    Card { name: "half MI250X", bandwidth: 1.6384e12, double: 23.95e12, single: 23.95e12 },
    Card { name: "MI300X", bandwidth: 5.3e12, double: 81.7e12, single: 163.4e12 },
];

impl Card {
    /// A lower bound of the time in s that a pass takes per particle with so many neighbours, if its columns are too large
    /// for caches: memory carries no more than its bandwidth, and units for numbers of each precision do no more than
    /// their peak, of which text without contraction of products and sums reaches half.
    pub fn bound(&self, work: &Work, neighbors: f64) -> f64 {
        let moving = work.least_bytes(neighbors) / self.bandwidth;
        let [own, of_pairs] = work.flops(neighbors);
        let computing = match work.narrow.is_empty() {
            true => (own + of_pairs) / (0.5 * self.double),
            false => (own / self.double).max(of_pairs / self.single),
        };
        moving.max(computing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass::own;
    use crate::work::Operations;

    #[test]
    fn a_pass_is_bound_by_what_takes_longest() {
        let card = Card { name: "", bandwidth: 100.0, double: 20.0, single: 40.0 };
        let operations = Operations { sums: 30, ..Operations::default() };
        let by_neighbor = vec![Operations { products: 20, ..Operations::default() }];
        let work = Work { operations, taken: vec![own("mass", 100)], ..Work::default() };
        // 800 bytes take 8 s, 30 sums at half of the peak 3 s.
        assert_eq!(card.bound(&work, 5.0), 8.0);
        // With 100 products more 13 s.
        let work = Work { by_neighbor, taken: vec![own("mass", 1)], ..work };
        assert_eq!(card.bound(&work, 5.0), 13.0);
        // Contracted, 30 sums take 1.5 s in double precision, and the products 2.5 s in single precision.
        assert_eq!(card.bound(&Work { narrow: &["place"], ..work }, 5.0), 2.5);
    }
}
