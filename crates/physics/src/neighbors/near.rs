//! The choice of those points that are near to one.

use multiversion::multiversion;

use super::domain::shorter_way;
use super::{Domain, grid::CellGrid};
use crate::Vector;

/// Points that are looked at together.
const GROUP: usize = 8;

/// Entries that [`Near::append`] needs beyond those that it keeps.
pub(super) const ROOM: usize = GROUP;

/// What is near to a point.
pub(super) struct Near<const D: usize> {
    center: Vector<D>,
    /// Square of the distance in m^2 from which on a point is far.
    limit: f64,
    /// Periods in m, infinite along open axes, if there may be a periodic bound between.
    periods: Option<[f64; D]>,
}

impl<const D: usize> Near<D> {
    /// What is nearer than `reach` m to `center`, which is inside the bounds of the domain.
    pub fn new(center: Vector<D>, reach: f64, domain: &Domain<D>) -> Self {
        let is_within = |(x, [low, high]): (&f64, [f64; 2])| low <= *x && *x <= high;
        // A little more than the reach, so that rounding does not matter.
        let within = domain.within(1.01 * reach);
        let is_apart = center.iter().zip(within).all(is_within);
        Self { center, limit: reach * reach, periods: (!is_apart).then(|| domain.periods()) }
    }

    /// Writes the numbers of those points of a grid in `range` that are near to the front of
    /// `found`, which has [`ROOM`] for more, and returns how many they are.
    pub fn append(
        &self,
        grid: &CellGrid<D>,
        range: std::ops::Range<usize>,
        found: &mut [u32],
    ) -> usize {
        let (points, ids) = (&grid.points()[range.clone()], &grid.ids()[range]);
        match &self.periods {
            Some(_) => append::<D, true>(self, points, ids, found),
            None => append::<D, false>(self, points, ids, found),
        }
    }

    #[inline(always)]
    fn is_near<const WRAPS: bool>(&self, periods: &[f64; D], point: &Vector<D>) -> bool {
        let mut square = 0.0;
        for axis in 0..D {
            let distance = point[axis] - self.center[axis];
            let distance = if WRAPS { shorter_way(distance, periods[axis]) } else { distance };
            square += distance * distance;
        }
        square < self.limit
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn append<const D: usize, const WRAPS: bool>(
    near: &Near<D>,
    points: &[Vector<D>],
    ids: &[u32],
    found: &mut [u32],
) -> usize {
    let periods = near.periods.unwrap_or([f64::INFINITY; D]);
    let (groups, last_points) = points.as_chunks::<GROUP>();
    let (id_groups, last_ids) = ids.as_chunks::<GROUP>();
    let mut length = 0;
    for (points, ids) in groups.iter().zip(id_groups) {
        let mut are_near = [false; GROUP];
        for k in 0..GROUP {
            are_near[k] = near.is_near::<WRAPS>(&periods, &points[k]);
        }
        // Every candidate is written and kept by the step of the counter, as a branch would be
        // guessed wrong every third time.
        let window: &mut [u32; GROUP] =
            found[length..].first_chunk_mut().expect("there is room beyond those that are near");
        let mut more = 0;
        for k in 0..GROUP {
            window[more % GROUP] = ids[k];
            more += usize::from(are_near[k]);
        }
        length += more;
    }
    for (point, &id) in last_points.iter().zip(last_ids) {
        found[length] = id;
        length += usize::from(near.is_near::<WRAPS>(&periods, point));
    }
    length
}
