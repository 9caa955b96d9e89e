//! Cells that hold particles: a counting sort whose memory is bounded by their number.

use std::ops::Range;

use rayon::prelude::*;

use super::axis::Axis;
use super::{Domain, NeighborError};
use crate::Vector;

/// Cells a particle that are still numbered one by one. Beyond it most cells are empty, and only
/// those that hold particles are numbered.
const CELLS_PER_PARTICLE: u128 = 4;

/// Points sorted into cells at least as wide as a given length, so that all points nearer than it
/// are in a point's own cell or in one next to it.
pub(super) struct CellGrid<const D: usize> {
    axes: [Axis; D],
    slots: Slots,
    /// Slot `s` holds `points[starts[s]..starts[s + 1]]`.
    starts: Vec<u32>,
    points: Vec<Vector<D>>,
    ids: Vec<u32>,
    /// The key of each point, and its slot.
    keys: Vec<u128>,
    own: Vec<u32>,
}

impl<const D: usize> Default for CellGrid<D> {
    fn default() -> Self {
        Self {
            axes: [const { Axis::EMPTY }; D],
            slots: Slots::Dense(0),
            starts: Vec::new(),
            points: Vec::new(),
            ids: Vec::new(),
            keys: Vec::new(),
            own: Vec::new(),
        }
    }
}

/// How keys of cells, their numbers row by row in the whole grid, become positions in an array.
enum Slots {
    /// All cells: a slot is its key.
    Dense(usize),
    /// Only the cells with these keys, in ascending order.
    Sparse(Vec<u128>),
}

impl Slots {
    fn len(&self) -> usize {
        match self {
            Self::Dense(count) => *count,
            Self::Sparse(keys) => keys.len(),
        }
    }

    /// The first slot whose key is `key` or larger.
    #[inline]
    fn at_or_after(&self, key: u128) -> usize {
        match self {
            Self::Dense(_) => key as usize,
            Self::Sparse(keys) => keys.partition_point(|&other| other < key),
        }
    }
}

impl<const D: usize> CellGrid<D> {
    /// Sorts `points`, finite and inside the domain's bounds, into cells at least `width` m wide.
    ///
    /// Linear in the number of points. Where most cells would be empty, empty stretches between
    /// points are left out, and if that does not help, cells with points are found by sorting.
    pub(super) fn new(
        points: &[Vector<D>],
        width: f64,
        domain: &Domain<D>,
    ) -> Result<Self, NeighborError> {
        let mut grid = Self::default();
        grid.sort(points, width, domain)?;
        Ok(grid)
    }

    /// The same with arrays that may be there already.
    pub(super) fn sort(
        &mut self,
        points: &[Vector<D>],
        width: f64,
        domain: &Domain<D>,
    ) -> Result<(), NeighborError> {
        let axes = Self::axes(points, width, domain)?;
        let Self { starts, ids, keys, own, .. } = self;
        points.par_iter().map(|point| key(&axes, &cell(&axes, point))).collect_into_vec(keys);
        let slots = Self::slots(&axes, keys);
        keys.par_iter().map(|&key| slots.at_or_after(key) as u32).collect_into_vec(own);
        starts.clear();
        starts.resize(slots.len() + 1, 0);
        own.iter().for_each(|&slot| starts[slot as usize] += 1);
        // Sums from the front make each entry the end of its slot; filling from the back, in
        // descending order of points, moves it to the start and keeps points in order.
        let mut end = 0;
        for start in &mut *starts {
            end += *start;
            *start = end;
        }
        ids.resize(points.len(), 0);
        for (point, &slot) in own.iter().enumerate().rev() {
            starts[slot as usize] -= 1;
            ids[starts[slot as usize] as usize] = point as u32;
        }
        ids.par_iter().map(|&id| points[id as usize]).collect_into_vec(&mut self.points);
        (self.axes, self.slots) = (axes, slots);
        Ok(())
    }

    /// Bytes of all arrays.
    pub(super) fn memory(&self) -> usize {
        self.points.capacity() * size_of::<Vector<D>>()
            + self.keys.capacity() * size_of::<u128>()
            + [&self.starts, &self.ids, &self.own].map(Vec::capacity).iter().sum::<usize>()
                * size_of::<u32>()
    }

    fn axes(
        points: &[Vector<D>],
        width: f64,
        domain: &Domain<D>,
    ) -> Result<[Axis; D], NeighborError> {
        let mut axes = [const { Axis::EMPTY }; D];
        for (axis, made) in axes.iter_mut().enumerate() {
            *made = Axis::new(axis, points, width, domain)?;
        }
        if cells(&axes) > most_dense(points.len()) {
            for (axis, made) in axes.iter_mut().enumerate() {
                if domain.periodic()[axis].is_none() {
                    *made = Axis::without_gaps(axis, points, width);
                }
            }
        }
        Ok(axes)
    }

    fn slots(axes: &[Axis; D], keys: &[u128]) -> Slots {
        let count = cells(axes);
        if count <= most_dense(keys.len()) {
            return Slots::Dense(count as usize);
        }
        let mut sorted = keys.to_vec();
        sorted.par_sort_unstable();
        sorted.dedup();
        Slots::Sparse(sorted)
    }

    /// The cell of a point that is in the grid.
    #[inline]
    pub(super) fn cell(&self, point: &Vector<D>) -> [u64; D] {
        cell(&self.axes, point)
    }

    /// Replaces `ranges` by those of [`Self::points`] in `cell` and the cells next to it.
    pub(super) fn around(&self, cell: &[u64; D], ranges: &mut Vec<Range<usize>>) {
        ranges.clear();
        self.visit(cell, D - 1, 0, ranges);
    }

    fn visit(&self, cell: &[u64; D], axis: usize, key: u128, ranges: &mut Vec<Range<usize>>) {
        let line = &self.axes[axis];
        for (first, last) in line.around(cell[axis]) {
            let extended = |cell: u64| key * u128::from(line.cells()) + u128::from(cell);
            for next in first..=last {
                if axis > 0 {
                    self.visit(cell, axis - 1, extended(next), ranges);
                    continue;
                }
                let start = self.starts[self.slots.at_or_after(extended(next))];
                let end = self.starts[self.slots.at_or_after(extended(next) + 1)];
                if start < end {
                    ranges.push(start as usize..end as usize);
                }
            }
        }
    }

    /// All points, cell by cell.
    pub(super) fn points(&self) -> &[Vector<D>] {
        &self.points
    }

    /// For each of [`Self::points`] its number before sorting.
    pub(super) fn ids(&self) -> &[u32] {
        &self.ids
    }
}

/// The cell of `point` along each axis.
#[inline]
fn cell<const D: usize>(axes: &[Axis; D], point: &Vector<D>) -> [u64; D] {
    std::array::from_fn(|axis| axes[axis].cell(point[axis]))
}

/// Number of a cell, counted along x first.
#[inline]
fn key<const D: usize>(axes: &[Axis; D], cell: &[u64; D]) -> u128 {
    let join =
        |key, (axis, &cell): (&Axis, &u64)| key * u128::from(axis.cells()) + u128::from(cell);
    axes.iter().zip(cell).rev().fold(0, join)
}

/// Number of all cells.
fn cells<const D: usize>(axes: &[Axis; D]) -> u128 {
    axes.iter().map(|axis| u128::from(axis.cells())).product()
}

/// Most cells that are numbered one by one, with 32 bits.
fn most_dense(points: usize) -> u128 {
    (CELLS_PER_PARTICLE * points as u128 + 64).min(u128::from(u32::MAX))
}
