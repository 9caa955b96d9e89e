//! The pass over particles alone: what each of them shows its neighbours.

use nalgebra::{SMatrix, SVector};
use piola_formulas::volumetric::VolumetricResponse;
use piola_formulas::{Number, riemann, tensor};

use super::fields::Columns;
use super::{Upwind, WaveSpeed};
use crate::{Vector, parallel};

/// What the pass over pairs gathers of a particle, in one place so that a neighbour costs one
/// stretch of memory, which begins with a cache line so that it takes as few of them as can be.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Side<T, const D: usize> {
    /// Current position x in m.
    pub position: SVector<T, D>,
    /// Reference position X in m.
    pub reference: Vector<D>,
    /// Velocity v in m/s.
    pub velocity: SVector<T, D>,
    /// Cofactor H = det(F) F^-T of the deformation gradient.
    pub cofactor: SMatrix<T, D, D>,
    /// Pressure p(J) of the evolved J in Pa.
    pub pressure: T,
    /// Reference density in kg/m^3.
    pub density: f64,
    /// Speed of the shock in the dissipation in m/s.
    pub wave_speed: T,
}

impl<T: Number, const D: usize> Default for Side<T, D> {
    fn default() -> Self {
        Self {
            position: SVector::zeros(),
            reference: Vector::zeros(),
            velocity: SVector::zeros(),
            cofactor: SMatrix::zeros(),
            pressure: T::zero(),
            density: 0.0,
            wave_speed: T::zero(),
        }
    }
}

/// The unknowns of a particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unknowns<T, const D: usize> {
    /// Velocity v in m/s.
    pub velocity: SVector<T, D>,
    /// Evolved volume ratio J.
    pub ratio: T,
    /// Current position x in m.
    pub position: SVector<T, D>,
    /// Deformation gradient F.
    pub deformation: SMatrix<T, D, D>,
}

impl<const D: usize> Unknowns<f64, D> {
    /// Those of particle a in a state.
    #[inline]
    pub fn of(at: &Columns<'_, D>, a: usize) -> Self {
        Self {
            velocity: at.velocity[a],
            ratio: at.volume_ratio[a],
            position: at.position[a],
            deformation: at.deformation_gradient[a],
        }
    }
}

impl<const D: usize> Upwind<D> {
    /// Fills [`Side`] for all particles from `state`.
    pub(super) fn local_pass(&mut self, state: &[f64]) {
        let at = self.columns(state);
        let mut sides = std::mem::take(&mut self.sides);
        parallel::for_each_chunk(&mut sides, |first, sides| {
            for (a, side) in (first..).zip(sides) {
                *side = self.side(a, &Unknowns::of(&at, a));
            }
        });
        self.sides = sides;
    }

    /// What particle a with these unknowns shows its neighbours.
    #[inline]
    pub(super) fn side<T: Number>(&self, a: usize, unknowns: &Unknowns<T, D>) -> Side<T, D> {
        let reference = &self.reference[a];
        let wave_speed = match self.settings.wave_speed {
            WaveSpeed::Constant => T::from(reference.wave_speed),
            WaveSpeed::Stretch => {
                let strain = tensor::right_cauchy_green(&unknowns.deformation);
                let smallest = tensor::smallest_eigenvalue(&strain);
                riemann::stretched_wave_speed(reference.wave_speed, smallest)
            }
        };
        Side {
            position: unknowns.position,
            reference: self.particles.position[a],
            velocity: unknowns.velocity,
            cofactor: tensor::cofactor(&unknowns.deformation),
            pressure: self.law(a).pressure(unknowns.ratio),
            density: reference.density,
            wave_speed,
        }
    }
}
