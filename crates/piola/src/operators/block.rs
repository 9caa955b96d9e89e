//! Neighbours of one particle in arrays, so that one operation acts on many of them.

use super::inside::Reach;
use super::{LANES, Lanes};
use crate::Vector;
use crate::neighbors::shorter_way;

/// Neighbours a block, a multiple of the lanes.
pub const BLOCK: usize = 128;

/// Groups a block.
const GROUPS: usize = BLOCK / LANES;

/// Some neighbours b of one particle a, all inside its support, in arrays over neighbours.
///
/// The last group of [`LANES`] is filled up with its last neighbour, at a distance at which values
/// and slopes are zero.
#[derive(Clone, Debug)]
pub struct NeighborBlock<const D: usize> {
    length: usize,
    places: [u32; BLOCK],
    separations: [[f64; BLOCK]; D],
    pub(super) squares: [f64; BLOCK],
    pub(super) values: [f64; BLOCK],
    pub(super) slopes: [f64; BLOCK],
}

impl<const D: usize> Default for NeighborBlock<D> {
    fn default() -> Self {
        Self {
            length: 0,
            places: [0; BLOCK],
            separations: [[0.0; BLOCK]; D],
            squares: [0.0; BLOCK],
            values: [0.0; BLOCK],
            slopes: [0.0; BLOCK],
        }
    }
}

/// One neighbour b of a particle a.
#[derive(Clone, Copy, Debug)]
pub struct Neighbor<const D: usize> {
    /// Place of b in memory.
    pub place: usize,
    /// `r_ab = x_a - x_b` in m.
    pub separation: Vector<D>,
    /// `r_ab^2` in m^2.
    pub square: f64,
    /// `W_ab` in m^-D, if it was asked for.
    pub value: f64,
    /// `W'_ab / r_ab` in m^-(D+2), if it was asked for: the gradient `grad_a W_ab` is this times
    /// the separation.
    pub slope: f64,
}

/// Some neighbours of a block, one a lane.
#[derive(Clone, Copy, Debug)]
pub struct NeighborGroup<'a, const D: usize> {
    /// Places in memory.
    pub places: &'a [u32; LANES],
    /// `r_ab = x_a - x_b` in m, component by component.
    pub separations: [&'a Lanes; D],
    /// `r_ab^2` in m^2.
    pub squares: &'a Lanes,
    /// `W_ab` in m^-D, if it was asked for.
    pub values: &'a Lanes,
    /// `W'_ab / r_ab` in m^-(D+2), if it was asked for.
    pub slopes: &'a Lanes,
}

impl<const D: usize> NeighborGroup<'_, D> {
    /// The neighbour of one lane.
    #[inline(always)]
    pub fn neighbor(&self, lane: usize) -> Neighbor<D> {
        Neighbor {
            place: self.places[lane] as usize,
            separation: Vector::from_fn(|axis, _| self.separations[axis][lane]),
            square: self.squares[lane],
            value: self.values[lane],
            slope: self.slopes[lane],
        }
    }
}

impl<const D: usize> NeighborBlock<D> {
    /// The neighbours in order, by groups.
    #[inline(always)]
    pub fn groups(&self) -> impl Iterator<Item = NeighborGroup<'_, D>> {
        (0..self.length.min(BLOCK).div_ceil(LANES)).map(|group| NeighborGroup {
            places: &self.places.as_chunks().0[group],
            separations: std::array::from_fn(|axis| &self.separations[axis].as_chunks().0[group]),
            squares: &self.squares.as_chunks().0[group],
            values: &self.values.as_chunks().0[group],
            slopes: &self.slopes.as_chunks().0[group],
        })
    }

    /// The neighbours in order.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = Neighbor<D>> {
        (0..self.length.min(BLOCK)).map(|k| Neighbor {
            place: self.places[k] as usize,
            separation: Vector::from_fn(|axis, _| self.separations[axis][k]),
            square: self.squares[k],
            value: self.values[k],
            slope: self.slopes[k],
        })
    }

    /// Takes the first `length` of the neighbours at `places`, whole groups that are at most
    /// [`BLOCK`], of a particle at `here`. Where nothing `wraps`, no period is looked at. What fills
    /// up the last group is so far away that kernels vanish.
    #[inline(always)]
    pub(super) fn take<const WRAPS: bool>(
        &mut self,
        here: &Vector<D>,
        (places, length): (&[u32], usize),
        positions: &[Vector<D>],
        reach: &Reach<D>,
    ) {
        self.length = length;
        let groups = places.as_chunks::<LANES>().0;
        let kept = self.places.as_chunks_mut::<LANES>().0;
        for (group, (kept, places)) in kept.iter_mut().zip(groups).enumerate() {
            *kept = *places;
            let others = all_of(positions, places);
            let mut squares = [0.0; LANES];
            for axis in 0..D {
                let separations = &mut self.separations[axis].as_chunks_mut::<LANES>().0[group];
                for lane in 0..LANES {
                    let distance = here[axis] - others[lane][axis];
                    let distance = match WRAPS {
                        true => shorter_way(distance, reach.periods[axis]),
                        false => distance,
                    };
                    separations[lane] = distance;
                    squares[lane] += distance * distance;
                }
            }
            self.squares.as_chunks_mut::<LANES>().0[group] = squares;
        }
        if let Some(last) = length.checked_sub(1) {
            let squares = &mut self.squares.as_chunks_mut::<LANES>().0[last / LANES % GROUPS];
            for (lane, square) in squares.iter_mut().enumerate() {
                let is_filled_up = lane > last % LANES;
                *square = if is_filled_up { 4.0 * reach.limit } else { *square };
            }
        }
    }
}

/// What stands at some places.
#[inline(always)]
pub(crate) fn all_of<'a, T>(array: &'a [T], places: &[u32; LANES]) -> [&'a T; LANES] {
    // Written out: a map over an array is a call in some loops.
    let [a, b, c, d, e, f, g, h] = *places;
    let at = |place: u32| &array[place as usize];
    [at(a), at(b), at(c), at(d), at(e), at(f), at(g), at(h)]
}
