//! Pair laws of total Lagrangian solids, on frozen lists: gradients in the reference configuration, and the
//! forces that are their exact adjoint.

use nalgebra::SVector;

use super::{Components, Each, Frozen, Of, One, PairLaw, Square, applied, difference};
use crate::Number;
use crate::kernels::Needs;

/// The sums `W_a^n = sum_b (u_b - u_a) (x) g_ab^n` of a field u over the support of a particle, with `N`
/// coefficients g of a pair: theory (44).
#[derive(Clone, Copy, Debug)]
pub struct Gradients<const D: usize, const N: usize>;

impl<const D: usize, const N: usize> PairLaw for Gradients<D, N> {
    type Pair = Frozen<Each<Components<D>, N>>;
    type Side = Components<D>;
    type Sums = Each<Square<D>, N>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        me: &SVector<T, D>,
        other: &SVector<T, D>,
        (pair, _): &Of<Self::Pair, T>,
        sums: &mut Of<Self::Sums, T>,
    ) {
        let jump = difference(other, me);
        for n in 0..N {
            for j in 0..D {
                for i in 0..D {
                    sums[n][(i, j)] += jump[i] * pair[n][j];
                }
            }
        }
    }
}

/// The forces in N of an energy E that is a function of the sums of [`Gradients`] and of differences of u:
/// `sum_b k_ab (u_b - u_a) - sum_n R_b^n g_ba^n`, where `R_b^n = dE/dW_b^n` and g is the coefficient that the other
/// particle has: theory (49).
#[derive(Clone, Copy, Debug)]
pub struct Forces<const D: usize, const N: usize>;

impl<const D: usize, const N: usize> PairLaw for Forces<D, N> {
    /// `g_ba^n`, and `k_ab` in N/m.
    type Pair = Frozen<(Each<Components<D>, N>, One)>;
    /// `R^n`, and u in m.
    type Side = (Each<Square<D>, N>, Components<D>);
    type Sums = Components<D>;

    const NEEDS: Needs = Needs::Nothing;

    #[inline(always)]
    fn add<T: Number>(
        &self,
        (_, me): &Of<Self::Side, T>,
        (tension, other): &Of<Self::Side, T>,
        ((coefficients, stiffness), _): &Of<Self::Pair, T>,
        force: &mut SVector<T, D>,
    ) {
        let jump = difference(other, me);
        for i in 0..D {
            force[i] += jump[i] * *stiffness;
        }
        for n in 0..N {
            let taken = applied(&tension[n], &coefficients[n]);
            for i in 0..D {
                force[i] -= taken[i];
            }
        }
    }
}
