//! A drift of solids: density, stress, plastic strain, temperature and places.

use super::material::{Moved, Step};
use super::{Common, Hypoelastic, Matter, Stored, StoredMut};
use crate::parallel;
use crate::schemes::transport_velocity::ColumnsMut;
use crate::schemes::transport_velocity::ledger::Drift;

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
                     matter: Matter,
                     sums: &mut Drift| {
            let place = places[number - begin] as usize;
            let (side, rates) = (&common.sides[place], &self.rates[place]);
            let mut moved = Moved { density: own.density[k], pressure: own.pressure[k], matter };
            let span = Step { duration: step, mass: common.mass[number], evolves };
            let [gained, work] = self.solid(common, number).drift(rates, side, &span, &mut moved);
            let (velocity, deviation) = (&own.velocity[k], &own.deviation[k]);
            common.add_turning(number, step, [velocity, deviation], sums);
            (own.density[k], own.pressure[k]) = (moved.density, moved.pressure);
            common.advect(step, &mut own.position[k], velocity + deviation);
            let [pressure, _, plasticity, _] = sums;
            pressure.power += gained;
            plasticity.power -= work;
            moved.matter
        };
        let parts = (own, stored);
        common.team().sums_over_parts(places.len(), parts, |first, (mut own, mut stored), sums| {
            let first = begin + first;
            for k in (0..own.position.len()).filter(|k| !common.is_wall[first + k]) {
                let matter = drift([first + k, k], &mut own, stored.matter(k), sums);
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
