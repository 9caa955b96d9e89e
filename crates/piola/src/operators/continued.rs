//! SPH matrices of particles whose fields are carried on by ghosts that are made of them.

use super::error::OperatorError;
use super::folded::{Block, FoldedGradient};
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

impl<const D: usize> FoldedGradient<D> {
    /// The matrices of a cover, whose own images are not used, with ghosts: theory (64). Columns behind
    /// those of particles belong to data.
    ///
    /// # Errors
    /// As [`FoldedGradient::new`], and [`OperatorError::Gap`] in the corrected form for a particle
    /// whose neighbours do not surround it evenly, so that its matrix of moments is no mere factor.
    pub fn continued(
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
        let mut forward = Block::new(D);
        let mut row: Vec<(u32, Tensor<D>)> = Vec::new();
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
            row.clear();
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
            forward.push(&mut row);
        }
        Ok(Self::of_rows(forward, stencils.iter().map(|stencil| stencil.shape).collect()))
    }
}

/// Coefficients of neighbours on both sides of a particle cancel to this share of their sum.
const EVEN: f64 = 1e-6;
