//! Clouds made more even by what pushes neighbours apart.

use piola_formulas::kernels::Kernel;

use crate::geometry::Particles;
use crate::neighbors::{Domain, NeighborError, search};
use crate::{Vector, parallel};

/// Support radius of the kernel in spacings.
const REACH: f64 = 2.2;

/// Share of a square of the spacing by which a step follows the gradient.
const STEP: f64 = 0.3;

/// Largest move of a step in spacings.
const MOST: f64 = 0.1;

/// Moves those particles that are `free` apart from their neighbours, as fluids are shifted:
/// `X_a += - beta dx^2 sum_b w_b (grad_a W_ab - grad_a W_ab at the sites)`, by a tenth of the spacing
/// dx at most, `steps` times. At the `sites` of the lattice that the particles come from nothing moves, near a boundary
/// neither, where the sum would push outwards. The kernel is one of Wendland's, under which particles do not pair. A
/// step to where a particle does not stay is left out: `stays` is asked once for each free particle and step, with
/// where it would be in m. Volumes and weights stay. The same particles give the same places, whatever the threads.
///
/// # Errors
/// Those of [`search`].
#[inline(never)]
pub fn relax<const D: usize>(
    particles: &mut Particles<D>,
    sites: &[Vector<D>],
    free: &[bool],
    stays: &dyn Fn(&Vector<D>) -> bool,
    domain: &Domain<D>,
    steps: u64,
) -> Result<(), NeighborError> {
    let at_rest = pushes(particles, sites, domain)?;
    for _ in 0..steps {
        let pushes = pushes(particles, &particles.position, domain)?;
        for a in (0..free.len().min(pushes.len())).filter(|&a| free[a]) {
            let step = pushes[a] - at_rest[a];
            let (length, most) = (step.norm(), MOST * particles.spacing[a]);
            let step = if length > most { step * (most / length) } else { step };
            if stays(&(particles.position[a] + step)) {
                particles.position[a] += step;
            }
        }
    }
    Ok(())
}

/// The step of every particle in m at some places, before limits.
fn pushes<const D: usize>(
    particles: &Particles<D>,
    places: &[Vector<D>],
    domain: &Domain<D>,
) -> Result<Vec<Vector<D>>, NeighborError> {
    let kernel = Kernel::WendlandC2;
    let reach: Vec<f64> = particles.spacing.iter().map(|spacing| REACH * spacing).collect();
    let list = search(places, &reach, domain)?;
    let mut pushes = vec![Vector::<D>::zeros(); places.len()];
    parallel::for_each_chunk(&mut pushes, |first, pushes| {
        for (offset, push) in pushes.iter_mut().enumerate() {
            let a = first + offset;
            let (spacing, h) = (particles.spacing[a], reach[a] / kernel.support_over_h());
            for &b in list.row(a) {
                let apart = domain.separation(&places[a], &places[b as usize]);
                let slope = kernel.derivative_over_r(D, apart.norm(), h);
                *push += apart * (particles.weight[b as usize] * slope);
            }
            *push *= STEP * spacing * spacing;
        }
    });
    Ok(pushes)
}
