//! The loop over neighbours.
//!
//! [`gather`] sums a [`PairLaw`] over the neighbours of many particles, [`add_at`] over those of one, and
//! [`visit`] shows them one by one to what is no sum. All of them see neighbours in the order of the rows
//! of their [`Pairs`], in groups of eight.
//!
//! Eight lanes sum up side by side, neighbour k in lane k mod 8; the lanes are added up by halves. The
//! order of sums is the same on every machine and for every number of threads. Registers hold half of
//! the lanes: a block of neighbours is gone through twice, but for few sums of what is streamed from memory.

use std::ops::Range;

use multiversion::multiversion;
use piola_formulas::kernels::Needs;
use piola_formulas::pairs::{Of, One, PairLaw, Record};
use piola_formulas::{Lanes, Lanes4, Number, WIDTH};

use super::LANES;
use crate::parallel::{self, Parts, Sums, Team};

/// Which neighbours of a particle a sum runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Among {
    /// Those that are not passive.
    Active,
    /// Those that are.
    Passive,
    /// All of them, the passive ones last.
    All,
}

/// Who meets whom, and what is known of each pair.
pub trait Pairs: Sync {
    /// What is known of a pair.
    type Pair: Record;
    /// Neighbours that have not been looked at yet.
    type Row<'a>
    where
        Self: 'a;
    /// Scratch for some neighbours of one particle.
    type Block: Default;
    /// Whether what is known of pairs comes from memory, in the order of neighbours, and not from the scratch.
    const IS_STREAMED: bool = false;

    /// The neighbours of the particle in a slot.
    fn row(&self, slot: usize, among: Among) -> Self::Row<'_>;

    /// Fills `block` with the next neighbours of a row and returns how many they are; zero at its end.
    fn next(&self, row: &mut Self::Row<'_>, needs: Needs, block: &mut Self::Block) -> usize;

    /// Slots and pairs of the neighbours of a block from the `first` on, a multiple of four. What fills
    /// up the last eight has a pair with which laws add nothing.
    fn four(&self, block: &Self::Block, first: usize) -> ([u32; WIDTH], Of<Self::Pair, Lanes4>);

    /// Slot and pair of neighbour `k` of a block.
    fn one(&self, block: &Self::Block, k: usize) -> (usize, Of<Self::Pair, f64>);
}

/// Where the sides of neighbours are read.
pub trait Source<R: Record>: Sync {
    /// The side of a particle in the middle of its sums.
    fn own(&self, slot: usize) -> Of<R, f64>;

    /// The side of a neighbour `other` of the particle in `slot`.
    fn one(&self, slot: usize, other: usize) -> Of<R, f64>;

    /// The sides of four neighbours.
    fn four(&self, slot: usize, others: &[u32; WIDTH]) -> Of<R, Lanes4>;
}

impl<R: Record> Source<R> for [Of<R, f64>]
where
    Of<R, f64>: Sync,
{
    #[inline(always)]
    fn own(&self, slot: usize) -> Of<R, f64> {
        self[slot]
    }

    #[inline(always)]
    fn one(&self, _slot: usize, other: usize) -> Of<R, f64> {
        self[other]
    }

    #[inline(always)]
    fn four(&self, _slot: usize, [a, b, c, d]: &[u32; WIDTH]) -> Of<R, Lanes4> {
        let at = |slot: &u32| &self[*slot as usize];
        R::map([at(a), at(b), at(c), at(d)], &Lanes4::load)
    }
}

impl<R: Record, S: Source<R> + ?Sized> Source<R> for &S {
    #[inline(always)]
    fn own(&self, slot: usize) -> Of<R, f64> {
        (**self).own(slot)
    }

    #[inline(always)]
    fn one(&self, slot: usize, other: usize) -> Of<R, f64> {
        (**self).one(slot, other)
    }

    #[inline(always)]
    fn four(&self, slot: usize, others: &[u32; WIDTH]) -> Of<R, Lanes4> {
        (**self).four(slot, others)
    }
}

impl<R: Record, Q: Record, A: Source<R>, B: Source<Q>> Source<(R, Q)> for (A, B) {
    #[inline(always)]
    fn own(&self, slot: usize) -> Of<(R, Q), f64> {
        (self.0.own(slot), self.1.own(slot))
    }

    #[inline(always)]
    fn one(&self, slot: usize, other: usize) -> Of<(R, Q), f64> {
        (self.0.one(slot, other), self.1.one(slot, other))
    }

    #[inline(always)]
    fn four(&self, slot: usize, others: &[u32; WIDTH]) -> Of<(R, Q), Lanes4> {
        (self.0.four(slot, others), self.1.four(slot, others))
    }
}

/// The same number for all neighbours.
#[derive(Clone, Copy, Debug)]
pub struct Same(pub f64);

impl Source<One> for Same {
    #[inline(always)]
    fn own(&self, _slot: usize) -> f64 {
        self.0
    }

    #[inline(always)]
    fn one(&self, _slot: usize, _other: usize) -> f64 {
        self.0
    }

    #[inline(always)]
    fn four(&self, _slot: usize, _others: &[u32; WIDTH]) -> Lanes4 {
        Lanes4::from(self.0)
    }
}

/// What is read of the particle in the middle alone, by a function of its slot. Neighbours show zeros.
pub struct OfCenter<F>(pub F);

impl<R: Record, F: Fn(usize) -> Of<R, f64> + Sync> Source<R> for OfCenter<F> {
    #[inline(always)]
    fn own(&self, slot: usize) -> Of<R, f64> {
        (self.0)(slot)
    }

    #[inline(always)]
    fn one(&self, _slot: usize, _other: usize) -> Of<R, f64> {
        R::zero()
    }

    #[inline(always)]
    fn four(&self, _slot: usize, _others: &[u32; WIDTH]) -> Of<R, Lanes4> {
        R::zero()
    }
}

/// What is read of neighbours alone, by a function of their slots. The particle in the middle shows zeros.
pub struct OfOther<F>(pub F);

impl<R: Record, F: Fn(usize) -> Of<R, f64> + Sync> Source<R> for OfOther<F> {
    #[inline(always)]
    fn own(&self, _slot: usize) -> Of<R, f64> {
        R::zero()
    }

    #[inline(always)]
    fn one(&self, _slot: usize, other: usize) -> Of<R, f64> {
        (self.0)(other)
    }

    #[inline(always)]
    fn four(&self, _slot: usize, others: &[u32; WIDTH]) -> Of<R, Lanes4> {
        let [a, b, c, d] = *others;
        let at = |other: u32| (self.0)(other as usize);
        let (a, b, c, d) = (at(a), at(b), at(c), at(d));
        R::map([&a, &b, &c, &d], &Lanes4::load)
    }
}

/// A law, where it reads sides, and the neighbours that it is summed over.
#[derive(Clone, Copy, Debug)]
pub struct Term<L, S> {
    /// What a particle gets from a neighbour.
    pub law: L,
    /// The sides.
    pub source: S,
    /// The neighbours.
    pub among: Among,
}

impl<L: PairLaw, S: Source<L::Side>> Term<L, S> {
    /// Adds what `me`, the particle in `slot`, gets from four neighbours of a block from the `first` on.
    #[inline(always)]
    fn add_four<P: Pairs<Pair = L::Pair>>(
        &self,
        (pairs, block): (&P, &P::Block),
        slot: usize,
        first: usize,
        me: &Of<L::Side, Lanes4>,
        sum: &mut Of<L::Sums, Lanes4>,
    ) {
        let (others, pair) = pairs.four(block, first);
        self.law.add(me, &self.source.four(slot, &others), &pair, sum);
    }
}

/// Sums of which registers hold all eight lanes, so that what is streamed is read once and evenly.
const SIDE_BY_SIDE: usize = 4;

/// Lanes of all sums, the lower half and the upper one.
type Halves<R> = [Of<R, Lanes4>; 2];

/// What a particle sums over its neighbours: a [`Term`], or two with the same sums.
pub trait Sum<P: Pairs>: Sync {
    /// The sums.
    type Sums: Record;

    /// Adds to the lanes of the sums of a particle, which are given and returned by value: as no pointer
    /// to them leaves the loop, the compiler sees that they are apart from what it reads.
    fn lanes(
        &self,
        pairs: &P,
        slot: usize,
        block: &mut P::Block,
        sums: Halves<Self::Sums>,
    ) -> Halves<Self::Sums>;

    /// Adds neighbour after neighbour.
    fn single(&self, pairs: &P, slot: usize, block: &mut P::Block, sums: &mut Of<Self::Sums, f64>);
}

impl<P: Pairs, L: PairLaw<Pair = P::Pair>, S: Source<L::Side>> Sum<P> for Term<L, S> {
    type Sums = L::Sums;

    #[inline(always)]
    fn lanes(
        &self,
        pairs: &P,
        slot: usize,
        block: &mut P::Block,
        mut sums: Halves<L::Sums>,
    ) -> Halves<L::Sums> {
        let mut row = pairs.row(slot, self.among);
        let mut count = pairs.next(&mut row, L::NEEDS, block);
        if count == 0 {
            return sums;
        }
        let own = self.source.own(slot);
        let me = L::Side::map([&own], &|[x]: [f64; 1]| Lanes4::from(x));
        while count > 0 {
            // An upper half without a true neighbour adds nothing.
            if P::IS_STREAMED && L::Sums::NUMBERS <= SIDE_BY_SIDE {
                let [mut own, mut other] = sums;
                for first in (0..count).step_by(WIDTH) {
                    self.add_four((pairs, block), slot, first, &me, &mut own);
                    (own, other) = (other, own);
                }
                sums = if count.div_ceil(WIDTH) % 2 == 0 { [own, other] } else { [other, own] };
            } else {
                for (half, kept) in sums.iter_mut().enumerate() {
                    let mut sum = *kept;
                    for first in (half * WIDTH..count).step_by(LANES) {
                        self.add_four((pairs, block), slot, first, &me, &mut sum);
                    }
                    *kept = sum;
                }
            }
            count = pairs.next(&mut row, L::NEEDS, block);
        }
        sums
    }

    #[inline(always)]
    fn single(&self, pairs: &P, slot: usize, block: &mut P::Block, sums: &mut Of<L::Sums, f64>) {
        let me = self.source.own(slot);
        visit(pairs, slot, self.among, L::NEEDS, block, |other, pair| {
            self.law.add(&me, &self.source.one(slot, other), pair, sums);
        });
    }
}

impl<P: Pairs, A: Sum<P>, B: Sum<P, Sums = A::Sums>> Sum<P> for (A, B) {
    type Sums = A::Sums;

    #[inline(always)]
    fn lanes(
        &self,
        pairs: &P,
        slot: usize,
        block: &mut P::Block,
        sums: Halves<A::Sums>,
    ) -> Halves<A::Sums> {
        let sums = self.0.lanes(pairs, slot, block, sums);
        self.1.lanes(pairs, slot, block, sums)
    }

    #[inline(always)]
    fn single(&self, pairs: &P, slot: usize, block: &mut P::Block, sums: &mut Of<A::Sums, f64>) {
        self.0.single(pairs, slot, block, sums);
        self.1.single(pairs, slot, block, sums);
    }
}

/// Sums over the neighbours of many particles, in vector registers and on all threads.
///
/// Row `k` of `out` belongs to the particle in the slot `slot(k)`, or to none, and then stays as it is.
/// `close` turns its sums into the row.
pub fn gather<P: Pairs, M: Sum<P>, O: Send>(
    pairs: &P,
    sum: &M,
    out: &mut [O],
    slot: impl Fn(usize) -> Option<usize> + Sync,
    close: impl Fn(usize, &Of<M::Sums, f64>, &mut O) + Sync,
) {
    parallel::for_each_chunk(out, |first, out| {
        rows(pairs, sum, first..first + out.len(), &slot, &mut |slot, k, sums| {
            close(slot, sums, &mut out[k]);
        });
    });
}

/// As [`gather`], of the first `count` slots, for arrays beside each other and with totals of all
/// particles of a team: `close([slot, k], sums, out, totals)` fills in row `k` of the part `out`, and
/// `finish(slots, out)` goes over the rows of a part that are filled.
pub fn gather_parts<P: Pairs, M: Sum<P>, O: Parts, T: Sums>(
    team: &Team,
    (pairs, sum): (&P, &M),
    (count, out): (usize, O),
    close: impl Fn([usize; 2], &Of<M::Sums, f64>, &mut O, &mut T) + Sync,
    finish: impl Fn(Range<usize>, &mut O) + Sync,
) -> T {
    let chunk = team.chunk(count);
    team.sums_over_parts(count, out, |first, mut out, totals| {
        let slots = first..(first + chunk).min(count);
        rows(pairs, sum, slots.clone(), &Some, &mut |slot, k, sums| {
            close([slot, k], sums, &mut out, totals);
        });
        finish(slots, &mut out);
    })
}

#[multiversion(targets("x86_64+avx2"))]
fn rows<P: Pairs, M: Sum<P>>(
    pairs: &P,
    sum: &M,
    range: Range<usize>,
    slot: &impl Fn(usize) -> Option<usize>,
    close: &mut impl FnMut(usize, usize, &Of<M::Sums, f64>),
) {
    let mut block = P::Block::default();
    for (k, row) in range.enumerate() {
        if let Some(slot) = slot(row) {
            let zero = [M::Sums::zero(), M::Sums::zero()];
            let [lower, upper] = sum.lanes(pairs, slot, &mut block, zero);
            let total = M::Sums::map([&lower, &upper], &|[lower, upper]: [Lanes4; 2]| {
                let [a, b, c, d] = (lower + upper).store();
                (a + c) + (b + d)
            });
            close(slot, k, &total);
        }
    }
}

/// Adds the neighbours of the particle in one slot to its sums, one after the other.
pub fn add_at<P: Pairs, M: Sum<P>>(
    pairs: &P,
    sum: &M,
    slot: usize,
    block: &mut P::Block,
    sums: &mut Of<M::Sums, f64>,
) {
    sum.single(pairs, slot, block, sums);
}

/// What a law sums over all neighbours of the particle in one slot, in numbers of any type, one after the
/// other: `show` has the sides.
pub fn sum_at<T: Number, P: Pairs, L: PairLaw<Pair = P::Pair>>(
    pairs: &P,
    law: &L,
    slot: usize,
    show: impl Fn(usize) -> Of<L::Side, T>,
) -> Of<L::Sums, T> {
    let (me, mut sums) = (show(slot), L::Sums::zero());
    visit(pairs, slot, Among::All, L::NEEDS, &mut P::Block::default(), |other, pair| {
        let pair = P::Pair::map([pair], &|[x]: [f64; 1]| T::from(x));
        law.add(&me, &show(other), &pair, &mut sums);
    });
    sums
}

/// Shows the neighbours of the particle in one slot, one after the other.
pub fn visit<P: Pairs>(
    pairs: &P,
    slot: usize,
    among: Among,
    needs: Needs,
    block: &mut P::Block,
    mut look: impl FnMut(usize, &Of<P::Pair, f64>),
) {
    let mut row = pairs.row(slot, among);
    loop {
        let count = pairs.next(&mut row, needs, block);
        if count == 0 {
            return;
        }
        for k in 0..count {
            let (other, pair) = pairs.one(block, k);
            look(other, &pair);
        }
    }
}
