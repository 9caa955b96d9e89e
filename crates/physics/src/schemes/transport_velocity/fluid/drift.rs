//! A drift of a fluid: density, pressure and places.

use piola_formulas::fluid;

use super::{Common, DensityRule, Fluid, Stored, WeaklyCompressible};
use crate::schemes::transport_velocity::ledger::Drift;

impl<const D: usize> WeaklyCompressible<D> {
    /// The drift of a fluid with the rates of the last pass, theory (20) and (21).
    ///
    /// The two equations have the same rates but for `c^2`, so that one is integrated and the law
    /// of state (25) gives the other. Side by side their difference would obey
    /// `d delta/dt = d . grad delta`, which nothing damps, and grow from round-off.
    pub(super) fn drift(&self, common: &Common<D>, step: f64, state: &mut [f64]) -> Drift {
        let evolves = common.settings.density == DensityRule::Continuity;
        let diffuses = !common.settings.is_algebraic();
        let (compliance, Fluid { density, wave_speed, .. }) = (self.compliance(), self.fluid);
        let (own, tail) = common.parts(state);
        let excess = Stored::<D>::of(tail, common.count()).excess;
        let relaxation = self.relaxation(common);
        let (places, begin) = (common.support.list().places(), common.first());
        common.team().sums_over_parts(places.len(), own, |first, own, sums: &mut Drift| {
            let moving = own.position.iter_mut().zip(own.velocity.iter().zip(&*own.deviation));
            for (k, (position, (velocity, deviation))) in moving.enumerate() {
                let number = begin + first + k;
                if common.is_wall[number] {
                    continue;
                }
                let place = places[first + k] as usize;
                let rates = self.pressure_rates(common, place, relaxation * excess[first + k]);
                let rate = rates.iter().sum::<f64>();
                if diffuses {
                    let mass = common.mass[number];
                    let mean = own.pressure[k] + 0.5 * step * rate;
                    for (sum, rate) in sums.iter_mut().zip(rates) {
                        sum.power += step * mass * compliance * mean * rate;
                    }
                    own.pressure[k] += step * rate;
                }
                common.add_turning(number, step, [velocity, deviation], sums);
                if evolves {
                    own.density[k] = match diffuses {
                        true => fluid::density(own.pressure[k], density, wave_speed),
                        false => own.density[k] + step * rate / wave_speed.powi(2),
                    };
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

    /// The rate in m^2/s^3 at which the pressure relaxes: of an excess of the summation density in kg/m^3, theory (108).
    pub(in super::super) fn relaxation(&self, common: &Common<D>) -> f64 {
        match common.settings.relaxes() {
            true => {
                let waves = self.fluid.wave_speed.powi(3) / common.support.smoothing_length();
                common.settings.density_relaxation * waves
            }
            false => 0.0,
        }
    }

    /// Rates of the pressure in Pa/s by compression, transport, diffusion, and relaxation, which is given. Over `c^2` they
    /// are those of the density.
    fn pressure_rates(&self, common: &Common<D>, place: usize, relaxing: f64) -> [f64; 4] {
        let (rates, stiffness) = (&self.rates[place], self.fluid.wave_speed.powi(2));
        let compression = -common.sides[place].density * stiffness * rates.divergence;
        [compression, rates.pressure_transport, rates.pressure_diffusion, relaxing]
    }
}
