//! The kernel, the smoothing lengths and the neighbours that the operators share.

use piola_formulas::kernels::Kernel;

use crate::Vector;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, NeighborList, search};

/// Which particles see each other, and through which kernel.
///
/// The list is symmetric: b is in the row of a when either lies in the support of the other. A
/// pair outside the support of a contributes a zero to the sums of a, but both directions of
/// every pair are at hand, which adjoint operators need.
#[derive(Clone, Debug)]
pub struct Support<const D: usize> {
    /// The smoothing kernel.
    pub kernel: Kernel,
    /// Smoothing length h of each particle in m.
    pub smoothing_length: Vec<f64>,
    /// Symmetric neighbour list.
    pub list: NeighborList,
    /// For entry k of pair (a, b) the entry of pair (b, a).
    pub reverse: Vec<u32>,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
}

impl<const D: usize> Support<D> {
    /// Finds the neighbours of all particles for smoothing lengths of `smoothing_ratio` times
    /// each particle's spacing. Particles of different bodies do not see each other.
    ///
    /// # Errors
    /// When the search refuses the positions or the supports.
    #[inline(never)]
    pub fn new(
        particles: &Particles<D>,
        kernel: Kernel,
        smoothing_ratio: f64,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let smoothing_length: Vec<f64> =
            particles.spacing.iter().map(|spacing| smoothing_ratio * spacing).collect();
        let radii: Vec<f64> = smoothing_length.iter().map(|&h| kernel.support_radius(h)).collect();
        let found = search(&particles.position, &radii, &domain)?;
        let body = &particles.body;
        let mut list = found.symmetric_closure();
        if body.windows(2).any(|pair| pair[0] != pair[1]) {
            list = list.retain(|a, b| body[a as usize] == body[b as usize]);
        }
        let reverse = list.reverse_entries()?;
        Ok(Self { kernel, smoothing_length, list, reverse, domain })
    }

    /// Reference separation `X_b - X_a`, the nearest image in a periodic box.
    pub fn separation(&self, positions: &[Vector<D>], a: usize, b: u32) -> Vector<D> {
        self.domain.separation(&positions[a], &positions[b as usize])
    }
}
