//! Order of particles along space.

use rayon::prelude::*;

use super::axis::Axis;
use super::search::{check_points, check_support};
use super::{Domain, NeighborError};
use crate::Vector;

/// Bits of a key along one axis: three axes fit into 64.
const BITS: u32 = 21;

/// The order in which particles lie along a Morton curve through cells `cell` m wide, so that
/// what neighbours read lies close in memory: particle `order[i]` is to become particle `i`.
///
/// Particles of one cell stay in the order they have. Empty stretches between particles do not
/// count; where more than two million cells follow each other along an axis, cells are doubled in
/// width until they do not. The cost is that of a sort.
///
/// # Errors
/// Non-finite points, too many of them, and an unusable `cell` (named as the support of particle
/// 0).
#[inline(never)]
pub fn spatial_order<const D: usize>(
    points: &[Vector<D>],
    cell: f64,
) -> Result<Vec<u32>, NeighborError> {
    let mut keys = Vec::new();
    order_along(points, cell, |_| 0, &mut keys)?;
    Ok(keys.into_iter().map(|(.., particle)| particle).collect())
}

/// What particles are ordered by: their class, their place on the curve, and their number.
pub(super) type Key = (u8, u64, u32);

/// The same of each class of particles by itself, one class after the other, into keys that may be there already.
pub(super) fn order_along<const D: usize>(
    points: &[Vector<D>],
    cell: f64,
    class: impl Fn(usize) -> u8 + Sync,
    keys: &mut Vec<Key>,
) -> Result<(), NeighborError> {
    check_points(points)?;
    check_support(0, cell)?;
    let mut axes = [const { Axis::EMPTY }; D];
    for (axis, made) in axes.iter_mut().enumerate() {
        *made = Axis::new(axis, points, cell, &Domain::open())?;
        if made.cells() > 1 << BITS {
            *made = Axis::without_gaps(axis, points, cell);
        }
    }
    let most = axes.iter().map(Axis::cells).max().unwrap_or(1);
    let doublings = (u64::BITS - (most - 1).leading_zeros()).saturating_sub(BITS);
    let key = |point: &Vector<D>| {
        let spread = |axis: usize| spread::<D>(axes[axis].cell(point[axis]) >> doublings) << axis;
        (0..D).map(spread).fold(0, |key, bits| key | bits)
    };
    let keyed = |(i, point): (usize, &Vector<D>)| (class(i), key(point), i as u32);
    points.par_iter().enumerate().map(keyed).collect_into_vec(keys);
    keys.par_sort_unstable();
    Ok(())
}

/// The lower bits of `cell`, moved apart to every `D`th place.
fn spread<const D: usize>(cell: u64) -> u64 {
    let interleave = |masks: [(u64, u32); 5]| {
        masks.iter().fold(cell & 0x1f_ffff, |x, (mask, shift)| (x | (x << shift)) & mask)
    };
    match D {
        1 => cell,
        2 => interleave([
            (0x0000_ffff_0000_ffff, 16),
            (0x00ff_00ff_00ff_00ff, 8),
            (0x0f0f_0f0f_0f0f_0f0f, 4),
            (0x3333_3333_3333_3333, 2),
            (0x5555_5555_5555_5555, 1),
        ]),
        _ => interleave([
            (0x001f_0000_0000_ffff, 32),
            (0x001f_0000_ff00_00ff, 16),
            (0x100f_00f0_0f00_f00f, 8),
            (0x10c3_0c30_c30c_30c3, 4),
            (0x1249_2492_4924_9249, 2),
        ]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread_in_all_dimensions() {
        let slow = |cell: u64, apart: u32| {
            (0..BITS).map(|bit| (cell >> bit & 1) << (bit * apart)).fold(0, |key, bit| key | bit)
        };
        for cell in (0..1 << BITS).step_by(977).chain([(1 << BITS) - 1]) {
            assert_eq!(spread::<1>(cell), cell);
            assert_eq!(spread::<2>(cell), slow(cell, 2));
            assert_eq!(spread::<3>(cell), slow(cell, 3));
        }
    }

    /// Points of a square lattice with `count` points a side and a spacing of 1, row by row.
    fn lattice(count: u32) -> Vec<Vector<2>> {
        let point = |i| Vector::<2>::new(f64::from(i % count), f64::from(i / count));
        (0..count * count).map(point).collect()
    }

    #[test]
    fn the_curve_visits_four_cells_as_a_letter_z() {
        let order = spatial_order(&lattice(4), 0.999).unwrap();
        assert_eq!(order, [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15]);
        // All in one cell: the order stays.
        assert_eq!(spatial_order(&lattice(4), 10.0).unwrap(), Vec::from_iter(0..16));
    }

    #[test]
    fn neighbours_come_close_in_memory() {
        // Row by row, half of the lattice neighbours are 256 apart; along the curve, three in four
        // of those in x and half of those in y lie in the same block of 4 x 4.
        let points = lattice(256);
        let order = spatial_order(&points, 1.0).unwrap();
        let mut place = vec![0i64; points.len()];
        order.iter().enumerate().for_each(|(new, &old)| place[old as usize] = new as i64);
        let mut seen = order.clone();
        seen.sort_unstable();
        assert_eq!(seen, Vec::from_iter(0..256 * 256));
        let above: Vec<i64> = (0..255 * 256).map(|i| (place[i + 256] - place[i]).abs()).collect();
        let close = above.iter().filter(|&&distance| distance < 16).count();
        assert!(close * 4 >= above.len() * 3 - 1000, "{close} of {}", above.len());
    }

    #[test]
    fn far_points_leave_the_others_in_order() {
        let mut points = lattice(16);
        let near = spatial_order(&points, 0.999).unwrap();
        points.push(Vector::<2>::repeat(1e300));
        points.push(Vector::<2>::repeat(2e300));
        let mut order = spatial_order(&points, 0.999).unwrap();
        order.retain(|&particle| particle < 256);
        assert_eq!(order, near);
        assert!(spatial_order(&points, f64::NAN).is_err());
        assert!(spatial_order(&[Vector::<1>::new(f64::NAN)], 1.0).is_err());
        assert_eq!(spatial_order::<3>(&[], 1.0), Ok(Vec::new()));
    }
}
