//! What takes derivatives, in both forms.

use super::Discrete;
use super::strong::Edges;
use crate::operators::{RowSizes, Strained};
use crate::{Tensor, Vector, parallel};

/// What takes derivatives of displacements and of stresses.
pub(super) enum Matrices<const D: usize> {
    /// Gradients with their adjoint, on a body with its mirror images.
    Adjoint(Discrete<D>),
    /// The matrices of the strong form, with the edges whose data stand behind those of particles.
    Strong(Box<Edges<D>>),
}

impl<const D: usize> Matrices<D> {
    /// The edges of the strong form.
    pub fn edges(&self) -> Option<&Edges<D>> {
        match self {
            Self::Adjoint(_) => None,
            Self::Strong(edges) => Some(edges),
        }
    }

    /// How many values a field has behind those of particles.
    pub fn behind(&self) -> usize {
        match self {
            Self::Adjoint(discrete) => discrete.operator.images(),
            Self::Strong(edges) => edges.data(),
        }
    }

    /// Gradients and what forces gather, of a body of `count` particles.
    pub fn strained(&self, count: usize) -> Strained<D> {
        match self {
            Self::Adjoint(discrete) => discrete.operator.strained(),
            Self::Strong(_) => {
                let zeros = || vec![Tensor::zeros(); count];
                Strained { gradient: zeros(), tension: zeros() }
            }
        }
    }

    /// The gradient at particle `a` of a field with what stands behind it.
    #[inline]
    pub fn gradient_at(&self, field: &[Vector<D>], a: usize) -> Tensor<D> {
        match self {
            Self::Adjoint(discrete) => discrete.operator.gradient_at(field, a),
            Self::Strong(edges) => edges.gradient.gradient_at(field, a),
        }
    }

    /// The gradients of a field with what stands behind it.
    pub fn gradients(&self, field: &[Vector<D>], gradient: &mut [Tensor<D>]) {
        match self {
            Self::Adjoint(discrete) => discrete.operator.gradients(field, gradient),
            Self::Strong(edges) => parallel::for_each_chunk(gradient, |first, rows| {
                for (a, gradient) in (first..).zip(rows) {
                    *gradient = edges.gradient.gradient_at(field, a);
                }
            }),
        }
    }

    /// The particles that have a part in the gradient of particle `a` or in whose gradient it has one,
    /// without itself.
    pub fn neighborhood(&self, a: usize) -> Vec<u32> {
        match self {
            Self::Adjoint(discrete) => discrete.operator.neighborhood(a),
            Self::Strong(edges) => edges.neighborhood(a),
        }
    }

    /// How many particles a particle has in its support.
    pub fn neighbors(&self, a: usize) -> usize {
        match self {
            Self::Adjoint(discrete) => discrete.operator.neighbors(a),
            Self::Strong(edges) => edges.neighborhood(a).len(),
        }
    }

    /// How large the rows of gradients and of forces are.
    pub fn sizes(&self) -> [RowSizes; 2] {
        match self {
            Self::Adjoint(discrete) => discrete.operator.sizes(),
            Self::Strong(edges) => [edges.gradient.sizes(), edges.divergence.sizes()],
        }
    }

    /// Bytes of all coefficients.
    pub fn memory(&self) -> usize {
        match self {
            Self::Adjoint(discrete) => discrete.operator.memory(),
            Self::Strong(edges) => edges.gradient.memory() + edges.divergence.memory(),
        }
    }
}
