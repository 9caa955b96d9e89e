//! What passes compute and move, for those who look at them.

use crate::pass::{At, Use};
use crate::text::Precision;

/// What a pass computes of a particle, and which columns it touches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Operations of its laws per particle, without those of neighbours.
    pub operations: usize,
    /// Operations per neighbour, of each law over some of them.
    pub by_neighbor: Vec<usize>,
    /// Columns that are read of the particle itself.
    pub reads: Vec<Use>,
    /// Columns that are read of its neighbours.
    pub gathers: Vec<Use>,
    /// Columns that are written.
    pub writes: Vec<Use>,
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
    /// Bytes that are read and written per particle, and those that are read per neighbour, with the
    /// index of the neighbour. A column that is read and written counts twice.
    pub fn bytes(&self) -> [usize; 2] {
        let of_neighbor = match self.by_neighbor.is_empty() {
            true => 0,
            false => bytes(self.gathers.iter(), self.narrow) + size_of::<u32>(),
        };
        let of_row = |columns: &[Use]| bytes(columns.iter(), self.narrow);
        [of_row(&self.reads) + of_row(&self.writes), of_neighbor]
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
        let work = Work { gathers, by_neighbor: vec![3], ..Work::default() };
        assert_eq!(work.bytes(), [0, 32]);
        // The place is in single precision.
        assert_eq!(Work { narrow: &["place"], ..work }.bytes(), [0, 24]);
    }
}
