//! The corrected gradient on supports that differ, and the weights of its residual.

use std::ops::Range;

use super::directed::DirectedSupport;
use super::error::OperatorError;
use super::gradient::invert;
use crate::geometry::Particles;
use crate::{Tensor, Vector, parallel};

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
        type Row<const D: usize> = Result<(Vec<[f64; D]>, Vec<f64>), OperatorError>;
        let mut rows: Vec<Row<D>> = Vec::new();
        rows.resize_with(particles.len(), || Ok((Vec::new(), Vec::new())));
        parallel::for_each_chunk(&mut rows, |first, rows| {
            for (offset, row) in rows.iter_mut().enumerate() {
                *row = plain_row(particles, support, first + offset);
            }
        });
        let mut coefficients = Vec::with_capacity(support.list.pairs());
        let mut weights = Vec::with_capacity(support.list.pairs());
        for row in rows {
            let (row, row_weights) = row?;
            coefficients.extend_from_slice(&row);
            weights.extend_from_slice(&row_weights);
        }
        Ok(Self { coefficients, weights })
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

fn plain_row<const D: usize>(
    particles: &Particles<D>,
    support: &DirectedSupport<D>,
    a: usize,
) -> Result<(Vec<[f64; D]>, Vec<f64>), OperatorError> {
    let (row, h) = (support.list.row(a), support.smoothing_length(a));
    let mut moment = Tensor::<D>::zeros();
    let mut terms = Vec::with_capacity(row.len());
    for &b in row {
        let separation = support.separation(&particles.position, a, b);
        let distance = separation.norm();
        if !(distance > 0.0) {
            return Err(OperatorError::Coincident {
                first: particles.id[a],
                second: particles.id[b as usize],
                position: particles.position[a].iter().copied().collect(),
            });
        }
        let slope = -support.kernel.derivative_over_r(D, distance, h);
        let weight = particles.weight[b as usize] * slope;
        moment += separation * separation.transpose() * weight;
        terms.push((separation, weight));
    }
    let inverse = invert(particles, a, row.len(), &moment, "gradient")?;
    let trace = moment.trace();
    let coefficient = |(x, weight): &(Vector<D>, f64)| (inverse * x * *weight).into();
    let coefficients = terms.iter().map(coefficient).collect();
    Ok((coefficients, terms.iter().map(|(_, weight)| weight / trace).collect()))
}
