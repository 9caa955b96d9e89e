//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use multiversion::multiversion;

use super::fields::ColumnsMut;
use super::gather::Sums;
use super::{BODY_FORCE, MECHANISMS, Powers, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind};
use crate::parallel::{self, PerChunk};
use crate::schemes::momentum::{add_moments, momentum_components};
use crate::{Tensor, Vector};

impl<const D: usize> Upwind<D> {
    /// Writes the rates of all rows and the powers at their end.
    pub(super) fn pair_pass(&mut self, rate: &mut [f64]) {
        let settings = &self.settings;
        let (velocity, pressure) = (settings.tau_velocity > 0.0, settings.tau_pressure != 0.0);
        let rate_rows = match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => rate_rows::<D, false, false, false>,
            (true, false, false) => rate_rows::<D, true, false, false>,
            (false, true, false) => rate_rows::<D, false, true, false>,
            (true, true, false) => rate_rows::<D, true, true, false>,
            (true, false, true) => rate_rows::<D, true, false, true>,
            (false, true, true) => rate_rows::<D, false, true, true>,
            (true, true, true) => rate_rows::<D, true, true, true>,
        };
        let count = self.particles.len();
        let (own, tail) = ColumnsMut::<D>::of(rate, count);
        let mut powers = std::mem::take(&mut self.chunk_powers);
        let parts = (own, PerChunk(&mut powers));
        parallel::for_each_part(count, parts, |first, (mut own, PerChunk(powers))| {
            powers.fill(rate_rows(self, first, &mut own));
        });
        tail.fill(0.0);
        let (work, impulses) = tail.split_at_mut(MECHANISMS.len());
        let body_force = &mut impulses[..momentum_components(D).len()];
        for chunk in &powers {
            work.iter_mut().zip(chunk.work).for_each(|(total, part)| *total += part);
            body_force.iter_mut().zip(chunk.body_force).for_each(|(total, part)| *total += part);
        }
        self.chunk_powers = powers;
    }

    /// Turns the sums of particle a into its rates, which stand at place k of their columns.
    #[inline]
    fn write_row(
        &self,
        [a, k]: [usize; 2],
        sums: &Sums<f64, D>,
        own: &mut ColumnsMut<'_, D>,
        powers: &mut Powers,
    ) {
        let me = &self.sides[a];
        let (settings, volume) = (&self.settings, self.particles.volume[a]);
        let by_itself = me.cofactor * self.areas.diagonal(a) * me.pressure;
        let upwind_force = Vector::from(sums.upwind_force) * settings.tau_velocity;
        let upwind_volume_rate = sums.upwind_volume_rate * settings.tau_pressure;
        let gravity = self.body_acceleration[a];
        let mass = self.mass(a);
        let acceleration =
            (Vector::from(sums.internal_force) + by_itself + upwind_force) / mass + gravity;
        own.velocity[k] = acceleration;
        let deformation_rate =
            Tensor::<D>::from_fn(|i, j| sums.volume_deformation_rate[i][j] / volume);
        let dilatation = me.cofactor.dot(&deformation_rate);
        own.volume_ratio[k] = dilatation + upwind_volume_rate / volume;
        own.position[k] = me.velocity;
        own.deformation_gradient[k] = deformation_rate;
        let weight = gravity * mass;
        powers.work[BODY_FORCE] += weight.dot(&me.velocity);
        powers.work[UPWIND_VELOCITY] += upwind_force.dot(&me.velocity);
        powers.work[UPWIND_PRESSURE] -= me.pressure * upwind_volume_rate;
        add_moments(&me.position, &weight, &mut powers.body_force);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn rate_rows<
    const D: usize,
    const VELOCITY: bool,
    const PRESSURE: bool,
    const RECONSTRUCTION: bool,
>(
    scheme: &Upwind<D>,
    first: usize,
    own: &mut ColumnsMut<'_, D>,
) -> Powers {
    let mut powers = Powers::default();
    for k in 0..own.velocity.len() {
        let sums = scheme.gather::<VELOCITY, PRESSURE, RECONSTRUCTION>(first + k);
        scheme.write_row([first + k, k], &sums.total(), own, &mut powers);
    }
    powers
}
