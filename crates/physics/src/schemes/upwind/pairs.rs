//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use nalgebra::{SMatrix, SVector};
use piola_formulas::Number;
use piola_formulas::pairs::AreaPair;
use piola_formulas::pairs::upwind::{Exchange, ExchangeSum, ExchangeSums, Reconstructed, Side};

use super::fields::ColumnsMut;
use super::{
    BODY_FORCE, BOUNDARY_MOTION, Settings, TRACTION, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind,
};
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
        let close = |row, sums: &ExchangeSums<f64, D>, own: &mut _, found: &mut _| {
            self.write_row(row, sums, own, found);
        };
        let found = gather_parts(&self.team, pairs, (count, own), close, |_, _| {});
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
        let (gravity, mass) = (self.body_acceleration[a], self.mass(a));
        let diagonal = self.areas.diagonal(a);
        let body = Body { volume: self.particles.volume[a], mass, diagonal, gravity };
        let rates = rates(&self.settings, me, sums, &body);
        own.velocity[k] = rates.acceleration;
        own.volume_ratio[k] = rates.volume_ratio;
        own.position[k] = me.velocity;
        own.deformation_gradient[k] = rates.deformation;
        body_force.push(&me.position, &me.velocity, &(gravity * mass));
        let [velocity, pressure] = rates.dissipation;
        by_velocity.power += velocity;
        by_pressure.power -= pressure;
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

/// What of a particle its neighbours do not see.
pub(super) struct Body<T, const D: usize> {
    /// Volume in m^D.
    pub volume: T,
    /// Mass in kg.
    pub mass: T,
    /// `V_a G_aa` in m^(D-1).
    pub diagonal: SVector<T, D>,
    /// Acceleration by body forces in m/s^2.
    pub gravity: SVector<T, D>,
}

/// The rates of a particle.
pub(super) struct Rates<T, const D: usize> {
    /// That of the velocity in m/s^2.
    pub acceleration: SVector<T, D>,
    /// That of the evolved volume ratio in 1/s.
    pub volume_ratio: T,
    /// That of the deformation gradient in 1/s.
    pub deformation: SMatrix<T, D, D>,
    /// Powers in W of the velocity dissipation, and of the pressure dissipation with the other sign.
    pub dissipation: [T; 2],
}

/// Turns the sums of a particle into its rates, theory (8) to (13).
#[inline]
pub(super) fn rates<T: Number, const D: usize>(
    settings: &Settings,
    me: &Side<T, D>,
    sums: &ExchangeSums<T, D>,
    body: &Body<T, D>,
) -> Rates<T, D> {
    let by_itself = me.cofactor * body.diagonal * me.pressure;
    let upwind_force = sums.upwind_force.map(|force| force * settings.tau_velocity);
    let upwind_volume_rate = sums.upwind_volume_rate * settings.tau_pressure;
    let force = sums.internal_force + by_itself + upwind_force;
    let deformation = sums.volume_deformation_rate / body.volume;
    let dilatation = me.cofactor.dot(&deformation);
    Rates {
        acceleration: force / body.mass + body.gravity,
        volume_ratio: dilatation + upwind_volume_rate / body.volume,
        deformation,
        dissipation: [upwind_force.dot(&me.velocity), me.pressure * upwind_volume_rate],
    }
}
