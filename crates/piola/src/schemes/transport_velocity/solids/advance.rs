//! A drift of solids: density, stress, plastic strain, temperature and places.

use piola_formulas::hypoelastic::{Strength, advance, shear_energy, von_mises};

use super::{ENERGY, Matter, PLASTIC, Solid, SolidRates, TEMPERATURE, full, store};
use crate::Tensor;
use crate::parallel;
use crate::schemes::transport_velocity::ledger::Drift;
use crate::schemes::transport_velocity::{ColumnsMut, TransportVelocity};

/// What a step brings to the matter of a particle besides its own rates.
struct Surroundings {
    density: f64,
    pressure: f64,
    /// `div u` in 1/s, contact included.
    divergence: f64,
    step: f64,
}

impl<const D: usize> TransportVelocity<D> {
    /// The drift of solids, CTVF (56) to (59), with the rates of the last pass: theory (33), (69) to (71).
    pub(in super::super) fn drift_solids(&self, step: f64, state: &mut [f64]) -> Drift {
        let (front, matter) = state.split_at_mut(self.matter_start());
        let matter: &mut [Matter] = bytemuck::cast_slice_mut(matter);
        let (own, _) = self.parts(front);
        let scheme = self;
        let Some(solids) = &scheme.solids else { return Drift::default() };
        let (places, rates) = (scheme.support.list().places(), &solids.rates);
        let evolves = !scheme.settings.is_algebraic();
        let drift = |[number, k]: [usize; 2],
                     own: &mut ColumnsMut<'_, D>,
                     matter: &mut Matter,
                     sums: &mut Drift| {
            if scheme.is_wall[number] {
                return;
            }
            let place = places[number] as usize;
            let (side, material) =
                (&scheme.sides[place], &solids.materials[scheme.particles.body[number] as usize]);
            let around = Surroundings {
                density: side.density,
                pressure: side.pressure,
                divergence: scheme.rates_at(place).divergence,
                step,
            };
            let energy = |density: f64, matter: &Matter| {
                let [compression, shear] = material.energies(density, matter);
                scheme.mass[number] * (compression + shear)
            };
            let before = energy(own.density[k], matter);
            let work = side.volume * material.advance(&rates[place], &around, matter);
            let (velocity, deviation) = (&own.velocity[k], &own.deviation[k]);
            let moving = (own.pressure[k], velocity, deviation);
            scheme.add_drift((number, place), (step, false), moving, sums);
            own.density[k] += step * scheme.density_rate(place);
            if evolves {
                let rate = scheme.pressure_rates(place).iter().sum::<f64>();
                let pressure = &mut own.pressure[k];
                *pressure = (*pressure + step * rate).max(-material.state.spall_strength);
            }
            scheme.advect(step, &mut own.position[k], velocity + deviation);
            let [pressure, .., plasticity] = sums;
            pressure.power += energy(own.density[k], matter) - before + work;
            plasticity.power -= work;
        };
        let parts = (own, matter);
        parallel::sums_over_parts(places.len(), parts, |first, (mut own, all), sums| {
            for (k, matter) in all.iter_mut().enumerate() {
                drift([first + k, k], &mut own, matter, sums);
            }
        })
    }

    /// Energies of compression and shear in J.
    pub(in super::super) fn energies_of_solids(&self, state: &[f64]) -> [f64; 2] {
        let at = self.columns(state);
        parallel::sums(self.particles.len(), |number, sums: &mut [f64; 2]| {
            if !self.is_wall[number] {
                let Some(solid) = self.solid(number) else { return };
                let energies = solid.energies(at.density[number], self.matter_of(number, state));
                for (sum, energy) in sums.iter_mut().zip(energies) {
                    *sum += self.mass[number] * energy;
                }
            }
        })
    }
}

impl Solid {
    /// The specific energies of compression and shear in J/kg at a density in kg/m^3.
    fn energies(&self, density: f64, matter: &[f64]) -> [f64; 2] {
        let shear = shear_energy(&full(matter), self.shear_modulus, density);
        [self.state.compression_energy(density, matter[ENERGY]), shear]
    }

    /// Advances the matter of a particle, and returns the plastic work in J/m^3.
    fn advance<const D: usize>(
        &self,
        rates: &SolidRates<D>,
        around: &Surroundings,
        matter: &mut [f64],
    ) -> f64 {
        let step = around.step;
        let gradient = in_three(&rates.gradient);
        let old = full(matter);
        let stress =
            advance(self.shear_modulus, &old, &gradient, step) + full(&rates.transport) * step;
        for (value, rate) in matter.iter_mut().zip(&rates.transport).skip(PLASTIC) {
            *value += step * rate;
        }
        if self.state.is_caloric() {
            // Where bodies touch, the pressure works on what comes from the other one, too.
            let shear = old.dot(&gradient);
            let power = shear - around.pressure * around.divergence;
            matter[ENERGY] += step * (power / around.density + rates.heating);
        }
        if self.strength == Strength::Elastic {
            store(&stress, matter);
            return 0.0;
        }
        let returned = self.strength.return_to_surface(
            von_mises(&stress),
            self.shear_modulus,
            matter[PLASTIC],
            matter[TEMPERATURE],
            step,
        );
        store(&(stress * returned.scale), matter);
        let work = returned.stress * returned.increment;
        matter[PLASTIC] += returned.increment;
        matter[TEMPERATURE] += self.heat.share * work / (around.density * self.heat.specific_heat);
        work
    }
}

/// A velocity gradient in three dimensions: plane strain in 2D, uniaxial strain in 1D.
fn in_three<const D: usize>(gradient: &Tensor<D>) -> Tensor<3> {
    Tensor::<3>::from_fn(|i, j| if i < D && j < D { gradient[(i, j)] } else { 0.0 })
}
