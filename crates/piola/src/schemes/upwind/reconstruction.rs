//! The pass that finds slopes for the reconstruction at mid-edges, Upwind (3.50) to (3.53).

use multiversion::multiversion;
use nalgebra::{SMatrix, SVector};

use super::Upwind;
use super::gather::at;
use crate::operators::{LANES, Lanes, LeastSquares, total};
use crate::{Tensor, Vector, parallel};

/// Least-squares gradients of the reconstructed fields with respect to X.
///
/// The paper reconstructs the stress P; here it is the pressure, which with the averaged
/// cofactor gives the same flux and takes one gradient instead of `D * D`. It begins with a cache
/// line, as a [`super::local::Side`] does.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Slope<T, const D: usize> {
    /// Gradient of the velocity in 1/s.
    pub velocity: SMatrix<T, D, D>,
    /// Gradient of the pressure in Pa/m.
    pub pressure: SVector<T, D>,
}

impl<const D: usize> Slope<f64, D> {
    /// That of constant fields.
    pub const ZERO: Self = {
        let velocity = nalgebra::ArrayStorage([[0.0; D]; D]);
        let pressure = nalgebra::ArrayStorage([[0.0; D]; 1]);
        Self {
            velocity: Tensor::from_array_storage(velocity),
            pressure: Vector::from_array_storage(pressure),
        }
    };
}

impl<const D: usize> Upwind<D> {
    /// Fills the slopes from the sides of the local pass, if the formulation reconstructs.
    pub(super) fn slope_pass(&mut self) {
        let Some(least_squares) = &self.least_squares else { return };
        let mut slopes = std::mem::take(&mut self.slopes);
        parallel::for_each_chunk(&mut slopes, |first, slopes| {
            fill_slopes(self, least_squares, first, slopes);
        });
        self.slopes = slopes;
    }

    /// `sum_b (u_b - u_a) (x) d_ab / |d_ab|^2` of velocity and pressure, theory (4).
    #[inline(always)]
    fn gather_moments(&self, a: usize) -> Moments<D> {
        let me = &self.sides[a];
        let mut sums = Moments { velocity: [[[0.0; LANES]; D]; D], pressure: [[0.0; LANES]; D] };
        for row in self.support.list.row(a).chunks(LANES) {
            // Lanes without a neighbour take the last one again, with a weight of zero.
            let mut neighbors = [row[row.len() - 1]; LANES];
            neighbors[..row.len()].copy_from_slice(row);
            let mut counts = [0.0; LANES];
            counts[..row.len()].fill(1.0);
            let others = neighbors.map(|b| &self.sides[b as usize]);
            let mut separations = [[0.0; LANES]; D];
            self.separate(me, &others, |side| &side.reference, &mut separations);
            for lane in 0..LANES {
                let separation = at(&separations, lane);
                let weighted = separation * (counts[lane] / separation.norm_squared());
                let velocity_jump = others[lane].velocity - me.velocity;
                let pressure_jump = others[lane].pressure - me.pressure;
                for j in 0..D {
                    for i in 0..D {
                        sums.velocity[i][j][lane] += velocity_jump[i] * weighted[j];
                    }
                    sums.pressure[j][lane] += weighted[j] * pressure_jump;
                }
            }
        }
        sums
    }
}

/// Sums over neighbours that the inverse moment matrix turns into slopes.
struct Moments<const D: usize> {
    velocity: [[Lanes; D]; D],
    pressure: [Lanes; D],
}

impl<const D: usize> Moments<D> {
    /// The slopes, apart from the loop over lanes as [`super::gather::Sums::total`] is.
    #[inline(never)]
    fn solve(&self, inverse: &Tensor<D>) -> Slope<f64, D> {
        let velocity = Tensor::<D>::from_fn(|i, j| total(self.velocity[i][j]));
        let pressure = Vector::<D>::from_fn(|i, _| total(self.pressure[i]));
        // The inverse is symmetric.
        Slope { velocity: velocity * inverse, pressure: inverse * pressure }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn fill_slopes<const D: usize>(
    scheme: &Upwind<D>,
    least_squares: &LeastSquares<D>,
    first: usize,
    slopes: &mut [Slope<f64, D>],
) {
    for (offset, slope) in slopes.iter_mut().enumerate() {
        let a = first + offset;
        *slope = scheme.gather_moments(a).solve(least_squares.inverse(a));
    }
}
