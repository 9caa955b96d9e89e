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
        let constants = Constants {
            place: self.particles.position[a].map(T::from),
            density: T::from(reference.density),
            wave_speed: T::from(reference.wave_speed),
        };
        let pressure = self.law(a).pressure(unknowns.ratio);
        side(self.settings.wave_speed, constants, pressure, unknowns)
    }
}

/// What of a particle does not change and its neighbours see.
pub(super) struct Constants<T, const D: usize> {
    /// Reference position X in m.
    pub place: SVector<T, D>,
    /// Reference density in kg/m^3.
    pub density: T,
    /// Wave speed at the reference in m/s.
    pub wave_speed: T,
}

/// What a particle of these constants, this pressure in Pa and these unknowns shows its neighbours.
#[inline]
pub(super) fn side<T: Number, const D: usize>(
    wave_speed: WaveSpeed,
    constants: Constants<T, D>,
    pressure: T,
    unknowns: &Unknowns<T, D>,
) -> Side<T, D> {
    let wave_speed = match wave_speed {
        WaveSpeed::Constant => constants.wave_speed,
        WaveSpeed::Stretch => {
            let strain = tensor::right_cauchy_green(&unknowns.deformation);
            let smallest = tensor::smallest_eigenvalue(&strain);
            riemann::stretched_wave_speed(constants.wave_speed, smallest)
        }
    };
    Side {
        position: unknowns.position,
        reference: constants.place,
        velocity: unknowns.velocity,
        cofactor: tensor::cofactor(&unknowns.deformation),
        pressure,
        density: constants.density,
        wave_speed,
    }
}
