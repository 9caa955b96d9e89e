//! What ghost particles of walls take from the particles around them. Paper: CTVF, section 2.4.

use super::fluid::FluidSide;
use super::solid::MATTER;
use super::{Components, Many, MovingPair, Of, One, PairLaw, record};
use crate::Number;
use crate::kernels::Needs;

record! {
    /// Sums of what is around a wall particle, weighted with the kernel.
    pub struct Around<D> in Surroundings {
        /// `sum W_ab` in m^-D.
        pub weight: One,
        /// `sum u_b W_ab`.
        pub velocity: Components<D>,
        /// `sum d_b W_ab`.
        pub deviation: Components<D>,
        /// `sum p_b W_ab`.
        pub pressure: One,
        /// `sum rho_b r_ab W_ab`.
        pub arm: Components<D>,
    }
}

/// The sums of CTVF (46), (47) and (52).
#[derive(Clone, Copy, Debug)]
pub struct Extrapolation<const D: usize>;

impl<const D: usize> PairLaw for Extrapolation<D> {
    type Pair = MovingPair<D>;
    type Side = FluidSide<D>;
    type Sums = Surroundings<D>;

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        _me: &Of<Self::Side, T>,
        other: &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        sums: &mut Around<T, D>,
    ) {
        let weight = other.density * pair.value;
        sums.weight += pair.value;
        sums.pressure += other.pressure * pair.value;
        for i in 0..D {
            sums.velocity[i] += other.velocity[i] * pair.value;
            sums.deviation[i] += other.deviation[i] * pair.value;
            sums.arm[i] += pair.separation[i] * weight;
        }
    }
}

/// [`Extrapolation`] with the deviatoric stress of solids, `sum s_b W_ab`, CTVF (53).
#[derive(Clone, Copy, Debug)]
pub struct StressExtrapolation<const D: usize>;

impl<const D: usize> PairLaw for StressExtrapolation<D> {
    type Pair = MovingPair<D>;
    type Side = (FluidSide<D>, Many<MATTER>);
    type Sums = (Surroundings<D>, Many<6>);

    const NEEDS: Needs = Needs::Value;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (me, _): &Of<Self::Side, T>,
        (other, matter): &Of<Self::Side, T>,
        pair: &Of<MovingPair<D>, T>,
        (around, deviator): &mut Of<Self::Sums, T>,
    ) {
        Extrapolation.add(me, other, pair, around);
        for k in 0..6 {
            deviator[k] += pair.value * matter[k];
        }
    }
}
