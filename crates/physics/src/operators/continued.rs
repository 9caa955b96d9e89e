//! SPH matrices of particles whose fields are carried on by ghosts that are made of them.

use piola_formulas::kernels::Needs;
use piola_formulas::pairs::{Frozen, Of, Square};

use super::error::OperatorError;
use super::frozen::{FrozenRows, Row, RowSizes};
use super::gather::{Among, visit};
use super::images::Image;
use super::stencil::{Cover, GradientForm, stencils};
use crate::{Tensor, Vector};

/// What a source is multiplied with, for each component of a field: the matrix that turns a kernel
/// gradient into the coefficients of the source.
pub type Share<const D: usize> = [Tensor<D>; D];

/// A ghost, made of particles and of data.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost<const D: usize> {
    /// The particle whose weight and support it has, by index in memory.
    pub like: u32,
    /// Where it is, in m.
    pub position: Vector<D>,
    /// Particles, by index in memory, with their shares.
    pub sources: Vec<(u32, Share<D>)>,
    /// Numbers of data, with their shares.
    pub data: Vec<(u32, Share<D>)>,
}

/// The gradient of a field with ghosts that carry each of its components on in its own way, theory (64), by rows of
/// particles and, behind them, of data: the derivatives of component i have row i of a coefficient.
#[derive(Clone, Debug)]
pub struct ContinuedGradient<const D: usize> {
    rows: FrozenRows<Square<D>>,
}

impl<const D: usize> ContinuedGradient<D> {
    /// The matrices of a cover, whose own images are not used, with ghosts.
    ///
    /// # Errors
    /// As [`SphMatrices::new`](super::SphMatrices::new), and [`OperatorError::Gap`] in the corrected form
    /// for a particle whose neighbours do not surround it evenly, so that its matrix of moments is no mere factor.
    pub fn new(
        cover: &Cover<'_, D>,
        form: GradientForm,
        ghosts: &[Ghost<D>],
    ) -> Result<Self, OperatorError> {
        let image = |ghost: &Ghost<D>| Image {
            source: ghost.like,
            position: ghost.position,
            sign: [1.0; D],
            data: [[0.0; 2]; D],
        };
        let images: Vec<Image<D>> = ghosts.iter().map(image).collect();
        let Cover { particles, group, kernel, radius, domain, .. } = *cover;
        let cover = Cover { particles, group, images: &images, kernel, radius, domain };
        let stencils = stencils(&cover, form)?;
        let count = particles.len();
        let mut rows: Vec<Vec<(u32, Tensor<D>)>> = Vec::with_capacity(count);
        for (a, stencil) in stencils.iter().enumerate() {
            if form == GradientForm::Corrected {
                let size: f64 = stencil.entries.iter().map(|entry| entry.gradient.norm()).sum();
                if !(stencil.diagonal.norm() <= EVEN * size) {
                    return Err(OperatorError::Gap {
                        id: particles.id[a],
                        position: particles.position[a].iter().copied().collect(),
                    });
                }
            }
            let mut row = Vec::with_capacity(stencil.entries.len());
            for entry in &stencil.entries {
                let Some(number) = entry.neighbor.checked_sub(count) else {
                    let whole = Tensor::from_fn(|_, j| entry.gradient[j]);
                    row.push((entry.neighbor as u32, whole));
                    continue;
                };
                let of = |share: &Share<D>| {
                    let rows = share.map(|own| own * entry.gradient);
                    Tensor::from_fn(|i, j| rows[i][j])
                };
                let ghost = &ghosts[number];
                let sources = ghost.sources.iter().map(|(source, share)| (*source, of(share)));
                row.extend(sources);
                let data = ghost.data.iter();
                row.extend(data.map(|(datum, share)| (count as u32 + datum, of(share))));
            }
            // Stable, so that sums are taken in one order.
            row.sort_by_key(|(column, _)| *column);
            row.dedup_by(|next, kept| {
                let is_known = next.0 == kept.0;
                if is_known {
                    kept.1 += next.1;
                }
                is_known
            });
            rows.push(row);
        }
        Ok(Self { rows: FrozenRows::new(rows.into_iter()) })
    }

    /// Number of particles.
    pub fn count(&self) -> usize {
        self.rows.count()
    }

    #[inline]
    fn visit(&self, a: usize, look: impl FnMut(usize, &Of<Frozen<Square<D>>, f64>)) {
        visit(&self.rows, a, Among::All, Needs::Nothing, &mut Row::default(), look);
    }

    /// The particles that have a part in the gradient of particle `a`.
    pub fn row(&self, a: usize) -> Vec<u32> {
        let mut row = Vec::new();
        self.visit(a, |b, _| row.extend((b < self.count()).then_some(b as u32)));
        row
    }

    /// The gradient `du_i/dx_j` at particle `a` of a field with its data.
    #[inline]
    pub fn gradient_at(&self, field: &[Vector<D>], a: usize) -> Tensor<D> {
        self.gradient_of(|b| field[b], a)
    }

    /// The part of data in the gradient at particle `a`, whose numbers are counted from 0.
    #[inline]
    pub fn gradient_of_data(&self, datum: impl Fn(usize) -> Vector<D>, a: usize) -> Tensor<D> {
        self.gradient_of(|b| b.checked_sub(self.count()).map_or_else(Vector::zeros, &datum), a)
    }

    #[inline]
    fn gradient_of(&self, field: impl Fn(usize) -> Vector<D>, a: usize) -> Tensor<D> {
        let mut gradient = Tensor::zeros();
        self.visit(a, |b, (coefficients, _)| {
            let own = field(b);
            for i in 0..D {
                for j in 0..D {
                    gradient[(i, j)] += coefficients[(i, j)] * own[i];
                }
            }
        });
        gradient
    }

    /// The divergence `sum_j dT_ij/dx_j` at particle `a` of a tensor field that is known as a function
    /// of the particle.
    #[inline]
    pub fn divergence_of(&self, field: impl Fn(usize) -> Tensor<D>, a: usize) -> Vector<D> {
        let mut divergence = Vector::zeros();
        self.visit(a, |b, (coefficients, _)| {
            let own = field(b);
            for i in 0..D {
                for j in 0..D {
                    divergence[i] += coefficients[(i, j)] * own[(i, j)];
                }
            }
        });
        divergence
    }

    /// How large its rows are.
    pub fn sizes(&self) -> RowSizes {
        self.rows.sizes()
    }

    /// Bytes of all coefficients.
    pub fn memory(&self) -> usize {
        self.rows.memory()
    }
}

/// Coefficients of neighbours on both sides of a particle cancel to this share of their sum.
const EVEN: f64 = 1e-6;
