//! Pair laws: what a particle gets from one neighbour.
//!
//! A law is a small value with the constants of a pass. It says what neighbours show ([`PairLaw::Side`]),
//! what is known of a pair ([`PairLaw::Pair`]), what is summed ([`PairLaw::Sums`]), and adds the terms of
//! one neighbour. It is generic over [`Number`], so that the same body sums plain numbers, four at once
//! ([`Lanes4`](crate::Lanes4)), derivatives, or text for a device. The loops over neighbours are not here.

pub mod corrected;
pub mod fit;
pub mod fluid;
mod record;
pub mod solid;
pub mod sums;
pub mod total_lagrangian;
pub mod upwind;
pub mod wall;

pub use record::{Components, Each, Many, Of, One, Record, Square};

use crate::Number;
use crate::kernels::Needs;
use record::record;

record! {
    /// A pair of moving particles.
    pub struct Moving<D> in MovingPair {
        /// `r_ab = x_a - x_b` in m.
        pub separation: Components<D>,
        /// `r_ab^2` in m^2.
        pub square: One,
        /// `W_ab` in m^-D, if the law [needs](PairLaw::NEEDS) it.
        pub value: One,
        /// `W'_ab / r_ab` in m^-(D+2), if the law needs it: the gradient `grad_a W_ab` is this times
        /// the separation.
        pub slope: One,
    }
}

record! {
    /// The areas through which two particles act on each other.
    pub struct Areas<D> in AreaPair {
        /// `V_a G_ab` in m^(D-1).
        pub area: Components<D>,
        /// `V_b G_ba` in m^(D-1).
        pub transposed: Components<D>,
    }
}

/// What is known of a pair of a frozen list, and 1, or 0 for what fills up the last lanes, where all is zero.
pub type Frozen<R> = (R, One);

/// How far it is round a periodic box, along each axis in m; nothing where no axis is periodic.
#[derive(Clone, Copy, Debug)]
pub struct Periods<const D: usize>(Option<[f64; D]>);

impl<const D: usize> Periods<D> {
    /// Those of a box, infinite along open axes.
    pub fn new(periods: [f64; D]) -> Self {
        Self(periods.iter().any(|period| period.is_finite()).then_some(periods))
    }

    /// From one point to another, the shortest way round.
    #[inline(always)]
    pub(crate) fn way<T: Number>(
        &self,
        from: &nalgebra::SVector<T, D>,
        to: &nalgebra::SVector<T, D>,
    ) -> nalgebra::SVector<T, D> {
        let mut way = difference(to, from);
        if let Some(periods) = self.0 {
            for i in 0..D {
                let (distance, period) = (way[i], periods[i]);
                let down = T::select(distance.above(0.5 * period), distance - period, distance);
                way[i] = T::select(distance.below(-0.5 * period), distance + period, down);
            }
        }
        way
    }
}

/// What a particle gets from one neighbour.
///
/// All methods of a law, and what they call, are marked `#[inline(always)]`: what is left a function is
/// compiled without the vector instructions of the loop around it, and takes twice as long.
pub trait PairLaw: Sync {
    /// What is known of a pair.
    type Pair: Record;
    /// What a particle shows its neighbours.
    type Side: Record;
    /// What is summed over neighbours.
    type Sums: Record;

    /// What of the kernel the law reads.
    const NEEDS: Needs;

    /// Adds the terms of a neighbour `other` of the particle `me`. What depends on `me` alone the compiler
    /// takes out of the loop.
    fn add<T: Number>(
        &self,
        me: &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<Self::Pair, T>,
        sums: &mut Of<Self::Sums, T>,
    );
}

/// `a . b`.
#[inline(always)]
pub(crate) fn dot<T: Number, const D: usize>(
    a: &nalgebra::SVector<T, D>,
    b: &nalgebra::SVector<T, D>,
) -> T {
    let mut sum = a[0] * b[0];
    for i in 1..D {
        sum += a[i] * b[i];
    }
    sum
}

/// `a - b`.
#[inline(always)]
pub(crate) fn difference<T: Number, const D: usize>(
    a: &nalgebra::SVector<T, D>,
    b: &nalgebra::SVector<T, D>,
) -> nalgebra::SVector<T, D> {
    let mut difference = *a;
    for i in 0..D {
        difference[i] -= b[i];
    }
    difference
}

/// `matrix vector`.
#[inline(always)]
pub(crate) fn applied<T: Number, const D: usize>(
    matrix: &nalgebra::SMatrix<T, D, D>,
    vector: &nalgebra::SVector<T, D>,
) -> nalgebra::SVector<T, D> {
    let mut product = Components::<D>::zero();
    for i in 0..D {
        let mut sum = matrix[(i, 0)] * vector[0];
        for j in 1..D {
            sum += matrix[(i, j)] * vector[j];
        }
        product[i] = sum;
    }
    product
}

/// Takes an area in m^(D-2) times `r_ab (x) r_ab` from the entries with `i <= j` of a moment.
#[inline(always)]
pub(crate) fn add_moment<T: Number, const D: usize>(
    pair: &Of<MovingPair<D>, T>,
    area: T,
    moment: &mut nalgebra::SMatrix<T, D, D>,
) {
    for i in 0..D {
        let arm = pair.separation[i] * area;
        for j in i..D {
            moment[(i, j)] -= arm * pair.separation[j];
        }
    }
}

/// The symmetric matrix of which the entries with `i <= j` are filled.
#[inline]
pub(crate) fn symmetric<T: Number, const D: usize>(
    upper: &nalgebra::SMatrix<T, D, D>,
) -> nalgebra::SMatrix<T, D, D> {
    nalgebra::SMatrix::from_fn(|i, j| upper[(i.min(j), i.max(j))])
}
