//! Neighbour search with cell grids.

use std::borrow::Cow;
use std::ops::Range;

use rayon::prelude::*;

use super::error::axis_name;
use super::grid::CellGrid;
use super::list::Rows;
use super::near::{Near, ROOM};
use super::{Domain, LEAST_SUPPORT, MOST_ENTRIES, MOST_SUPPORT, NeighborError, NeighborList};
use crate::Vector;

/// Most grids of one search, see [`search`].
const GRIDS: u32 = 8;

/// Lists for each particle `a` all others `b` with `|X_b - X_a| < support[a]`, the distance in m
/// being that of the minimal image in `domain`. Coincident particles are neighbours.
///
/// Where supports differ, particles are grouped by octaves of their support (by wider groups where
/// there would be more than eight) and each group searches in a grid of its own over all points.
/// The cost is linear in the number of particles, in that of groups and in that of the candidates,
/// which for an even distribution are at most `3^D / volume of the unit ball` times the neighbours
/// of the group's largest support. Memory is linear in particles and entries wherever points are.
///
/// # Errors
/// Non-finite points, unusable supports, a different number of both, too many points or neighbours,
/// and a period shorter than twice the largest support or too long for its cells to be numbered.
pub fn search<const D: usize>(
    points: &[Vector<D>],
    support: &[f64],
    domain: &Domain<D>,
) -> Result<NeighborList, NeighborError> {
    check(points, support, domain)?;
    let points = &*wrap(points, domain);
    let grids = Grids::new(points, support, domain)?;
    let append = |state: &mut Candidates<D>, a: usize, rows: &mut Vec<u32>| {
        let (group, grid) = grids.of(support[a]);
        state.collect(group, grid, &points[a]);
        let found = state.near(grid, &Near::new(points[a], support[a], domain));
        found.sort_unstable();
        let own = found.binary_search(&(a as u32)).expect("a particle is near to itself");
        rows.extend_from_slice(&found[..own]);
        rows.extend_from_slice(&found[own + 1..]);
    };
    let (particles, most) = (points.len(), MOST_ENTRIES);
    NeighborList::from_rows(particles, most, append)
        .ok_or(NeighborError::TooManyEntries { particles, most })
}

/// The list of [`search`] for particles that all have the same support, made again and again in the same arrays.
#[derive(Default)]
pub(super) struct RankedSearch<const D: usize> {
    grid: CellGrid<D>,
    pub rows: Rows<Candidates<D>>,
}

impl<const D: usize> RankedSearch<D> {
    /// Makes rows in ascending order of `ranks`, the rank of each particle, whose inverse is `ranked`: `count`
    /// of them, those of the first particles, which are all inside the bounds of the domain. A particle whose rank is
    /// at least `seen` sees only those with lower ones.
    ///
    /// # Errors
    /// Those of [`search`]; where there are too many entries there are no rows left.
    pub fn make(
        &mut self,
        points: &[Vector<D>],
        (support, domain): (f64, &Domain<D>),
        [ranks, ranked]: [&[u32]; 2],
        [count, seen]: [usize; 2],
    ) -> Result<(), NeighborError> {
        check_points(points)?;
        check_supports(points.len(), |_| support, domain)?;
        let Self { grid, rows } = self;
        grid.sort(points, support, domain)?;
        // What the last search knows is of other cells.
        rows.states().for_each(|state| state.cell = None);
        let (grid, seen) = (&*grid, seen as u32);
        let append = |state: &mut Candidates<D>, a: usize, rows: &mut Vec<u32>| {
            state.collect(0, grid, &points[a]);
            let found = state.near(grid, &Near::new(points[a], support, domain));
            found.iter_mut().for_each(|b| *b = ranks[*b as usize]);
            found.sort_unstable();
            let own = ranks[a];
            let count = match own < seen {
                true => found.len(),
                false => found.partition_point(|&rank| rank < seen),
            };
            let others = found[..count].iter().filter(|&&rank| rank != own);
            rows.extend(others.map(|&rank| ranked[rank as usize]));
        };
        let (particles, most) = (points.len(), MOST_ENTRIES);
        match rows.make([count, most], append) {
            true => Ok(()),
            false => Err(NeighborError::TooManyEntries { particles, most }),
        }
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        self.grid.memory() + self.rows.memory()
    }
}

/// Refuses particles closer to each other than `tolerance` m.
///
/// # Errors
/// [`NeighborError::Coincident`] with the first such particle and the first close to it, and those
/// of [`search`].
pub fn refuse_coincident<const D: usize>(
    points: &[Vector<D>],
    tolerance: f64,
    domain: &Domain<D>,
) -> Result<(), NeighborError> {
    check(points, &vec![tolerance; points.len()], domain)?;
    let wrapped = wrap(points, domain);
    let grid = CellGrid::new(&wrapped, tolerance, domain)?;
    let limit = tolerance * tolerance;
    // Only the first pair is looked for: a list of a million points at one place would not fit.
    let pair = (0..points.len()).into_par_iter().find_map_first(|a| {
        let mut ranges = Vec::new();
        grid.around(&grid.cell(&wrapped[a]), &mut ranges);
        let near = |&b: &u32| {
            let separation = domain.separation(&wrapped[a], &wrapped[b as usize]);
            b as usize != a && separation.norm_squared() < limit
        };
        let candidates = ranges.into_iter().flat_map(|range| &grid.ids()[range]);
        candidates.copied().filter(near).min().map(|b| (a, b as usize))
    });
    let Some((first, second)) = pair else {
        return Ok(());
    };
    let distance = domain.separation(&points[first], &points[second]).norm();
    let position = points[first].iter().copied().collect();
    Err(NeighborError::Coincident { first, second, distance, tolerance, position })
}

/// The images of all points inside the bounds of the domain.
fn wrap<'a, const D: usize>(points: &'a [Vector<D>], domain: &Domain<D>) -> Cow<'a, [Vector<D>]> {
    if domain.is_open() {
        return Cow::Borrowed(points);
    }
    Cow::Owned(points.iter().map(|point| domain.wrap(point)).collect())
}

fn check<const D: usize>(
    points: &[Vector<D>],
    support: &[f64],
    domain: &Domain<D>,
) -> Result<(), NeighborError> {
    if points.len() != support.len() {
        let (points, supports) = (points.len(), support.len());
        return Err(NeighborError::SupportCount { points, supports });
    }
    check_points(points)?;
    check_supports(support.len(), |particle| support[particle], domain)
}

/// Refuses supports that cannot be squared, or are too long for a periodic axis.
fn check_supports<const D: usize>(
    count: usize,
    support: impl Fn(usize) -> f64,
    domain: &Domain<D>,
) -> Result<(), NeighborError> {
    (0..count).try_for_each(|particle| check_support(particle, support(particle)))?;
    let Some(particle) = (0..count).max_by(|&a, &b| support(a).total_cmp(&support(b))) else {
        return Ok(());
    };
    for (axis, bounds) in domain.periodic().iter().enumerate() {
        if let &Some([lower, upper]) = bounds
            && upper - lower < 2.0 * support(particle)
        {
            let (axis, length, support) = (axis_name(axis), upper - lower, support(particle));
            return Err(NeighborError::PeriodicTooShort { axis, length, particle, support });
        }
    }
    Ok(())
}

/// Refuses points that cannot be put into cells.
pub(super) fn check_points<const D: usize>(points: &[Vector<D>]) -> Result<(), NeighborError> {
    if points.len() > u32::MAX as usize {
        return Err(NeighborError::TooManyParticles { count: points.len() });
    }
    if let Some(particle) = points.iter().position(|point| !point.iter().all(|x| x.is_finite())) {
        let position = points[particle].iter().copied().collect();
        return Err(NeighborError::NonFinite { particle, position });
    }
    Ok(())
}

/// Refuses lengths that cannot be squared.
pub(super) fn check_support(particle: usize, support: f64) -> Result<(), NeighborError> {
    if (LEAST_SUPPORT..=MOST_SUPPORT).contains(&support) {
        Ok(())
    } else {
        Err(NeighborError::Support { particle, support })
    }
}

/// One grid for each group of similar supports.
struct Grids<const D: usize> {
    grids: Vec<Option<CellGrid<D>>>,
    largest: f64,
    /// Octaves of support a group.
    octaves: u32,
}

impl<const D: usize> Grids<D> {
    fn new(
        points: &[Vector<D>],
        support: &[f64],
        domain: &Domain<D>,
    ) -> Result<Self, NeighborError> {
        let least = support.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = support.iter().copied().fold(0.0, f64::max);
        let octaves = (octaves_below(largest, least) + 1).div_ceil(GRIDS);
        let mut widths = vec![0.0; GRIDS as usize];
        for &support in support {
            let width: &mut f64 = &mut widths[group(largest, octaves, support)];
            *width = width.max(support);
        }
        let grid = |width| (width > 0.0).then(|| CellGrid::new(points, width, domain)).transpose();
        Ok(Self {
            grids: widths.into_iter().map(grid).collect::<Result<_, _>>()?,
            largest,
            octaves,
        })
    }

    /// The grid for a support that occurs, and its number.
    fn of(&self, support: f64) -> (usize, &CellGrid<D>) {
        let group = group(self.largest, self.octaves, support);
        (group, self.grids[group].as_ref().expect("each group with a particle has a grid"))
    }
}

fn group(largest: f64, octaves: u32, support: f64) -> usize {
    (octaves_below(largest, support) / octaves) as usize
}

/// How often `support` must be doubled at least to exceed half of `largest`.
fn octaves_below(largest: f64, support: f64) -> u32 {
    // Both are positive and normal: the exponents are bits 52 to 62.
    let exponent = |x: f64| (x.to_bits() >> 52) as u32;
    exponent(largest).saturating_sub(exponent(support))
}

/// The points around the cell of the last particle, kept as the next one is often in the same.
pub(super) struct Candidates<const D: usize> {
    cell: Option<(usize, [u64; D])>,
    ranges: Vec<Range<usize>>,
    near: Vec<u32>,
}

impl<const D: usize> Default for Candidates<D> {
    fn default() -> Self {
        Self { cell: None, ranges: Vec::new(), near: Vec::new() }
    }
}

impl<const D: usize> Candidates<D> {
    fn collect(&mut self, group: usize, grid: &CellGrid<D>, point: &Vector<D>) {
        let cell = grid.cell(point);
        if self.cell == Some((group, cell)) {
            return;
        }
        self.cell = Some((group, cell));
        grid.around(&cell, &mut self.ranges);
        // Particles ordered along space have consecutive numbers in a cell. Cells in the order of
        // their first ones then give ascending rows, which cost next to nothing to sort.
        self.ranges.sort_unstable_by_key(|range| grid.ids()[range.start]);
        let candidates: usize = self.ranges.iter().map(Range::len).sum();
        if self.near.len() < candidates + ROOM {
            self.near.resize(candidates + ROOM, 0);
        }
    }

    /// The candidates that are near.
    #[inline]
    fn near(&mut self, grid: &CellGrid<D>, near: &Near<D>) -> &mut [u32] {
        let mut count = 0;
        for range in &self.ranges {
            count += near.append(grid, range.clone(), &mut self.near[count..]);
        }
        &mut self.near[..count]
    }
}
