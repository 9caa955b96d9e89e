//! The corrected gradient on supports that differ, and the weights of its residual.

use std::ops::Range;

use super::directed::DirectedSupport;
use super::error::OperatorError;
use super::gradient::Correction;
use super::stencil::{Cover, stencils_on};
use crate::geometry::Particles;
use crate::{Vector, parallel};

/// Gradient coefficients `G_ab` of every b in the support of a, theory (44), Dual-support (10) to
/// (12), and the weights with which deviations from a linear field are summed, theory (47).
///
/// With `s_ab = -w_b W'(r)/r >= 0` and `L_a = sum_b s_ab X_ab (x) X_ab` (minus the L of the paper,
/// which is negative definite) `G_ab = L_a^-1 s_ab X_ab`. The kernel's normalisation cancels.
#[derive(Clone, Debug)]
pub struct DualGradient<const D: usize> {
    /// `G_ab` for each entry of the list, in 1/m.
    pub(super) coefficients: Vec<[f64; D]>,
    /// `s_ab / tr L_a` for each entry of the list, in 1/m^2: they weigh squares of lengths.
    pub(super) weights: Vec<f64>,
    pub(super) is_plain: bool,
}

impl<const D: usize> DualGradient<D> {
    /// The plain gradients of the paper, with the kernel weights of the particles.
    ///
    /// # Errors
    /// [`OperatorError`] for the first particle whose neighbours do not span the space, or that
    /// shares its place with another.
    pub fn plain(
        particles: &Particles<D>,
        support: &DirectedSupport<D>,
    ) -> Result<Self, OperatorError> {
        let DirectedSupport { kernel, radius, domain, .. } = support;
        let (kernel, domain) = (*kernel, *domain);
        Self::of(&Cover { particles, group: &[], images: &[], kernel, radius, domain }, support)
    }

    /// The plain gradients of a cover on its support.
    ///
    /// # Errors
    /// As [`Self::plain`].
    #[inline(never)]
    pub fn of(cover: &Cover<'_, D>, support: &DirectedSupport<D>) -> Result<Self, OperatorError> {
        let entries = support.list.pairs();
        let (mut coefficients, mut weights) =
            (Vec::with_capacity(entries), Vec::with_capacity(entries));
        for stencil in stencils_on(cover, &support.list, Correction::Gradient)? {
            coefficients
                .extend(stencil.entries.iter().map(|entry| <[f64; D]>::from(entry.gradient)));
            weights.extend(stencil.entries.iter().map(|entry| entry.weight));
        }
        Ok(Self { coefficients, weights, is_plain: true })
    }

    /// Whether it is the gradient of the paper, `G_ab = L_a^-1 s_ab X_ab`.
    pub fn is_plain(&self) -> bool {
        self.is_plain
    }

    /// `G_ab` of some entries of the list, in 1/m.
    #[inline]
    pub fn coefficients(&self, entries: Range<usize>) -> &[[f64; D]] {
        &self.coefficients[entries]
    }

    /// `G_ab` of one entry of the list, in 1/m.
    #[inline]
    pub fn coefficient(&self, entry: u32) -> &[f64; D] {
        &self.coefficients[entry as usize]
    }

    /// `s_ab / tr L_a` of some entries of the list, in 1/m^2.
    #[inline]
    pub fn weights(&self, entries: Range<usize>) -> &[f64] {
        &self.weights[entries]
    }

    /// `s_ab / tr L_a` of one entry of the list, in 1/m^2.
    #[inline]
    pub fn weight(&self, entry: u32) -> f64 {
        self.weights[entry as usize]
    }

    /// The areas `sum_b V_b G_ba - V_a sum_b G_ab` in m^(D-1), on which a constant stress acts:
    /// theory (46).
    pub fn areas(&self, support: &DirectedSupport<D>, volume: &[f64]) -> Vec<Vector<D>> {
        let mut areas = vec![Vector::zeros(); support.list.len()];
        parallel::for_each_chunk(&mut areas, |first, areas| {
            for (offset, area) in areas.iter_mut().enumerate() {
                let a = first + offset;
                for (&b, &entry) in dual_row(support, a) {
                    *area += Vector::from(*self.coefficient(entry)) * volume[b as usize];
                }
                for coefficient in self.coefficients(support.list.range(a)) {
                    *area -= Vector::from(*coefficient) * volume[a];
                }
            }
        });
        areas
    }

    /// Bytes of all coefficients.
    pub fn memory(&self) -> usize {
        size_of_val(self.coefficients.as_slice()) + size_of_val(self.weights.as_slice())
    }
}

/// The particles of the dual support of a with the entries that belong to them.
#[inline]
pub(crate) fn dual_row<const D: usize>(
    support: &DirectedSupport<D>,
    a: usize,
) -> impl Iterator<Item = (&u32, &u32)> {
    support.dual.row(a).iter().zip(&support.dual_entries[support.dual.range(a)])
}
