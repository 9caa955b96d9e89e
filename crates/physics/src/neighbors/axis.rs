//! Cells along one axis.

use rayon::prelude::*;
use smallvec::{SmallVec, smallvec};

use super::error::axis_name;
use super::{Domain, MOST_CELLS, NeighborError};
use crate::Vector;

/// Cells are wider than asked by this share, so that rounding never puts two points closer than
/// the width asked for two cells apart: numbering 4e9 cells errs by 4e-6 of a cell at most.
const MARGIN: f64 = 1e-5;

/// An axis cut into cells. Stretches of it that hold points are numbered one after the other with
/// an empty cell between them, whatever their distance.
pub(super) struct Axis {
    /// One, unless there are gaps.
    stretches: SmallVec<[Stretch; 1]>,
    /// Cells a metre.
    inverse: f64,
    cells: u64,
    periodic: bool,
}

#[derive(Clone, Copy)]
struct Stretch {
    /// Coordinate of the first cell's lower end in m.
    lower: f64,
    first: u64,
    last: u64,
}

impl Axis {
    /// An axis without cells.
    pub(super) const EMPTY: Self =
        Self { stretches: SmallVec::new_const(), inverse: 1.0, cells: 1, periodic: false };

    /// Cells at least `width` m wide between the least and the largest coordinate `axis` of
    /// `points`, or between the bounds of a periodic axis.
    ///
    /// # Errors
    /// [`NeighborError::PeriodicTooLong`] where there would be more than [`MOST_CELLS`].
    pub(super) fn new<const D: usize>(
        axis: usize,
        points: &[Vector<D>],
        width: f64,
        domain: &Domain<D>,
    ) -> Result<Self, NeighborError> {
        if let Some([lower, upper]) = domain.periodic()[axis] {
            let length = upper - lower;
            let cells = (length / (width * (1.0 + MARGIN))).floor().max(1.0);
            if cells > MOST_CELLS {
                let axis = axis_name(axis);
                return Err(NeighborError::PeriodicTooLong { axis, length, support: width });
            }
            let stretch = Stretch { lower, first: 0, last: cells as u64 - 1 };
            let (stretches, inverse) = (smallvec![stretch], cells / length);
            return Ok(Self { stretches, inverse, cells: cells as u64, periodic: true });
        }
        let coordinates = || points.iter().map(|point| point[axis]);
        let lower = coordinates().fold(f64::INFINITY, f64::min);
        let upper = coordinates().fold(f64::NEG_INFINITY, f64::max);
        Ok(Self::from_stretches([(lower, upper)].into_iter(), width))
    }

    /// The same without cells in stretches that hold no point: at most two cells a point.
    pub(super) fn without_gaps<const D: usize>(
        axis: usize,
        points: &[Vector<D>],
        width: f64,
    ) -> Self {
        let mut sorted: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        sorted.par_sort_unstable_by(f64::total_cmp);
        let near = |a: &f64, b: &f64| b - a < width;
        let ends = |stretch: &[f64]| (stretch[0], stretch[stretch.len() - 1]);
        Self::from_stretches(sorted.chunk_by(near).map(ends), width)
    }

    fn from_stretches(ends: impl Iterator<Item = (f64, f64)>, width: f64) -> Self {
        let inverse = 1.0 / (width * (1.0 + MARGIN));
        let mut stretches = SmallVec::new();
        let mut cells = 0;
        for (lower, upper) in ends {
            // A conversion of a large or non-finite number ends at the bounds of the type; such
            // an axis has too many cells to be used and is replaced by one without gaps.
            let further = (((upper - lower) * inverse) as u64).min(MOST_CELLS as u64);
            stretches.push(Stretch { lower, first: cells, last: cells + further });
            cells += further + 2;
        }
        Self { stretches, inverse, cells: cells.max(1), periodic: false }
    }

    /// Number of cells.
    #[inline]
    pub(super) fn cells(&self) -> u64 {
        self.cells
    }

    /// The cell of a coordinate that the axis was made for.
    #[inline]
    pub(super) fn cell(&self, x: f64) -> u64 {
        let stretch = match self.stretches.as_slice() {
            [only] => only,
            all => &all[all.partition_point(|stretch| stretch.lower <= x).max(1) - 1],
        };
        (stretch.first + ((x - stretch.lower) * self.inverse) as u64).min(stretch.last)
    }

    /// First and last of the cells within one of `cell`, in one run or, across the ends of a
    /// periodic axis, two; each cell once.
    pub(super) fn around(&self, cell: u64) -> impl Iterator<Item = (u64, u64)> {
        let last = self.cells - 1;
        let runs = if !self.periodic {
            [Some((cell.saturating_sub(1), (cell + 1).min(last))), None]
        } else if last <= 2 {
            [Some((0, last)), None]
        } else if cell == 0 {
            [Some((0, 1)), Some((last, last))]
        } else if cell == last {
            [Some((0, 0)), Some((last - 1, last))]
        } else {
            [Some((cell - 1, cell + 1)), None]
        };
        runs.into_iter().flatten()
    }
}
