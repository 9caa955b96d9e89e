//! Neighbours of moving particles, gathered in blocks.

use multiversion::multiversion;
use piola_formulas::kernels::{Kernel, ManyDistances, Needs};
use piola_formulas::pairs::{Moving, MovingPair};
use piola_formulas::{Lanes4, WIDTH};

use super::block::{BLOCK, NeighborBlock};
use super::frozen::RowSizes;
use super::gather::{Among, Pairs};
use super::inside::{InsideRows, Reach};
use crate::Vector;
use crate::neighbors::{Domain, NeighborError, SkinList};
use crate::parallel::Team;

/// Neighbours of a particle that have not been looked at yet.
#[derive(Clone, Copy, Debug)]
pub struct Remaining<'a> {
    place: usize,
    /// Whole groups, and how many there are before they are filled up.
    row: (&'a [u32], usize),
    then: (&'a [u32], usize),
}

/// The neighbours of moving particles that all have the same smoothing length.
///
/// A sum over neighbours runs over those inside the support at the positions taken last, in the
/// order of their numbers: it is the same to the bit, whenever the list behind it was made.
pub struct MovingSupport<const D: usize> {
    kernel: Kernel,
    smoothing_length: f64,
    many: Box<dyn ManyDistances>,
    reach: Reach<D>,
    list: SkinList<D>,
    inside: InsideRows,
    /// The unit vectors towards the side on which passive particles are seen, by number, and zero where
    /// they are on all; empty if there are none.
    sides: Vec<Vector<D>>,
    /// Whether the sides have changed since the rows were picked.
    is_turned: bool,
}

impl<const D: usize> MovingSupport<D> {
    /// The share of the support radius that lists reach beyond it.
    pub const SKIN: f64 = 0.2;

    /// The neighbours of particles at `positions` in m, by number, for one smoothing length in m.
    /// Particles that are `passive` see only the others.
    ///
    /// # Errors
    /// When the search refuses the positions or the support.
    #[inline(never)]
    pub fn new(
        positions: &[Vector<D>],
        passive: Vec<bool>,
        kernel: Kernel,
        smoothing_length: f64,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let support = kernel.support_radius(smoothing_length);
        let list = SkinList::new(positions, passive, support, Self::SKIN * support, domain)?;
        let reach = Reach {
            limit: support * support,
            periods: domain.periods(),
            // By the skin more than the support, so that rounding does not matter.
            within: domain.within((1.0 + Self::SKIN) * support),
        };
        let mut inside = InsideRows::default();
        inside.pick(&list, &reach);
        Ok(Self {
            kernel,
            smoothing_length,
            many: kernel.many::<D>(smoothing_length),
            reach,
            list,
            inside,
            sides: Vec::new(),
            is_turned: false,
        })
    }

    /// That of one of several ranks with `count` particles, which find their neighbours at the first update.
    pub(crate) fn part(&self, team: Team, count: usize) -> Self {
        let list = self.list.part(team, count);
        let mut inside = InsideRows::default();
        inside.pick(&list, &self.reach);
        Self {
            kernel: self.kernel,
            smoothing_length: self.smoothing_length,
            many: self.kernel.many::<D>(self.smoothing_length),
            reach: self.reach,
            list,
            inside,
            sides: self.sides.clone(),
            is_turned: false,
        }
    }

    /// Takes new positions in m by number.
    ///
    /// # Errors
    /// When the search refuses them; the neighbours then are as they were.
    pub fn update(
        &mut self,
        position: impl Fn(usize) -> Vector<D> + Sync,
    ) -> Result<(), NeighborError> {
        self.update_with(&mut vec![(); self.list.owned()], |number, ()| position(number))
    }

    /// Takes new positions in m: `take(number, row)` is that of a particle, and fills the row at its
    /// place, too.
    ///
    /// # Errors
    /// When the search refuses them; the neighbours then are as they were.
    pub fn update_with<T: Send>(
        &mut self,
        rows: &mut [T],
        take: impl Fn(usize, &mut T) -> Vector<D> + Sync,
    ) -> Result<(), NeighborError> {
        if self.list.update(rows, take)? || self.is_turned {
            self.inside.pick(&self.list, &self.reach);
            self.part_sides();
            self.is_turned = false;
        }
        Ok(())
    }

    /// Lets a passive particle (number) be seen, from the next update on, only by those that `side` points
    /// to from where it is, a vector of any length; by all if it is zero.
    pub fn show_on(&mut self, number: u32, side: Vector<D>) {
        self.sides.resize(self.list.all_count(), Vector::zeros());
        let known = &mut self.sides[number as usize];
        self.is_turned |= *known != side;
        *known = side;
    }

    /// Takes out the pairs that do not see each other.
    fn part_sides(&mut self) {
        if self.sides.is_empty() {
            return;
        }
        let (list, sides) = (&self.list, &self.sides);
        let side = |place: usize| &sides[list.numbers()[place] as usize];
        let zero = Vector::<D>::zeros();
        let sees = |active: usize, passive: usize| {
            let (from, to) = (&list.positions()[passive], &list.positions()[active]);
            list.domain().separation(from, to).dot(side(passive)) >= 0.0
        };
        self.inside.retain(list, |place| *side(place) != zero, sees);
    }

    /// Sets which particles are passive, and which have no neighbours and are none, by number, from
    /// the next update on.
    pub fn exclude(&mut self, passive: &[bool], excluded: &[bool]) {
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

    /// The places of the neighbours of the particle at `place`: those that are not passive, and the
    /// passive ones.
    #[inline]
    pub fn places_of(&self, place: usize) -> [&[u32]; 2] {
        [self.inside.active(place), self.inside.passive(place)]
            .map(|(places, count)| &places[..count])
    }

    /// How large the rows of neighbours of some particles, by place, are.
    pub fn sizes(&self, is_counted: impl Fn(usize) -> bool) -> RowSizes {
        self.inside.sizes(is_counted)
    }

    /// How large the lists are of which the neighbours are picked at each new position.
    pub fn candidates(&self) -> RowSizes {
        let (rows, entries) = (self.list.owned(), self.list.entries());
        RowSizes { rows, entries, bytes: rows * size_of::<usize>() + entries * size_of::<u32>() }
    }

    /// Bytes of lists and positions.
    pub fn memory(&self) -> usize {
        self.list.memory() + self.inside.memory()
    }
}

impl<const D: usize> Pairs for MovingSupport<D> {
    type Pair = MovingPair<D>;
    type Row<'a> = Remaining<'a>;
    type Block = NeighborBlock<D>;

    #[inline]
    fn row(&self, place: usize, among: Among) -> Remaining<'_> {
        let (row, then) = match among {
            Among::Active => (self.inside.active(place), (&[][..], 0)),
            Among::Passive => (self.inside.passive(place), (&[][..], 0)),
            Among::All => (self.inside.active(place), self.inside.passive(place)),
        };
        Remaining { place, row, then }
    }

    #[inline]
    fn next(&self, rest: &mut Remaining<'_>, needs: Needs, block: &mut NeighborBlock<D>) -> usize {
        if rest.row.0.is_empty() {
            rest.row = std::mem::take(&mut rest.then);
        }
        let (places, length) = rest.row;
        if places.is_empty() {
            return 0;
        }
        let (places, left) = places.split_at(places.len().min(BLOCK));
        rest.row = (left, length.saturating_sub(BLOCK));
        let next = (places, length.min(BLOCK));
        separate(&self.reach, self.list.positions(), rest.place, next, block);
        let whole = places.len();
        let squares = &block.squares[..whole];
        let (values, slopes) = (&mut block.values[..whole], &mut block.slopes[..whole]);
        match needs {
            Needs::Nothing => (),
            Needs::Value => self.many.values(squares, values),
            Needs::Slope => self.many.slopes(squares, slopes),
            Needs::Both => self.many.both(squares, values, slopes),
        }
        block.len()
    }

    #[inline(always)]
    fn four(&self, block: &NeighborBlock<D>, first: usize) -> ([u32; WIDTH], Moving<Lanes4, D>) {
        block.four(first)
    }

    #[inline(always)]
    fn one(&self, block: &NeighborBlock<D>, k: usize) -> (usize, Moving<f64, D>) {
        block.one(k)
    }
}

/// Fills `block` with the separations of some neighbours.
#[multiversion(targets("x86_64+avx2+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn separate<const D: usize>(
    reach: &Reach<D>,
    positions: &[Vector<D>],
    place: usize,
    neighbors: (&[u32], usize),
    block: &mut NeighborBlock<D>,
) {
    let here = &positions[place];
    match reach.wraps(here) {
        true => block.take::<true>(here, neighbors, positions, reach),
        false => block.take::<false>(here, neighbors, positions, reach),
    }
}

#[cfg(test)]
mod tests;
