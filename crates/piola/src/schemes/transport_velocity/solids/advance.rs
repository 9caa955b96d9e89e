//! A drift of solids: density, stress, plastic strain, temperature and places.

use piola_formulas::hypoelastic::{advance, von_mises};

use super::{ENERGY, MATTER, PLASTIC, Solid, SolidRates, TEMPERATURE, full, store};
use crate::Tensor;
use crate::parallel;
use crate::schemes::transport_velocity::ledger::Tail;
use crate::schemes::transport_velocity::{PressureRule, Row, TransportVelocity};

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
    pub(in super::super) fn drift_solids(&mut self, step: f64, middle: f64, state: &mut [f64]) {
        let before = self.elastic_energy(state);
        let start = self.matter_start();
        let (front, matter) = state.split_at_mut(start);
        let scheme = &*self;
        let Some(solids) = &scheme.solids else { return };
        let (places, rates) = (scheme.support.list().places(), &solids.rates);
        let [work] = parallel::sums_over_rows(matter, MATTER, |number, row, [work]| {
            if scheme.is_wall[number] {
                return;
            }
            let place = places[number] as usize;
            let (side, material) =
                (&scheme.sides[place], &solids.materials[scheme.particles.body[number] as usize]);
            let around = Surroundings {
                density: side.density,
                pressure: side.pressure,
                divergence: scheme.rates[place].divergence,
                step,
            };
            *work += side.volume * material.advance(&rates[place], &around, row);
        });
        let evolves = matches!(scheme.settings.pressure, PressureRule::Edac { .. });
        let (rows, tail) = front.split_at_mut(scheme.particles.len() * Row::<D>::LENGTH);
        let sums = parallel::sums_over_rows(rows, Row::<D>::LENGTH, |number, row, sums| {
            if scheme.is_wall[number] {
                return;
            }
            let place = places[number] as usize;
            scheme.add_drift((number, place), (step, false), row, sums);
            row[Row::<D>::DENSITY] += step * scheme.density_rate(place);
            if evolves {
                row[Row::<D>::PRESSURE] += step * scheme.pressure_rates(place).iter().sum::<f64>();
            }
            scheme.move_row(step, row);
        });
        Self::book_drift(&sums, tail);
        self.move_walls(step, middle, front);
        let gained = self.elastic_energy(state) - before;
        let tail = &mut state[start - Tail::new(D).length()..start];
        Self::book_pressure(gained + work, tail);
        Self::book_plasticity(-work, tail);
    }

    /// Elastic energy of all solids in J.
    pub(in super::super) fn elastic_energy(&self, state: &[f64]) -> f64 {
        self.energies_of_solids(state).iter().sum()
    }

    /// Energies of compression and shear in J.
    pub(in super::super) fn energies_of_solids(&self, state: &[f64]) -> [f64; 2] {
        parallel::sums(self.particles.len(), |number, sums: &mut [f64; 2]| {
            if !self.is_wall[number] {
                for (sum, energy) in sums.iter_mut().zip(self.specific_energies(number, state)) {
                    *sum += self.mass[number] * energy;
                }
            }
        })
    }
}

impl Solid {
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
