//! Supports that differ from particle to particle, and their duals.

use piola_formulas::kernels::Kernel;

use super::stencil::Cover;
use crate::Vector;
use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, NeighborList, search};

/// Which particles lie in whose support, Dual-support (5), and in whose support a particle lies,
/// its dual support (6) there.
///
/// Unlike [`Support`](super::Support) the list is not symmetric: b in the support of a need not
/// have a in its own. What a takes from b acts on b as a reaction, which the dual support gathers.
#[derive(Clone, Debug)]
pub struct DirectedSupport<const D: usize> {
    /// The smoothing kernel.
    pub kernel: Kernel,
    /// Support radius of each particle in m.
    pub radius: Vec<f64>,
    /// Support of each particle, without itself.
    pub list: NeighborList,
    /// Dual support of each particle.
    pub dual: NeighborList,
    /// For each entry of the dual list, b in the dual row of a, the entry of a in the row of b.
    pub dual_entries: Vec<u32>,
    /// The box and its periodic axes.
    pub domain: Domain<D>,
}

impl<const D: usize> DirectedSupport<D> {
    /// Supports of the given radii in m. Particles of different bodies do not see each other.
    ///
    /// # Errors
    /// When the search refuses positions or radii.
    #[inline(never)]
    pub fn new(
        particles: &Particles<D>,
        kernel: Kernel,
        radius: Vec<f64>,
        domain: Domain<D>,
    ) -> Result<Self, NeighborError> {
        let (group, images) = (&*particles.body, &[]);
        Self::of(&Cover { particles, group, images, kernel, radius: &radius, domain })
    }

    /// The supports of a cover, of which images have none of their own. They lie in those of particles, with
    /// numbers behind them.
    ///
    /// # Errors
    /// As [`Self::new`].
    #[inline(never)]
    pub fn of(cover: &Cover<'_, D>) -> Result<Self, NeighborError> {
        let Cover { particles, group, images, kernel, radius, domain } = *cover;
        let count = particles.len();
        let source = |slot: u32| match (slot as usize).checked_sub(count) {
            None => slot as usize,
            Some(image) => images[image].source as usize,
        };
        let of_images = images.iter().map(|image| image.position);
        let positions: Vec<_> = particles.position.iter().copied().chain(of_images).collect();
        let reach: Vec<f64> =
            (0..positions.len() as u32).map(|slot| radius[source(slot)]).collect();
        let mut list = search(&positions, &reach, &domain)?;
        if !images.is_empty() || group.windows(2).any(|pair| pair[0] != pair[1]) {
            let sees = |a: u32, b: u32| group.is_empty() || group[a as usize] == group[source(b)];
            list = list.retain(|a, b| (a as usize) < count && sees(a, b));
        }
        Ok(Self::on(list, (kernel, radius.to_vec()), domain))
    }

    /// The supports of a list, for a kernel and support radii.
    pub(super) fn on(
        list: NeighborList,
        (kernel, radius): (Kernel, Vec<f64>),
        domain: Domain<D>,
    ) -> Self {
        let dual = list.dual();
        let mut next = dual.offsets().to_vec();
        let mut dual_entries = vec![0; dual.pairs()];
        // The dual list is made in the same order, so that its rows are met from their starts.
        for (entry, &b) in list.indices().iter().enumerate() {
            dual_entries[next[b as usize]] = entry as u32;
            next[b as usize] += 1;
        }
        Self { kernel, radius, list, dual, dual_entries, domain }
    }

    /// Reference separation `X_b - X_a`, the nearest image in a periodic box.
    #[inline]
    pub fn separation(&self, positions: &[Vector<D>], a: usize, b: u32) -> Vector<D> {
        self.domain.separation(&positions[a], &positions[b as usize])
    }

    /// Smoothing length of a particle in m.
    pub fn smoothing_length(&self, a: usize) -> f64 {
        self.radius[a] / self.kernel.support_over_h()
    }

    /// Bytes of both lists.
    pub fn memory(&self) -> usize {
        let lists = [&self.list, &self.dual]
            .map(|list| size_of_val(list.offsets()) + size_of_val(list.indices()));
        lists.iter().sum::<usize>()
            + size_of_val(self.dual_entries.as_slice())
            + size_of_val(self.radius.as_slice())
    }
}

/// Distance in m from each particle to the `count`-th nearest other one of its group, which as a
/// support radius gives each particle the same number of neighbours. The last of them lies on the
/// edge of the support, where kernels are zero. A particle of a group of fewer takes the farthest.
///
/// # Errors
/// When the search refuses the positions.
#[inline(never)]
pub fn nearest_radii<const D: usize>(
    particles: &Particles<D>,
    group: &[u32],
    count: usize,
    domain: &Domain<D>,
) -> Result<Vec<f64>, NeighborError> {
    let mut wanted = vec![count; group.iter().max().map_or(0, |&own| own as usize + 1)];
    let mut sizes = vec![0_usize; wanted.len()];
    group.iter().for_each(|&own| sizes[own as usize] += 1);
    let others = |size: usize| size.saturating_sub(1);
    wanted.iter_mut().zip(sizes).for_each(|(wanted, size)| *wanted = (*wanted).min(others(size)));
    let mut radius: Vec<f64> = particles.spacing.iter().map(|spacing| 2.0 * spacing).collect();
    let mut found = vec![0.0; particles.len()];
    let mut pending: Vec<bool> = vec![true; particles.len()];
    while pending.contains(&true) {
        let list = search(&particles.position, &radius, domain)?;
        for a in
            (0..particles.len()).filter(|&a| std::mem::take(&mut pending[a])).collect::<Vec<_>>()
        {
            let own = list.row(a).iter().filter(|&&b| group[b as usize] == group[a]);
            let separation = |&b: &u32| {
                domain.separation(&particles.position[a], &particles.position[b as usize]).norm()
            };
            let mut distances: Vec<f64> = own.map(separation).collect();
            let wanted = wanted[group[a] as usize];
            if distances.len() >= wanted {
                distances.sort_by(f64::total_cmp);
                found[a] = wanted.checked_sub(1).map_or(radius[a], |last| distances[last]);
            } else {
                pending[a] = true;
                radius[a] *= 1.5;
            }
        }
    }
    Ok(found)
}
