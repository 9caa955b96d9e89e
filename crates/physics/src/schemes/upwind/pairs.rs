//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use piola_formulas::pairs::AreaPair;
use piola_formulas::pairs::upwind::{Exchange, ExchangeSum, ExchangeSums, Reconstructed};

use super::fields::ColumnsMut;
use super::{BODY_FORCE, BOUNDARY_MOTION, TRACTION, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind};
use crate::operators::{Among, FrozenRows, Sum, Term, gather_parts};
use crate::parallel::ExactSums;
use crate::schemes::ledger::{Entry, Total, Totals};
use crate::schemes::outside::{Acted, prescribe, push};

/// The mechanisms of the pass, in the order of its sums.
const MECHANISMS: [Entry; 3] = [BODY_FORCE, UPWIND_VELOCITY, UPWIND_PRESSURE];

impl<const D: usize> Upwind<D> {
    /// Writes the rates of all rows.
    pub(super) fn pair_pass(&self, rate: &mut [f64], totals: &mut Totals) {
        let settings = &self.settings;
        let (velocity, pressure) = (settings.tau_velocity > 0.0, settings.tau_pressure != 0.0);
        match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => self.exchange::<false, false>(rate, totals),
            (true, false, false) => self.exchange::<true, false>(rate, totals),
            (false, true, false) => self.exchange::<false, true>(rate, totals),
            (true, true, false) => self.exchange::<true, true>(rate, totals),
            (true, false, true) => self.reconstructed::<true, false>(rate, totals),
            (false, true, true) => self.reconstructed::<false, true>(rate, totals),
            (true, true, true) => self.reconstructed::<true, true>(rate, totals),
        }
    }

    fn exchange<const VELOCITY: bool, const PRESSURE: bool>(
        &self,
        rate: &mut [f64],
        totals: &mut Totals,
    ) {
        let law = Exchange::<D, VELOCITY, PRESSURE>(self.periods());
        self.write_rates(&Term { law, source: &*self.sides, among: Among::All }, rate, totals);
    }

    fn reconstructed<const VELOCITY: bool, const PRESSURE: bool>(
        &self,
        rate: &mut [f64],
        totals: &mut Totals,
    ) {
        let law = Reconstructed(Exchange::<D, VELOCITY, PRESSURE>(self.periods()));
        let source = (&*self.sides, &*self.slopes);
        self.write_rates(&Term { law, source, among: Among::All }, rate, totals);
    }

    fn write_rates(
        &self,
        sum: &impl Sum<FrozenRows<AreaPair<D>>, Sums = ExchangeSum<D>>,
        rate: &mut [f64],
        totals: &mut Totals,
    ) {
        let count = self.particles.len();
        let (own, _) = ColumnsMut::<D>::of(rate, count);
        let pairs = (&self.areas.pairs, sum);
        let found = gather_parts(&self.team, pairs, (count, own), |row, sums, own, found| {
            self.write_row(row, sums, own, found);
        });
        MECHANISMS.iter().zip(&found).for_each(|(entry, sum)| totals.drive(*entry, sum));
    }

    /// Turns the sums of particle a into its rates, which stand at place k of their columns.
    #[inline]
    fn write_row(
        &self,
        [a, k]: [usize; 2],
        sums: &ExchangeSums<f64, D>,
        own: &mut ColumnsMut<'_, D>,
        [body_force, by_velocity, by_pressure]: &mut [Total; MECHANISMS.len()],
    ) {
        let me = &self.sides[a];
        let (settings, volume) = (&self.settings, self.particles.volume[a]);
        let by_itself = me.cofactor * self.areas.diagonal(a) * me.pressure;
        let upwind_force = sums.upwind_force * settings.tau_velocity;
        let upwind_volume_rate = sums.upwind_volume_rate * settings.tau_pressure;
        let gravity = self.body_acceleration[a];
        let mass = self.mass(a);
        let acceleration = (sums.internal_force + by_itself + upwind_force) / mass + gravity;
        own.velocity[k] = acceleration;
        let deformation_rate = sums.volume_deformation_rate / volume;
        let dilatation = me.cofactor.dot(&deformation_rate);
        own.volume_ratio[k] = dilatation + upwind_volume_rate / volume;
        own.position[k] = me.velocity;
        own.deformation_gradient[k] = deformation_rate;
        body_force.push(&me.position, &me.velocity, &(gravity * mass));
        by_velocity.power += upwind_force.dot(&me.velocity);
        by_pressure.power -= me.pressure * upwind_volume_rate;
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
        let [mut traction, mut boundary] = [const { ExactSums::NONE }; 2];
        let loads = self.loaded.iter().map(|load| (load.particle, load.force(time)));
        push(loads, particle, own.velocity, &mut traction);
        prescribe(&self.prescribed, time, particle, own.velocity, &mut boundary);
        let [traction, boundary] = match self.is_driven {
            true => self.team.close_all([traction, boundary]),
            false => Default::default(),
        };
        totals.drive(TRACTION, &traction);
        totals.drive(BOUNDARY_MOTION, &boundary);
    }
}
