//! The corrected gradient of a field on a frozen list, and its adjoint.

use std::ops::Range;

use super::error::OperatorError;
use super::stencil::stencil;
use super::support::Support;
use crate::geometry::Particles;
use crate::{Tensor, Vector, parallel};

/// What is corrected in a kernel gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correction {
    /// The plain kernel gradient, exact for constants only.
    None,
    /// `L grad W` with the L of Upwind (2.43), theory (3), for the plain kernel: exact for linear
    /// fields.
    Gradient,
    /// Gradient correction of the Shepard-normalised kernel, Upwind (2.39) to (2.43).
    KernelAndGradient,
}

impl Correction {
    /// All corrections.
    pub const ALL: [Self; 3] = [Self::None, Self::Gradient, Self::KernelAndGradient];

    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Gradient => "gradient",
            Self::KernelAndGradient => "kernel_and_gradient",
        }
    }

    /// The correction of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|correction| correction.name() == name)
    }
}

/// Moment matrices with a reciprocal condition below this have no usable inverse. A narrow but
/// sound stencil in a corner has 0.1 and more; collinear neighbours have round-off, 1e-16.
const LEAST_CONDITION: f64 = 1e-8;

/// Gradient coefficients `G_ab = w_b grad~ W~_b(X_a)` of every pair, with their transposes.
///
/// The gradient of a field is `(grad f)_a = sum_b (f_b - f_a) (x) G_ab`, theory (2), Upwind (3.26)
/// with the redundant `-f_a` that makes constants exact. Written as one sum over all particles,
/// its coefficient of a itself is `G_aa = -sum_b G_ab`. The adjoint, which turns stresses into nodal
/// forces, gathers `G_ba`: a force `f_a = -sum_b V_b P_b G_ba`, b = a included, does exactly the
/// power `-sum_a V_a P_a : (grad v)_a`, for any correction and any weights.
#[derive(Clone, Debug)]
pub struct GradientOperator<const D: usize> {
    /// `G_ab` for each entry of the list, in 1/m.
    forward: Vec<[f64; D]>,
    /// `G_ba` for each entry of the list, in 1/m.
    adjoint: Vec<[f64; D]>,
    /// `G_aa` for each particle, in 1/m.
    diagonal: Vec<[f64; D]>,
}

impl<const D: usize> GradientOperator<D> {
    /// Builds the coefficients with kernel weights `particles.weight`.
    ///
    /// # Errors
    /// [`OperatorError::PoorSupport`] names the first particle whose correction does not exist,
    /// [`OperatorError::Coincident`] two at one place.
    #[inline(never)]
    pub fn new(
        particles: &Particles<D>,
        support: &Support<D>,
        correction: Correction,
    ) -> Result<Self, OperatorError> {
        let list = &support.list;
        let stencils = parallel::try_map(list.len(), |a| {
            let neighbors = list
                .row(a)
                .iter()
                .map(|&b| ([b as usize; 2], support.separation(&particles.position, a, b)));
            let kernel = (support.kernel, support.smoothing_length[a]);
            stencil(particles, kernel, correction, a, neighbors)
        })?;
        let diagonal = stencils.iter().map(|stencil| stencil.diagonal.into()).collect();
        let entries = stencils.iter().flat_map(|stencil| &stencil.entries);
        let forward: Vec<[f64; D]> = entries.map(|entry| entry.gradient.into()).collect();
        let adjoint = support.reverse.iter().map(|&entry| forward[entry as usize]).collect();
        Ok(Self { forward, adjoint, diagonal })
    }

    /// `G_ab` of the entries of one particle.
    #[inline]
    pub fn forward(&self, entries: Range<usize>) -> &[[f64; D]] {
        &self.forward[entries]
    }

    /// `G_ba` of the entries of one particle.
    #[inline]
    pub fn adjoint(&self, entries: Range<usize>) -> &[[f64; D]] {
        &self.adjoint[entries]
    }

    /// `G_aa` of one particle.
    #[inline]
    pub fn diagonal(&self, a: usize) -> Vector<D> {
        Vector::from(self.diagonal[a])
    }

    /// Discrete boundary area vectors `A_a = sum_b V_b G_ba` in m^(D-1), theory (14): the nodal
    /// forces of a unit pressure, zero inside a body where the operator is consistent, and the
    /// outward area of a particle on its boundary. They sum to zero.
    pub fn boundary_areas(&self, support: &Support<D>, volume: &[f64]) -> Vec<Vector<D>> {
        let mut areas = vec![Vector::zeros(); support.list.len()];
        parallel::for_each_chunk(&mut areas, |first, rows| {
            for (offset, area) in rows.iter_mut().enumerate() {
                let a = first + offset;
                let entries = support.list.range(a);
                *area = self.diagonal(a) * volume[a];
                for (&b, g) in support.list.row(a).iter().zip(self.adjoint(entries)) {
                    *area += Vector::from(*g) * volume[b as usize];
                }
            }
        });
        areas
    }
}

/// Inverse of a moment matrix, or the error that names the particle without one.
pub(super) fn invert<const D: usize>(
    particles: &Particles<D>,
    a: usize,
    neighbors: usize,
    moment: &Tensor<D>,
    correction: &'static str,
) -> Result<Tensor<D>, OperatorError> {
    use piola_formulas::tensor;
    let square = moment.transpose() * moment;
    let largest = tensor::largest_eigenvalue(&square).sqrt();
    // |det| over the product of the other singular values bounds the smallest one from below.
    let condition = tensor::determinant(moment).abs() / largest.powi(D as i32);
    let poor = || OperatorError::PoorSupport {
        id: particles.id[a],
        position: particles.position[a].iter().copied().collect(),
        neighbors,
        dimension: D,
        condition: if condition.is_finite() { condition } else { 0.0 },
        correction,
    };
    if !(condition > LEAST_CONDITION) {
        return Err(poor());
    }
    tensor::inverse(moment).ok_or_else(poor)
}
