//! A drift of a fluid: density, pressure and places.

use super::{Common, DensityRule, WeaklyCompressible};
use crate::schemes::transport_velocity::ledger::Drift;

impl<const D: usize> WeaklyCompressible<D> {
    /// The drift of a fluid with the rates of the last pass.
    pub(super) fn drift(&self, common: &Common<D>, step: f64, state: &mut [f64]) -> Drift {
        let evolves = common.settings.density == DensityRule::Continuity;
        let diffuses = !common.settings.is_algebraic();
        let compliance = self.compliance();
        let (own, _) = common.parts(state);
        let (places, begin) = (common.support.list().places(), common.first());
        common.team().sums_over_parts(places.len(), own, |first, own, sums: &mut Drift| {
            let moving = own.position.iter_mut().zip(own.velocity.iter().zip(&*own.deviation));
            for (k, (position, (velocity, deviation))) in moving.enumerate() {
                let number = begin + first + k;
                if common.is_wall[number] {
                    continue;
                }
                let place = places[first + k] as usize;
                if diffuses {
                    let (rates, mass) = (self.pressure_rates(common, place), common.mass[number]);
                    let rate = rates.iter().sum::<f64>();
                    let mean = own.pressure[k] + 0.5 * step * rate;
                    for (sum, rate) in sums.iter_mut().zip(rates) {
                        sum.power += step * mass * compliance * mean * rate;
                    }
                    own.pressure[k] += step * rate;
                }
                common.add_turning(number, step, [velocity, deviation], sums);
                if evolves {
                    own.density[k] += step * self.density_rate(common, place);
                }
                common.advect(step, position, velocity + deviation);
            }
        })
    }

    /// Energy of compression in J: `sum m p^2 / (2 rho0^2 c^2)`.
    pub(super) fn compression_energy(&self, common: &Common<D>, state: &[f64]) -> f64 {
        let (stiffness, at) = (self.compliance(), common.columns(state));
        let first = common.first();
        common.team().sums(common.count(), |row, sum: &mut f64| {
            let (number, pressure) = (first + row, at.pressure[row]);
            if !common.is_wall[number] {
                *sum += 0.5 * common.mass[number] * stiffness * pressure * pressure;
            }
        })
    }

    /// Rate of the density in kg/(m^3 s) of the particle at `place`.
    ///
    /// It takes part in the exchange of its pressure, theory (20): the two have the same rates
    /// then, but for `c^2`, and stay what the law of state says.
    pub(super) fn density_rate(&self, common: &Common<D>, place: usize) -> f64 {
        let rates = &self.rates[place];
        let exchange = rates.pressure_diffusion / self.fluid.wave_speed.powi(2);
        rates.density_transport - common.sides[place].density * rates.divergence + exchange
    }

    /// Rates of the pressure in Pa/s by compression, transport and diffusion.
    pub(super) fn pressure_rates(&self, common: &Common<D>, place: usize) -> [f64; 3] {
        let (rates, stiffness) = (&self.rates[place], self.fluid.wave_speed.powi(2));
        let compression = -common.sides[place].density * stiffness * rates.divergence;
        [compression, rates.pressure_transport, rates.pressure_diffusion]
    }
}
