//! The sums of a particle over its neighbours, a block of them at a time.

use piola_formulas::Scalar;

use super::Upwind;
use super::local::Side;
use super::pair::Pair;
use super::reconstruction::Slope;
use crate::Vector;
use crate::operators::{Block, LANES, Lanes, total};

/// The sums of a particle over its neighbours: `T` is a number, or an array of them while they grow.
pub(super) struct Sums<T, const D: usize> {
    /// Internal force in N, without the particle's own share.
    pub internal_force: [T; D],
    /// Rate of the deformation gradient times the volume, in m^D/s.
    pub volume_deformation_rate: [[T; D]; D],
    /// Force of the full velocity dissipation in N.
    pub upwind_force: [T; D],
    /// Volume rate of the full pressure dissipation in m^D/s.
    pub upwind_volume_rate: T,
}

impl<const D: usize> Upwind<D> {
    /// The sums over neighbours of theory (8) to (10), without b = a in the first.
    ///
    /// Returned by value: as no pointer to them leaves the loop, the compiler sees that they are
    /// apart from what it reads.
    #[inline(always)]
    pub(super) fn gather<const VELOCITY: bool, const PRESSURE: bool, const RECONSTRUCTION: bool>(
        &self,
        a: usize,
    ) -> Sums<Lanes, D> {
        let mut sums = Sums::zero();
        for block in self.areas.row(a) {
            self.add_block::<VELOCITY, PRESSURE, RECONSTRUCTION>(a, block, &mut sums);
        }
        sums
    }

    /// Adds the terms of the neighbours of a block, each to its lane.
    #[inline(always)]
    fn add_block<const VELOCITY: bool, const PRESSURE: bool, const RECONSTRUCTION: bool>(
        &self,
        a: usize,
        block: &Block<D>,
        sums: &mut Sums<Lanes, D>,
    ) {
        let me = &self.sides[a];
        let others = block.neighbors.map(|b| &self.sides[b as usize]);
        let mut slopes = [[&Slope::<f64, D>::ZERO; 2]; LANES];
        if RECONSTRUCTION {
            slopes = block.neighbors.map(|b| [&self.slopes[a], &self.slopes[b as usize]]);
        }
        let mut current = [[0.0; LANES]; D];
        let mut reference = [[0.0; LANES]; D];
        if VELOCITY || PRESSURE {
            self.separate(me, &others, |side| &side.position, &mut current);
            self.separate(me, &others, |side| &side.reference, &mut reference);
        }
        for lane in 0..LANES {
            let pair = Pair {
                me,
                other: others[lane],
                area: at(&block.forward, lane),
                transposed: at(&block.adjoint, lane),
                current: at(&current, lane),
                reference: at(&reference, lane),
                slopes: slopes[lane],
            };
            pair.add_terms::<VELOCITY, PRESSURE, RECONSTRUCTION, LANES>(lane, sums);
        }
    }

    /// From a point of mine to that of each of the others, the shortest way round in a periodic
    /// box. Written in place: a copy of what was just stored would wait for it.
    #[inline(always)]
    pub(super) fn separate(
        &self,
        me: &Side<f64, D>,
        others: &[&Side<f64, D>; LANES],
        point: impl Fn(&Side<f64, D>) -> &Vector<D>,
        separations: &mut [Lanes; D],
    ) {
        #[expect(
            clippy::needless_range_loop,
            reason = "with iterators a pair takes 1.15 to 1.25 times as long in 2D: the compiler \
                      stores what it keeps in registers here"
        )]
        for i in 0..D {
            for lane in 0..LANES {
                separations[i][lane] = point(others[lane])[i] - point(me)[i];
            }
        }
        self.support.domain.shorten(separations);
    }
}

/// The vector of one lane.
#[inline(always)]
pub(super) fn at<const D: usize>(lanes: &[Lanes; D], lane: usize) -> Vector<D> {
    Vector::from_fn(|i, _| lanes[i][lane])
}

impl<T: Scalar, const N: usize, const D: usize> Sums<[T; N], D> {
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = [T::zero(); N];
        Self {
            internal_force: [zero; D],
            volume_deformation_rate: [[zero; D]; D],
            upwind_force: [zero; D],
            upwind_volume_rate: zero,
        }
    }
}

impl<const D: usize> Sums<Lanes, D> {
    /// The sums over all lanes. Not inlined: what follows is work on single numbers, and mixed
    /// with it the compiler takes the lanes apart in the loop, too.
    #[inline(never)]
    pub fn total(&self) -> Sums<f64, D> {
        Sums {
            internal_force: self.internal_force.map(total),
            volume_deformation_rate: self.volume_deformation_rate.map(|row| row.map(total)),
            upwind_force: self.upwind_force.map(total),
            upwind_volume_rate: total(self.upwind_volume_rate),
        }
    }
}
