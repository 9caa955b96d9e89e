//! Neighbours of moving particles, gathered in blocks.

use multiversion::multiversion;
use piola_formulas::kernels::{Kernel, ManyDistances};

use super::{LANES, Lanes};
use crate::Vector;
use crate::neighbors::{Domain, NeighborError, SkinList};

/// Neighbours a block, a multiple of the lanes.
pub const BLOCK: usize = 64;

/// Some neighbours b of one particle a, all inside its support, in arrays over neighbours.
#[derive(Clone, Debug)]
pub struct NeighborBlock<const D: usize> {
    length: usize,
    places: [u32; BLOCK],
    separations: [[f64; BLOCK]; D],
    squares: [f64; BLOCK],
    values: [f64; BLOCK],
    slopes: [f64; BLOCK],
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
///
/// The last group is filled up with its last neighbour, and with values and slopes of zero.
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

    /// Fills the last group up with the last neighbour, and returns the length with it.
    #[inline]
    fn fill_up(&mut self) -> usize {
        let (length, whole) = (self.length, self.length.next_multiple_of(LANES));
        if let Some(last) = length.checked_sub(1) {
            let (place, square) = (self.places[last], self.squares[last]);
            self.places[length..whole].fill(place);
            self.squares[length..whole].fill(square);
            for separations in &mut self.separations {
                let separation = separations[last];
                separations[length..whole].fill(separation);
            }
        }
        whole
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
}

/// Those who may be neighbours of a particle and have not been looked at yet.
#[derive(Clone, Copy, Debug)]
pub struct Candidates<'a> {
    place: usize,
    row: &'a [u32],
    then: &'a [u32],
}

/// What of the kernel a sum needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Neither value nor slope, only who is there.
    Nothing,
    /// `W`.
    Value,
    /// `W' / r`.
    Slope,
    /// Both.
    Both,
}

/// The neighbours of moving particles that all have the same smoothing length.
///
/// A sum over neighbours runs over those inside the support at the positions taken last, in the
/// order of their numbers: it is the same to the bit, whenever the list behind it was made.
pub struct MovingSupport<const D: usize> {
    kernel: Kernel,
    smoothing_length: f64,
    many: Box<dyn ManyDistances>,
    limit: f64,
    /// Periods in m, infinite along open axes.
    periods: [f64; D],
    list: SkinList<D>,
}

impl<const D: usize> MovingSupport<D> {
    /// The share of the support radius that lists reach beyond it.
    pub const SKIN: f64 = 0.12;

    /// The neighbours of particles at `positions` in m, by number, for one smoothing length in m.
    /// Particles that are `passive` see only the others.
    ///
    /// # Errors
    /// When the search refuses the positions or the support.
    pub fn new(
        positions: &[Vector<D>],
        passive: Vec<bool>,
        kernel: Kernel,
        smoothing_length: f64,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let support = kernel.support_radius(smoothing_length);
        let list = SkinList::new(positions, passive, support, Self::SKIN * support, domain)?;
        let length = |ends: Option<[f64; 2]>| ends.map_or(f64::INFINITY, |[low, high]| high - low);
        Ok(Self {
            kernel,
            smoothing_length,
            many: kernel.many::<D>(smoothing_length),
            limit: support * support,
            periods: std::array::from_fn(|axis| length(domain.periodic()[axis])),
            list,
        })
    }

    /// Takes new positions in m by number.
    ///
    /// # Errors
    /// When the search refuses them; the neighbours then are as they were.
    pub fn update(
        &mut self,
        position: impl Fn(usize) -> Vector<D> + Sync,
    ) -> Result<(), NeighborError> {
        self.list.update(position)
    }

    /// Sets which particles are passive, and which have no neighbours and are none, by number, from
    /// the next update on.
    pub fn exclude(&mut self, passive: Vec<bool>, excluded: Vec<bool>) {
        self.list.exclude(passive, excluded);
    }

    /// The list behind it.
    pub fn list(&self) -> &SkinList<D> {
        &self.list
    }

    /// The kernel.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Smoothing length h in m.
    pub fn smoothing_length(&self) -> f64 {
        self.smoothing_length
    }

    /// `W(0)` in m^-D.
    pub fn centre(&self) -> f64 {
        self.kernel.value(D, 0.0, self.smoothing_length)
    }

    /// The neighbours of the particle at `place` that are not passive, before the first block.
    #[inline]
    pub fn active(&self, place: usize) -> Candidates<'_> {
        Candidates { place, row: self.list.active_row(place), then: &[] }
    }

    /// The passive neighbours of the particle at `place`, before the first block.
    #[inline]
    pub fn passive(&self, place: usize) -> Candidates<'_> {
        Candidates { place, row: self.list.passive_row(place), then: &[] }
    }

    /// All neighbours of the particle at `place`, the passive ones last, before the first block.
    #[inline]
    pub fn all(&self, place: usize) -> Candidates<'_> {
        let (row, then) = (self.list.active_row(place), self.list.passive_row(place));
        Candidates { place, row, then }
    }

    /// Fills `block` with the next neighbours of a particle; false when there is none left.
    #[inline]
    pub fn fill(
        &self,
        rest: &mut Candidates<'_>,
        needs: Needs,
        block: &mut NeighborBlock<D>,
    ) -> bool {
        let (positions, periods) = (self.list.positions(), &self.periods);
        block.length = 0;
        filter(positions, periods, self.limit, rest, block);
        if rest.row.is_empty() && !rest.then.is_empty() {
            rest.row = std::mem::take(&mut rest.then);
            filter(positions, periods, self.limit, rest, block);
        }
        let (length, whole) = (block.length, block.fill_up());
        let squares = &block.squares[..whole];
        let (values, slopes) = (&mut block.values[..whole], &mut block.slopes[..whole]);
        match needs {
            Needs::Nothing => (),
            Needs::Value => self.many.values(squares, values),
            Needs::Slope => self.many.slopes(squares, slopes),
            Needs::Both => self.many.both(squares, values, slopes),
        }
        values[length..].fill(0.0);
        slopes[length..].fill(0.0);
        length > 0
    }

    /// Bytes of lists and positions.
    pub fn memory(&self) -> usize {
        self.list.memory()
    }
}

/// Appends candidates whose distance has a square below `limit` to `block` until it is full.
#[multiversion(targets("x86_64+avx2"))]
fn filter<const D: usize>(
    positions: &[Vector<D>],
    periods: &[f64; D],
    limit: f64,
    rest: &mut Candidates<'_>,
    block: &mut NeighborBlock<D>,
) {
    let here = positions[rest.place];
    let mut length = block.length;
    let mut taken = 0;
    for &b in rest.row {
        if length == BLOCK {
            break;
        }
        // Every candidate is written and kept by the step of the counter, as a branch would be
        // guessed wrong every fifth time.
        let k = length % BLOCK;
        let there = &positions[b as usize];
        let mut square = 0.0;
        for axis in 0..D {
            let distance = shortest(here[axis] - there[axis], periods[axis]);
            block.separations[axis][k] = distance;
            square += distance * distance;
        }
        block.places[k] = b;
        block.squares[k] = square;
        length += usize::from(square < limit);
        taken += 1;
    }
    rest.row = &rest.row[taken..];
    block.length = length;
}

/// The shorter way between points inside a period, without a branch.
#[inline]
fn shortest(distance: f64, period: f64) -> f64 {
    let half = 0.5 * period;
    let down = if distance > half { distance - period } else { distance };
    if distance < -half { distance + period } else { down }
}
