//! Linear and angular momentum, and the impulses that change them.

use nalgebra::SVector;
use piola_formulas::Number;

use crate::{Vector, parallel};

/// One component of momentum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MomentumComponent {
    /// Name in tables, for example `linear.x`.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
}

/// Most components of momentum: three linear and three angular ones.
pub const MOST_COMPONENTS: usize = 6;

const fn linear(name: &'static str) -> MomentumComponent {
    MomentumComponent { name, unit: "kg m/s" }
}

const fn angular(name: &'static str) -> MomentumComponent {
    MomentumComponent { name, unit: "kg m2/s" }
}

/// The components of momentum in `dimension` dimensions: linear ones first, then angular ones
/// about the origin, of which there are none in 1D and one in 2D. In a periodic box the angular
/// ones are no conserved quantity.
pub fn momentum_components(dimension: usize) -> &'static [MomentumComponent] {
    const LINE: [MomentumComponent; 1] = [linear("linear.x")];
    const PLANE: [MomentumComponent; 3] =
        [linear("linear.x"), linear("linear.y"), angular("angular.z")];
    const SPACE: [MomentumComponent; 6] = [
        linear("linear.x"),
        linear("linear.y"),
        linear("linear.z"),
        angular("angular.x"),
        angular("angular.y"),
        angular("angular.z"),
    ];
    match dimension {
        1 => &LINE,
        2 => &PLANE,
        _ => &SPACE,
    }
}

/// `sqrt(sum_a m_a |v_a - w_a|^2)` in J^(1/2) of velocities v and w of particles with the masses m in kg.
pub(crate) fn kinetic_distance<const D: usize>(
    [one, other]: [&[Vector<D>]; 2],
    mass: impl Fn(usize) -> f64 + Sync,
) -> f64 {
    parallel::sum(one.len(), |a| mass(a) * (one[a] - other[a]).norm_squared()).sqrt()
}

/// The momentum of `vector` (mass times velocity, or a force) at `point`, as
/// [`momentum_components`] orders it: `vector`, then `point x vector`.
#[inline]
pub fn moments<T: Number, const D: usize>(
    point: &SVector<T, D>,
    vector: &SVector<T, D>,
) -> ([T; MOST_COMPONENTS], usize) {
    let mut all = [T::zero(); MOST_COMPONENTS];
    all[..D].copy_from_slice(vector.as_slice());
    let turn = |i: usize, j: usize| point[i] * vector[j] - point[j] * vector[i];
    let count = match D {
        1 => 1,
        2 => {
            all[2] = turn(0, 1);
            3
        }
        _ => {
            all[3..].copy_from_slice(&[turn(1, 2), turn(2, 0), turn(0, 1)]);
            6
        }
    };
    (all, count)
}

/// Adds the momentum of `vector` at `point` to `sum`, which has one entry a component.
#[inline]
pub fn add_moments<const D: usize>(point: &Vector<D>, vector: &Vector<D>, sum: &mut [f64]) {
    let (all, count) = moments(point, vector);
    sum.iter_mut().zip(&all[..count]).for_each(|(sum, part)| *sum += part);
}

/// Writes the momentum of `count` particles: `of` has the position and the linear momentum of each.
pub(crate) fn of_particles<const D: usize>(
    count: usize,
    of: impl Fn(usize) -> [Vector<D>; 2] + Sync,
    momentum: &mut [f64],
) {
    let all: [f64; MOST_COMPONENTS] =
        parallel::sums(count, |a, sums: &mut [f64; MOST_COMPONENTS]| {
            let [position, own] = of(a);
            add_moments(&position, &own, sums);
        });
    momentum.iter_mut().zip(all).for_each(|(entry, sum)| *entry = sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dimension_has_as_many_names_as_numbers() {
        fn count<const D: usize>() -> usize {
            moments(&Vector::<D>::zeros(), &Vector::zeros()).1
        }
        for (dimension, count) in [(1, count::<1>()), (2, count::<2>()), (3, count::<3>())] {
            assert_eq!(momentum_components(dimension).len(), count);
        }
    }

    #[test]
    fn the_angular_part_is_the_cross_product() {
        let (point, vector) = (Vector::from([1.0, -2.0, 3.0]), Vector::from([0.5, 4.0, -1.0]));
        let mut sum = [1.0; 6];
        add_moments(&point, &vector, &mut sum);
        let cross = point.cross(&vector);
        assert_eq!(sum[..3], [1.5, 5.0, 0.0]);
        assert_eq!(sum[3..], [1.0 + cross.x, 1.0 + cross.y, 1.0 + cross.z]);
        let mut plane = [0.0; 3];
        add_moments(&Vector::from([1.0, -2.0]), &Vector::from([0.5, 4.0]), &mut plane);
        assert_eq!(plane, [0.5, 4.0, 5.0]);
    }
}
