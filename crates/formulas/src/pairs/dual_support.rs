//! Pair laws of the dual-support formulation, on frozen lists. Paper: Dual-support.

use nalgebra::SVector;

use super::{Components, Frozen, Of, One, PairLaw, Periods, Square, applied, difference, record};
use crate::Number;
use crate::kernels::Needs;

record! {
    /// What a particle takes from one in its support.
    pub struct Supported<D> in SupportedPair {
        /// `G_ab` in 1/m.
        pub gradient: Components<D>,
        /// `s_ab / tr L_a` in 1/m^2.
        pub weight: One,
    }
}

record! {
    /// What the support of a particle says of it.
    #[repr(align(64))]
    pub struct Side<D> in SupportSide {
        /// Displacement gradient A = F - I.
        pub gradient: Square<D>,
        /// Derivative of the particle's energy with respect to A, J: theory (48).
        pub tension: Square<D>,
        /// Force on the particle from its own support in N.
        pub pull: Components<D>,
        /// Displacement u in m.
        pub displacement: Components<D>,
        /// Reference position X in m.
        pub reference: Components<D>,
        /// `2 c_ab tr L_a / s_ab` in J.
        pub hourglass: One,
    }
}

record! {
    /// What [`Supports`] sums of the differences `u_ab = u_b - u_a`.
    pub struct SupportSums<D> in SupportSum {
        /// The displacement gradient `sum_b u_ab (x) G_ab`.
        pub gradient: Square<D>,
        /// `sum_b w_ab u_ab (x) X_ab`.
        pub moment: Square<D>,
        /// `sum_b w_ab u_ab` in 1/m.
        pub difference: Components<D>,
    }
}

/// The sums over the support of a particle, theory (44) and (48), of displacements and reference
/// positions; those of the weights with `HOURGLASS` alone.
#[derive(Clone, Copy, Debug)]
pub struct Supports<const D: usize, const HOURGLASS: bool>(pub Periods<D>);

impl<const D: usize, const HOURGLASS: bool> PairLaw for Supports<D, HOURGLASS> {
    type Pair = Frozen<SupportedPair<D>>;
    type Side = (Components<D>, Components<D>);
    type Sums = SupportSum<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, my_place): &Of<Self::Side, T>,
        (other, place): &Of<Self::Side, T>,
        (pair, _): &Of<Self::Pair, T>,
        sums: &mut SupportSums<T, D>,
    ) {
        let jump = difference(other, me);
        for j in 0..D {
            for i in 0..D {
                sums.gradient[(i, j)] += jump[i] * pair.gradient[j];
            }
        }
        if HOURGLASS {
            let separation = self.0.way(my_place, place);
            for i in 0..D {
                let weighted = jump[i] * pair.weight;
                sums.difference[i] += weighted;
                for j in 0..D {
                    sums.moment[(i, j)] += weighted * separation[j];
                }
            }
        }
    }
}

/// The forces in N that those take back in whose support a particle is, theory (49): its dual support.
#[derive(Clone, Copy, Debug)]
pub struct Reactions<const D: usize, const HOURGLASS: bool>(pub Periods<D>);

impl<const D: usize, const HOURGLASS: bool> PairLaw for Reactions<D, HOURGLASS> {
    /// As the other particle has it.
    type Pair = Frozen<SupportedPair<D>>;
    type Side = SupportSide<D>;
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &Side<T, D>,
        other: &Side<T, D>,
        (pair, _): &Of<Self::Pair, T>,
        force: &mut SVector<T, D>,
    ) {
        let taken = applied(&other.tension, &pair.gradient);
        for i in 0..D {
            force[i] -= taken[i];
        }
        if HOURGLASS {
            let separation = self.0.way(&other.reference, &me.reference);
            let linear = applied(&other.gradient, &separation);
            let jump = difference(&me.displacement, &other.displacement);
            let weight = other.hourglass * pair.weight;
            for i in 0..D {
                force[i] += (linear[i] - jump[i]) * weight;
            }
        }
    }
}
