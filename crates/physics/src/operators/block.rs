//! Neighbours of one particle in arrays, so that one operation acts on many of them.

use nalgebra::{ArrayStorage, SVector};
use piola_formulas::pairs::Moving;
use piola_formulas::{Lanes, Lanes4, WIDTH};

use super::LANES;
use super::inside::Reach;
use crate::Vector;
use crate::neighbors::shorter_way;

/// Neighbours a block, a multiple of the lanes.
pub const BLOCK: usize = 128;

/// Groups a block.
const GROUPS: usize = BLOCK / LANES;

/// Registers a block.
const QUADS: usize = BLOCK / WIDTH;

/// Some neighbours b of one particle a, all inside its support, in arrays over neighbours.
///
/// The last group of [`LANES`] is filled up with its last neighbour, at a distance at which values
/// and slopes are zero.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct NeighborBlock<const D: usize> {
    separations: [[f64; BLOCK]; D],
    pub(super) squares: [f64; BLOCK],
    pub(super) values: [f64; BLOCK],
    pub(super) slopes: [f64; BLOCK],
    places: [u32; BLOCK],
    length: usize,
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

impl<const D: usize> NeighborBlock<D> {
    /// Number of neighbours, without what fills up the last group.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.length.min(BLOCK)
    }

    /// Slots and pairs of the four neighbours from the `first` on, a multiple of four.
    #[inline(always)]
    pub(super) fn four(&self, first: usize) -> ([u32; WIDTH], Moving<Lanes4, D>) {
        let quad = first / WIDTH % QUADS;
        let of = |numbers: &[f64; BLOCK]| Lanes4::load(numbers.as_chunks().0[quad]);
        let mut separation = [Lanes4::from(0.0); D];
        for (component, numbers) in separation.iter_mut().zip(&self.separations) {
            *component = of(numbers);
        }
        let pair = Moving {
            separation: SVector::from_array_storage(ArrayStorage([separation; 1])),
            square: of(&self.squares),
            value: of(&self.values),
            slope: of(&self.slopes),
        };
        (self.places.as_chunks().0[quad], pair)
    }

    /// Slot and pair of neighbour `k`.
    #[inline(always)]
    pub(super) fn one(&self, k: usize) -> (usize, Moving<f64, D>) {
        let pair = Moving {
            separation: Vector::from_fn(|axis, _| self.separations[axis][k]),
            square: self.squares[k],
            value: self.values[k],
            slope: self.slopes[k],
        };
        (self.places[k] as usize, pair)
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
