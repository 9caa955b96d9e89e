//! The pass over particles alone: what each of them shows its neighbours.

use piola_formulas::volumetric::VolumetricResponse;
use piola_formulas::{riemann, tensor};

use super::{Row, Upwind, WaveSpeed};
use crate::{Tensor, Vector, parallel};

/// What the pass over pairs gathers of a particle, in one place so that a neighbour costs one
/// stretch of memory, which begins with a cache line so that it takes as few of them as can be.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Side<const D: usize> {
    /// Current position x in m.
    pub position: Vector<D>,
    /// Reference position X in m.
    pub reference: Vector<D>,
    /// Velocity v in m/s.
    pub velocity: Vector<D>,
    /// Cofactor H = det(F) F^-T of the deformation gradient.
    pub cofactor: Tensor<D>,
    /// Pressure p(J) of the evolved J in Pa.
    pub pressure: f64,
    /// Reference density in kg/m^3.
    pub density: f64,
    /// Speed of the shock in the dissipation in m/s.
    pub wave_speed: f64,
}

impl<const D: usize> Default for Side<D> {
    fn default() -> Self {
        Self {
            position: Vector::zeros(),
            reference: Vector::zeros(),
            velocity: Vector::zeros(),
            cofactor: Tensor::zeros(),
            pressure: 0.0,
            density: 0.0,
            wave_speed: 0.0,
        }
    }
}

/// The deformation gradient of a row of the state.
#[inline]
pub(super) fn deformation<const D: usize>(row: &[f64]) -> Tensor<D> {
    let stored = &row[Row::<D>::DEFORMATION..Row::<D>::LENGTH];
    Tensor::from_fn(|i, j| stored[i * D + j])
}

impl<const D: usize> Upwind<D> {
    /// Fills [`Side`] for all particles from `state`.
    pub(super) fn local_pass(&mut self, state: &[f64]) {
        let mut sides = std::mem::take(&mut self.sides);
        parallel::for_each_chunk(&mut sides, |first, sides| {
            let rows = state[first * Row::<D>::LENGTH..].chunks_exact(Row::<D>::LENGTH);
            for (offset, (side, row)) in sides.iter_mut().zip(rows).enumerate() {
                *side = self.side(first + offset, row);
            }
        });
        self.sides = sides;
    }

    #[inline]
    fn side(&self, a: usize, row: &[f64]) -> Side<D> {
        let gradient = deformation::<D>(row);
        let reference = &self.reference[a];
        let wave_speed = match self.settings.wave_speed {
            WaveSpeed::Constant => reference.wave_speed,
            WaveSpeed::Stretch => {
                let strain = tensor::right_cauchy_green(&gradient);
                let smallest = tensor::smallest_eigenvalue(&strain);
                riemann::stretched_wave_speed(reference.wave_speed, smallest)
            }
        };
        Side {
            position: Vector::from_column_slice(&row[Row::<D>::POSITION..Row::<D>::DEFORMATION]),
            reference: self.particles.position[a],
            velocity: Vector::from_column_slice(&row[..D]),
            cofactor: tensor::cofactor(&gradient),
            pressure: self.law(a).pressure(row[Row::<D>::VOLUME_RATIO]),
            density: reference.density,
            wave_speed,
        }
    }
}
