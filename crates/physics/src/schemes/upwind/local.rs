//! The pass over particles alone: what each of them shows its neighbours.

use nalgebra::{SMatrix, SVector};
use piola_formulas::pairs::upwind::{Side, UpwindSide};
use piola_formulas::volumetric::VolumetricResponse;
use piola_formulas::{Number, riemann, tensor};

use super::fields::Columns;
use super::{Upwind, WaveSpeed};
use crate::parallel;

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
        let count = self.particles.len();
        parallel::for_each_chunk(&mut sides[..count], |first, sides| {
            for (a, side) in (first..).zip(sides) {
                *side = self.side(a, &Unknowns::of(&at, a));
            }
        });
        self.team.refresh_records::<UpwindSide<D>>(&mut sides, count);
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
            reference: self.particles.position[a].map(T::from),
            velocity: unknowns.velocity,
            cofactor: tensor::cofactor(&unknowns.deformation),
            pressure: self.law(a).pressure(unknowns.ratio),
            density: T::from(reference.density),
            wave_speed,
        }
    }
}
