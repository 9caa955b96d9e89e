//! Pair laws: what a particle gets from one neighbour.
//!
//! A law is a small value with the constants of a pass. It says what neighbours show ([`PairLaw::Side`]),
//! what is known of a pair ([`PairLaw::Pair`]), what is summed ([`PairLaw::Sums`]), and adds the terms of
//! one neighbour. It is generic over [`Number`], so that the same body sums plain numbers, four at once
//! ([`Lanes4`](crate::Lanes4)), derivatives, or text for a device. The loops over neighbours are not here.

pub mod fluid;
mod record;
pub mod solid;
pub mod sums;
pub mod upwind;
pub mod wall;

pub use record::{Components, Many, Of, One, Record, Square};

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
    /// A pair of a frozen list.
    pub struct Frozen<D> in FrozenPair {
        /// Area `V_a G_ab` in m^(D-1).
        pub area: Components<D>,
        /// Area `V_b G_ba` in m^(D-1).
        pub transposed: Components<D>,
        /// 1, or 0 for what fills up the last lanes, where areas are zero, too.
        pub counts: One,
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
