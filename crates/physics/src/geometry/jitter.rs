//! Random displacements of particles.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

use super::fill::ON_BOUNDARY;
use super::lattice::Lattice;
use super::{LatticeSpec, Shape};
use crate::Vector;

/// Halvings of a displacement out of the shape before it is given up.
const HALVINGS: usize = 6;

/// Moves each particle at random by up to `spec.jitter` cells along each axis.
///
/// A particle on a face of the bounding box moves along it only, except where space goes round,
/// and one that would leave the shape moves by less.
pub(super) fn jitter<const D: usize>(
    positions: &mut [Vector<D>],
    shape: &Shape<D>,
    lattice: &Lattice<D>,
    spec: &LatticeSpec<D>,
) {
    let (min, max) = shape.bounding_box();
    let mut source = Pcg64::seed_from_u64(spec.seed);
    for position in positions {
        // Every particle draws as many numbers, in the order of creation.
        let mut step = Vector::<D>::from_fn(|axis, _| {
            spec.jitter * lattice.edges[axis] * (2.0 * uniform(&mut source) - 1.0)
        });
        for axis in 0..D {
            let distance = (position[axis] - min[axis]).min(max[axis] - position[axis]);
            if distance <= ON_BOUNDARY * lattice.edges[axis] && !spec.periodic[axis] {
                step[axis] = 0.0;
            }
        }
        let inside = |point: &Vector<D>| shape.contains(&lattice.fold(point));
        if let Some(step) = (0..HALVINGS)
            .map(|i| step * 0.5f64.powi(i as i32))
            .find(|step| inside(&(*position + step)))
        {
            *position += step;
        }
    }
}

/// Uniform in [0, 1): the upper 53 bits of the next number, so that the sequence depends on the
/// generator alone.
pub(crate) fn uniform(source: &mut Pcg64) -> f64 {
    (source.next_u64() >> 11) as f64 * 0.5f64.powi(53)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_numbers_fill_the_unit_interval() {
        let mut source = Pcg64::seed_from_u64(1);
        let numbers: Vec<f64> = (0..100_000).map(|_| uniform(&mut source)).collect();
        assert!(numbers.iter().all(|x| (0.0..1.0).contains(x)));
        // The mean of n numbers has the standard deviation 1 / sqrt(12 n) = 9.1e-4.
        let mean = numbers.iter().sum::<f64>() / 1e5;
        assert!((mean - 0.5).abs() < 4.0 * 9.1e-4, "{mean}");
    }
}
