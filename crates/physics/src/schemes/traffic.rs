//! What stages move through memory: arrays, and bytes of a particle.

use super::stages::{Stage, StageFault};
use crate::fields::FieldDescription;
use crate::operators::RowSizes;

/// An array of a formulation, in which columns of its stages stand: that of its name, and those whose names begin with it
/// and a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Array {
    /// Its name.
    pub name: &'static str,
    /// Bytes of a particle, on average over all.
    pub bytes: f64,
    /// Of lists of neighbours, how many of them a particle has, with what fills up groups.
    pub neighbors: f64,
    /// The share of the particles that a stage goes through which reads it.
    pub share: f64,
}

impl Array {
    /// One with a `T` of each particle.
    pub(crate) const fn of<T>(name: &'static str) -> Self {
        Self::with(name, size_of::<T>())
    }

    /// One with so many bytes of each particle.
    pub(crate) const fn with(name: &'static str, bytes: usize) -> Self {
        Self { name, bytes: bytes as f64, neighbors: 0.0, share: 1.0 }
    }

    /// One with so many bytes in all, of `count` particles.
    pub(crate) fn spread(name: &'static str, bytes: usize, count: usize) -> Self {
        Self { bytes: bytes as f64 / count.max(1) as f64, ..Self::with(name, 0) }
    }

    /// The lists of neighbours of some of `count` particles.
    pub(crate) fn rows(name: &'static str, sizes: RowSizes, count: usize) -> Self {
        let rows = sizes.rows.max(1) as f64;
        Self {
            name,
            bytes: sizes.bytes as f64 / rows,
            neighbors: sizes.entries as f64 / rows,
            share: sizes.rows as f64 / count.max(1) as f64,
        }
    }

    /// What has nothing of most particles, of `count` of them so many have something.
    pub(crate) fn of_few(name: &'static str, few: usize, count: usize) -> Self {
        Self { share: few as f64 / count.max(1) as f64, ..Self::with(name, 0) }
    }

    /// The columns of a state.
    pub(crate) fn columns(
        fields: &'static [FieldDescription],
        dimension: usize,
    ) -> impl Iterator<Item = Self> {
        let stored = fields.iter().filter(|field| field.is_stored());
        stored.map(move |field| {
            Self::with(field.name, field.kind.components(dimension) * size_of::<f64>())
        })
    }

    /// That of a column.
    fn find<'a>(all: &'a [Self], column: &str) -> Option<&'a Self> {
        let named = |name: &str| all.iter().find(|array| array.name == name);
        named(column).or_else(|| named(column.split_once('.')?.0))
    }
}

/// Bytes that a stage moves, per particle of its system, on average.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traffic {
    /// What is read and written of particles themselves; an array that is read and written counts twice.
    pub own: f64,
    /// What is read of neighbours, and the lists that name them. Caches serve most of it.
    pub gathered: f64,
    /// What comes from memory and goes there, even if caches serve all that is read again: each array that is read once,
    /// whoever reads it, each that is written, and the lists.
    pub least: f64,
}

impl Traffic {
    /// That of a stage, whose columns stand in some arrays.
    ///
    /// # Errors
    /// A column that stands in none.
    pub(crate) fn of(stage: &Stage, arrays: &[Array]) -> Result<Self, StageFault> {
        let find = |columns: &[&[&'static str]]| -> Result<Vec<Array>, StageFault> {
            let mut found: Vec<Array> = Vec::new();
            for &column in columns.iter().copied().flatten() {
                let fault = StageFault::NoArray { stage: stage.name, column };
                let array = Array::find(arrays, column).ok_or(fault)?;
                if !found.iter().any(|known| known.name == array.name) {
                    found.push(*array);
                }
            }
            Ok(found)
        };
        let bytes = |arrays: &[Array]| arrays.iter().fold(0.0, |sum, array| sum + array.bytes);
        let (lists, read): (Vec<Array>, Vec<Array>) =
            find(&[stage.reads])?.into_iter().partition(|array| array.neighbors > 0.0);
        let (gathered, written) = (find(&[stage.gathers])?, find(&[stage.writes, stage.shows])?);
        let once = find(&[stage.reads, stage.gathers])?;
        let shares = once.iter().map(|array| array.share);
        let share = shares.fold(1.0, f64::min);
        let neighbors: f64 = lists.iter().map(|list| list.neighbors).sum();
        Ok(Self {
            own: share * (bytes(&read) + bytes(&written)),
            gathered: share * (bytes(&lists) + neighbors * bytes(&gathered)),
            least: share * (bytes(&once) + bytes(&written)),
        })
    }

    /// That of several stages.
    pub fn sum<'a>(all: impl IntoIterator<Item = &'a Self>) -> Self {
        all.into_iter().fold(Self::default(), |sum, it| Self {
            own: sum.own + it.own,
            gathered: sum.gathered + it.gathered,
            least: sum.least + it.least,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_arrays() {
        let sizes = RowSizes { rows: 10, entries: 80, bytes: 400 };
        let arrays = [
            Array::of::<[f64; 3]>("velocity"),
            Array::of::<[f64; 8]>("side"),
            Array::of::<f64>("side.own"),
            Array::rows("neighbors", sizes, 20),
        ];
        let stage = Stage {
            name: "sum",
            reads: &["velocity", "side.a", "side.b", "neighbors"],
            gathers: &["side.b", "side.own"],
            writes: &["velocity"],
            shows: &["side.a"],
        };
        // Half of the particles have 8 neighbours in 40 bytes each. A record is read as a whole, once.
        let of_half = Traffic {
            own: 24.0 + 64.0 + 24.0 + 64.0,
            gathered: 40.0 + 8.0 * (64.0 + 8.0),
            least: 24.0 + 64.0 + 8.0 + 40.0 + 24.0 + 64.0,
        };
        let found = Traffic::of(&stage, &arrays).expect("all columns stand somewhere");
        assert_eq!(Traffic::sum([&found, &found]), of_half);
        let lost = Traffic::of(&Stage { writes: &["force"], ..stage }, &arrays);
        assert_eq!(lost, Err(StageFault::NoArray { stage: "sum", column: "force" }));
    }
}
