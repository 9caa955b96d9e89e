//! The least-squares gradient of Upwind (3.50) to (3.53).

use std::ops::Range;

use super::error::OperatorError;
use super::gradient::invert;
use super::support::Support;
use crate::geometry::Particles;
use crate::{Tensor, Vector, parallel};

/// Inverse moment matrices `[sum_b N_ab (x) N_ab]^-1` of the least-squares gradient
///
/// `grad u_a = [sum_b N_ab (x) N_ab]^-1 sum_b (u_b - u_a) / |d_ab| N_ab`, theory (4), Upwind (3.53),
///
/// with `d_ab = X_b - X_a` and `N_ab = d_ab / |d_ab|`. It is exact for linear fields. The sum
/// itself belongs to the pass of a scheme, which has the fields in its hands.
#[derive(Clone, Debug)]
pub struct LeastSquares<const D: usize> {
    inverse: Vec<Tensor<D>>,
}

impl<const D: usize> LeastSquares<D> {
    /// Builds the inverse moments of all particles.
    ///
    /// # Errors
    /// [`OperatorError`] for a particle whose neighbours do not span the space, or that shares
    /// its place with another.
    #[inline(never)]
    pub fn new(particles: &Particles<D>, support: &Support<D>) -> Result<Self, OperatorError> {
        let inverse =
            parallel::try_map(particles.len(), |a| inverse_moment(particles, support, a))?;
        Ok(Self { inverse })
    }

    /// Those of some particles.
    pub fn part(&self, own: Range<usize>) -> Self {
        Self { inverse: self.inverse[own].to_vec() }
    }

    /// `[sum_b N_ab (x) N_ab]^-1` of particle a.
    #[inline]
    pub fn inverse(&self, a: usize) -> &Tensor<D> {
        &self.inverse[a]
    }

    /// The coefficient of `u_b - u_a` in `grad u_a`, of `separation` `X_b - X_a`, 1/m: for tangents,
    /// which need them one by one.
    #[inline]
    pub fn coefficient(&self, a: usize, separation: &Vector<D>) -> Vector<D> {
        self.inverse[a] * (separation / separation.norm_squared())
    }
}

fn inverse_moment<const D: usize>(
    particles: &Particles<D>,
    support: &Support<D>,
    a: usize,
) -> Result<Tensor<D>, OperatorError> {
    let row = support.list.row(a);
    let mut moment = Tensor::<D>::zeros();
    for &b in row {
        let separation = support.separation(&particles.position, a, b);
        let square = separation.norm_squared();
        if !(square > 0.0) {
            return Err(OperatorError::Coincident {
                first: particles.id[a],
                second: particles.id[b as usize],
                position: particles.position[a].iter().copied().collect(),
            });
        }
        moment += separation * separation.transpose() / square;
    }
    invert(particles, a, row.len(), &moment, "least-squares")
}
