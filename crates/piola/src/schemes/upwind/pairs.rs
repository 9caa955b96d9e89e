//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use multiversion::multiversion;

use super::fields::ColumnsMut;
use super::gather::Sums;
use super::{BODY_FORCE, BOUNDARY_MOTION, TRACTION, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind};
use crate::schemes::ledger::{Entry, Total, Totals};
use crate::schemes::outside::{Acted, prescribe, push};
use crate::{Tensor, Vector, parallel};

/// The mechanisms of the pass, in the order of its sums.
const MECHANISMS: [Entry; 3] = [BODY_FORCE, UPWIND_VELOCITY, UPWIND_PRESSURE];

impl<const D: usize> Upwind<D> {
    /// Writes the rates of all rows.
    pub(super) fn pair_pass(&self, rate: &mut [f64], totals: &mut Totals) {
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
        let (own, _) = ColumnsMut::<D>::of(rate, count);
        let sums = parallel::sums_over_parts(count, own, |first, mut own, sums| {
            rate_rows(self, first, &mut own, sums);
        });
        MECHANISMS.iter().zip(&sums).for_each(|(entry, sum)| totals.drive(*entry, sum));
    }

    /// Adds tractions and replaces the acceleration of prescribed components by the rate of
    /// their value, with the power and the momentum of both.
    pub(super) fn boundary_pass(&self, time: f64, rate: &mut [f64], totals: &mut Totals) {
        let (own, _) = ColumnsMut::<D>::of(rate, self.particles.len());
        let particle = |a: usize| Acted {
            mass: self.mass(a),
            position: self.sides[a].position,
            velocity: self.sides[a].velocity,
        };
        let [mut traction, mut boundary] = [Total::default(); 2];
        let loads = self.loaded.iter().map(|load| (load.particle, load.force(time)));
        push(loads, particle, own.velocity, &mut traction);
        prescribe(&self.prescribed, time, particle, own.velocity, &mut boundary);
        totals.drive(TRACTION, &traction);
        totals.drive(BOUNDARY_MOTION, &boundary);
    }

    /// Turns the sums of particle a into its rates, which stand at place k of their columns.
    #[inline]
    fn write_row(
        &self,
        [a, k]: [usize; 2],
        sums: &Sums<f64, D>,
        own: &mut ColumnsMut<'_, D>,
        [body_force, by_velocity, by_pressure]: &mut [Total; MECHANISMS.len()],
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
        body_force.push(&me.position, &me.velocity, &(gravity * mass));
        by_velocity.power += upwind_force.dot(&me.velocity);
        by_pressure.power -= me.pressure * upwind_volume_rate;
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
    totals: &mut [Total; MECHANISMS.len()],
) {
    for k in 0..own.velocity.len() {
        let sums = scheme.gather::<VELOCITY, PRESSURE, RECONSTRUCTION>(first + k);
        scheme.write_row([first + k, k], &sums.total(), own, totals);
    }
}
