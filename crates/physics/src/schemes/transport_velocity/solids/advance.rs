//! A drift of solids: density, stress, plastic strain, temperature and places.

use piola_formulas::hypoelastic::{Strength, advance, shear_energy, von_mises};

use super::{
    Common, ENERGY, Hypoelastic, Matter, PLASTIC, Solid, SolidRates, Stored, StoredMut,
    TEMPERATURE, full, store,
};
use crate::Tensor;
use crate::parallel;
use crate::schemes::transport_velocity::ledger::Drift;
use crate::schemes::transport_velocity::{ColumnsMut, Rates};

/// What a step brings to the matter of a particle besides its own rates.
struct Surroundings {
    density: f64,
    pressure: f64,
    /// `div u` in 1/s, contact included.
    divergence: f64,
    step: f64,
}

impl<const D: usize> Hypoelastic<D> {
    /// The drift of solids, CTVF (56) to (59), with the rates of the last pass: theory (33), (69) to (71).
    pub(super) fn drift(&self, common: &Common<D>, step: f64, state: &mut [f64]) -> Drift {
        let places = common.support.list().places();
        let (own, rest) = common.parts(state);
        let (stored, _) = StoredMut::<D>::of(rest, places.len());
        let begin = common.first();
        let evolves = !common.settings.is_algebraic();
        let drift = |[number, k]: [usize; 2],
                     own: &mut ColumnsMut<'_, D>,
                     matter: &mut Matter,
                     sums: &mut Drift| {
            let place = places[number - begin] as usize;
            let (side, rates) = (&common.sides[place], &self.rates[place]);
            let material = self.solid(common, number);
            let around = Surroundings {
                density: side.density,
                pressure: side.pressure,
                divergence: rates.common.divergence,
                step,
            };
            let energy = |density: f64, matter: &Matter| {
                let [compression, shear] = material.energies(density, matter);
                common.mass[number] * (compression + shear)
            };
            let before = energy(own.density[k], matter);
            let work = side.volume * material.advance(rates, &around, matter);
            let (velocity, deviation) = (&own.velocity[k], &own.deviation[k]);
            common.add_turning(number, step, [velocity, deviation], sums);
            let Rates { divergence, density_transport, .. } = rates.common;
            own.density[k] += step * (density_transport - side.density * divergence);
            if evolves {
                let stiffness = material.state.wave_speed.powi(2);
                let compression = -side.density * stiffness * divergence;
                let Rates { pressure_transport, pressure_diffusion, .. } = rates.common;
                let rate = compression + pressure_transport + pressure_diffusion;
                let pressure = &mut own.pressure[k];
                *pressure = (*pressure + step * rate).max(-material.state.spall_strength);
            }
            common.advect(step, &mut own.position[k], velocity + deviation);
            let [pressure, _, plasticity] = sums;
            pressure.power += energy(own.density[k], matter) - before + work;
            plasticity.power -= work;
        };
        let parts = (own, stored);
        common.team().sums_over_parts(places.len(), parts, |first, (mut own, mut stored), sums| {
            let first = begin + first;
            for k in (0..own.position.len()).filter(|k| !common.is_wall[first + k]) {
                let mut matter = stored.matter(k);
                drift([first + k, k], &mut own, &mut matter, sums);
                stored.set(k, &matter);
            }
        })
    }

    /// Energies of compression and shear in J.
    pub(super) fn elastic_energies(&self, common: &Common<D>, state: &[f64]) -> [f64; 2] {
        let (at, own) = (common.columns(state), Stored::in_state(common, state));
        parallel::sums(common.particles.len(), |number, sums: &mut [f64; 2]| {
            if !common.is_wall[number] {
                let (solid, density) = (self.solid(common, number), at.density[number]);
                let energies = solid.energies(density, &own.matter(number));
                for (sum, energy) in sums.iter_mut().zip(energies) {
                    *sum += common.mass[number] * energy;
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
