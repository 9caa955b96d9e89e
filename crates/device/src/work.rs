//! What passes compute and move, for those who look at them.

use std::ops::Add;

use crate::pass::{At, Use};
use crate::text::Precision;

/// Operations by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions and subtractions.
    pub sums: usize,
    /// Multiplications.
    pub products: usize,
    /// Divisions.
    pub quotients: usize,
    /// Square roots.
    pub roots: usize,
    /// Exponentials, logarithms, powers and the like, each of which takes many of the others.
    pub functions: usize,
    /// Comparisons, selections and signs, which round nothing.
    pub choices: usize,
}

impl Operations {
    /// Those on floating-point numbers, where a function counts as one.
    pub fn flops(&self) -> usize {
        self.sums + self.products + self.quotients + self.roots + self.functions
    }

    /// All of them.
    pub fn all(&self) -> usize {
        self.flops() + self.choices
    }
}

impl Add for Operations {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            sums: self.sums + other.sums,
            products: self.products + other.products,
            quotients: self.quotients + other.quotients,
            roots: self.roots + other.roots,
            functions: self.functions + other.functions,
            choices: self.choices + other.choices,
        }
    }
}

/// What a pass computes of a particle, and which columns it touches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Operations of its laws per particle, without those of neighbours.
    pub operations: Operations,
    /// Operations per neighbour, of each law over some of them.
    pub by_neighbor: Vec<Operations>,
    /// Columns that are read of the particle itself.
    pub reads: Vec<Use>,
    /// Columns that are read of its neighbours.
    pub gathers: Vec<Use>,
    /// Columns of rows that do not change, with numbers of each pair.
    pub of_pairs: Vec<Use>,
    /// Columns that are written.
    pub writes: Vec<Use>,
    /// What is read, of the particle or of its neighbours, each column once with the numbers that laws take.
    pub taken: Vec<Use>,
    /// Names of the columns in single precision.
    pub narrow: &'static [&'static str],
}

/// Adds the uses that are not known yet.
pub(crate) fn join<'a>(known: &mut Vec<Use>, more: impl IntoIterator<Item = &'a Use>) {
    for column in more {
        if !known.iter().any(|known| known.is_of(column)) {
            known.push(*column);
        }
    }
}

/// Bytes of the rows of some columns, with the indices by which they are found.
fn bytes<'a>(columns: impl Iterator<Item = &'a Use>, narrow: &[&str]) -> usize {
    let mut indices = Vec::new();
    let mut numbers = 0;
    for column in columns {
        let precision = match narrow.contains(&column.column) {
            true => Precision::Single,
            false => Precision::Double,
        };
        numbers += column.width * precision.bytes();
        if let At::Through(index) = column.at
            && !indices.contains(&index)
        {
            indices.push(index);
        }
    }
    numbers + indices.len() * size_of::<u32>()
}

impl Work {
    /// Adds numbers that are taken; of the same column those that are most.
    pub(crate) fn take(&mut self, more: impl IntoIterator<Item = Use>) {
        for column in more.into_iter().filter(|column| column.width > 0) {
            match self.taken.iter_mut().find(|known| known.column == column.column) {
                Some(known) => known.width = known.width.max(column.width),
                None => self.taken.push(column),
            }
        }
    }

    /// Bytes that are read and written per particle, and those that are read per neighbour, with the
    /// index of the neighbour. A column that is read and written counts twice.
    pub fn bytes(&self) -> [usize; 2] {
        let of_neighbor = match self.by_neighbor.is_empty() {
            true => 0,
            false => bytes(self.gathers.iter(), self.narrow) + self.bytes_of_pair(),
        };
        let of_row = |columns: &[Use]| bytes(columns.iter(), self.narrow);
        [of_row(&self.reads) + of_row(&self.writes), of_neighbor]
    }

    /// Bytes of a pair in rows: the index of the neighbour, and what does not change.
    fn bytes_of_pair(&self) -> usize {
        bytes(self.of_pairs.iter(), self.narrow) + size_of::<u32>()
    }

    /// Bytes per particle with so many neighbours that come from memory, or go there, even if caches serve all that is
    /// read again: the numbers that laws take once, whoever reads them, those that are written, and the rows.
    pub fn least_bytes(&self, neighbors: f64) -> f64 {
        let of_rows = match self.by_neighbor.is_empty() {
            true => 0.0,
            false => neighbors * self.bytes_of_pair() as f64,
        };
        let own = bytes(self.taken.iter(), self.narrow) + bytes(self.writes.iter(), self.narrow);
        own as f64 + of_rows
    }

    /// [Operations on numbers](Operations::flops) of a particle with so many neighbours, without those of pairs and of
    /// pairs alone. Where laws differ between neighbours, all are taken for those with the fewest.
    pub fn flops(&self, neighbors: f64) -> [f64; 2] {
        let of_pair = self.by_neighbor.iter().map(Operations::flops).min().unwrap_or(0);
        [self.operations.flops() as f64, neighbors * of_pair as f64]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass::{own, through};

    #[test]
    fn bytes_are_those_of_rows_and_of_indices() {
        let reads = vec![own("mass", 1), through("slots", "rate", 4), through("slots", "side", 8)];
        let work = Work { reads, writes: vec![own("rate", 4)], ..Work::default() };
        // 17 numbers of 8 bytes, and one index of 4.
        assert_eq!(work.bytes(), [140, 0]);
        let gathers = vec![own("place", 2), through("numbers", "mass", 1)];
        let of_pair = Operations { sums: 2, products: 1, choices: 5, ..Operations::default() };
        let work = Work { gathers, by_neighbor: vec![of_pair], ..Work::default() };
        assert_eq!(work.bytes(), [0, 32]);
        // The place is in single precision.
        assert_eq!(Work { narrow: &["place"], ..work }.bytes(), [0, 24]);
    }

    #[test]
    fn what_is_read_twice_comes_from_memory_once() {
        let few = Operations { sums: 2, products: 1, choices: 5, ..Operations::default() };
        let more = few + Operations { quotients: 1, roots: 1, functions: 1, ..few };
        let mut work = Work {
            operations: few,
            by_neighbor: vec![more, few],
            of_pairs: vec![own("areas", 2)],
            writes: vec![own("side", 4)],
            ..Work::default()
        };
        work.take([own("place", 3), own("side", 1)]);
        work.take([own("side", 4), own("mass", 0), own("place", 3)]);
        // 7 numbers are read and 4 written; each of ten neighbours has two numbers and an index.
        assert_eq!(work.least_bytes(10.0), 8.0 * 11.0 + 10.0 * 20.0);
        assert_eq!((more.flops(), more.all()), (9, 19));
        assert_eq!(work.flops(10.0), [3.0, 30.0]);
    }
}
