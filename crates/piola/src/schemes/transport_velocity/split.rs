//! The formulation as kick-drift-kick integrators see it, theory (33).

use super::ledger::{Drift, Kick};
use super::stages::Instant;
use super::{
    ACCELERATING, ColumnsMut, DRIFTING, DensityRule, LEDGER, PRESSURE, Rates, Shifting,
    TransportVelocity,
};
use crate::boundaries::BodyForce;
use crate::schemes::SplitScheme;
use crate::schemes::ledger::{Total, Totals};
use crate::{Vector, parallel};

impl<const D: usize> SplitScheme for TransportVelocity<D> {
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (own, tail) = self.parts(state);
        let (is_wall, kick) = (&self.is_wall, own.kick);
        parallel::for_each_chunk(own.velocity, |first, velocity| {
            for (number, velocity) in (first..).zip(velocity) {
                if !is_wall[number] {
                    *velocity += kick[number] * duration;
                }
            }
        });
        LEDGER.kick(D, duration, tail);
    }

    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let middle = Instant { time: time + 0.5 * step, step };
        let mut stages = std::mem::take(&mut self.drift);
        let totals = stages.run(|pass, totals| self.run(pass, middle, state, totals));
        self.drift = stages;
        LEDGER.add(D, &totals, self.parts(state).1);
    }

    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        let end = Instant { time, step: 0.0 };
        let mut stages = std::mem::take(&mut self.accelerate);
        let totals = stages.run(|pass, totals| self.run(pass, end, state, totals));
        self.accelerate = stages;
        LEDGER.keep(D, &totals, self.parts(state).1);
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Moves particles with the rates of the last pass, half way through a step in s at a time in s.
    pub(super) fn move_particles(
        &mut self,
        middle: f64,
        step: f64,
        state: &mut [f64],
        totals: &mut Totals,
    ) {
        let sums = match self.solids {
            Some(_) => self.drift_solids(step, state),
            None => self.drift_fluid(step, state),
        };
        DRIFTING.iter().zip(&sums).for_each(|(entry, sum)| totals.book(*entry, sum));
        self.move_walls(step, middle, state);
    }

    /// The drift of a fluid.
    fn drift_fluid(&mut self, step: f64, state: &mut [f64]) -> Drift {
        let evolves = self.settings.density == DensityRule::Continuity;
        let diffuses = !self.settings.is_algebraic();
        let (own, _) = self.parts(state);
        let (scheme, places) = (&*self, self.support.list().places());
        let count = places.len();
        parallel::sums_over_parts(count, own, |first, own, sums| {
            let moving = own.position.iter_mut().zip(own.velocity.iter().zip(&*own.deviation));
            for (k, (position, (velocity, deviation))) in moving.enumerate() {
                let number = first + k;
                if scheme.is_wall[number] {
                    continue;
                }
                let place = places[number] as usize;
                let before = (own.pressure[k], velocity, deviation);
                scheme.add_drift((number, place), (step, diffuses), before, sums);
                if evolves {
                    own.density[k] += step * scheme.density_rate(place);
                }
                if diffuses {
                    own.pressure[k] += step * scheme.pressure_rates(place).iter().sum::<f64>();
                }
                scheme.advect(step, position, velocity + deviation);
            }
        })
    }

    /// Writes what the passes have found to the state, with the powers of all accelerations.
    pub(super) fn store_all(&mut self, state: &mut [f64], totals: &mut Totals) {
        let follows = self.solids.is_none() && self.settings.is_algebraic();
        let before = if follows { self.compression_energy(state) } else { 0.0 };
        let (own, _) = self.parts(state);
        let (scheme, places) = (&*self, self.support.list().places());
        let sums: Kick = parallel::sums_over_parts(places.len(), own, |first, mut own, sums| {
            for k in 0..own.position.len() {
                let (number, place) = (first + k, places[first + k] as usize);
                scheme.store([number, place, k], &mut own);
                if !scheme.is_wall[number] {
                    let at = [&own.position[k], &own.velocity[k]];
                    scheme.add_powers((number, place), at, sums);
                }
            }
        });
        ACCELERATING.iter().zip(&sums).for_each(|(entry, sum)| totals.drive(*entry, sum));
        if let Some(number) = self.lost {
            self.parts(state).0.kick[number][0] = f64::NAN;
        }
        if follows {
            let gained = self.compression_energy(state) - before;
            totals.book(PRESSURE, &Total::of(gained));
        }
    }

    /// Writes what the passes have found of a particle to entry k of columns.
    fn store(&self, [number, place, k]: [usize; 3], own: &mut ColumnsMut<'_, D>) {
        let (side, forces) = (&self.sides[place], &self.forces[place]);
        (own.density[k], own.pressure[k]) = (side.density, side.pressure);
        own.kick[k] = forces.total();
        if let (Shifting::Sun { .. }, false) = (self.settings.shifting, self.is_wall[number]) {
            own.deviation[k] = side.deviation;
        }
    }

    /// The rates that the last pass has found at a place.
    pub(super) fn rates_at(&self, place: usize) -> &Rates {
        match &self.solids {
            Some(solids) => solids.rates_at(place),
            None => &self.rates[place],
        }
    }

    /// Rate of the density in kg/(m^3 s) of the particle at `place`.
    ///
    /// A fluid's takes part in the exchange of its pressure, theory (20): the two have the same rates
    /// then, but for `c^2`, and stay what the law of state says.
    pub(super) fn density_rate(&self, place: usize) -> f64 {
        let rates = self.rates_at(place);
        let exchange = match self.solids {
            Some(_) => 0.0,
            None => rates.pressure_diffusion / self.fluid.wave_speed.powi(2),
        };
        rates.density_transport - self.sides[place].density * rates.divergence + exchange
    }

    /// Rates of the pressure in Pa/s by compression, transport and diffusion.
    pub(super) fn pressure_rates(&self, place: usize) -> [f64; 3] {
        let number = self.support.list().numbers()[place] as usize;
        let (rates, stiffness) = (self.rates_at(place), self.reference_wave_speed(number).powi(2));
        let compression = -self.sides[place].density * stiffness * rates.divergence;
        [compression, rates.pressure_transport, rates.pressure_diffusion]
    }

    /// Adds the body forces to the accelerations of the fluid.
    pub(super) fn add_body_forces(&mut self, time: f64) {
        if self.body_forces.is_empty() {
            return;
        }
        let mut forces = std::mem::take(&mut self.forces);
        let list = self.support.list();
        parallel::for_each_chunk(&mut forces, |first, rows| {
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                if !list.is_passive(place) {
                    let number = list.numbers()[place] as usize;
                    row.body_force = self.body_force_at(number, place, time);
                }
            }
        });
        self.forces = forces;
    }

    /// The body forces in m/s^2 at a particle, where it is now.
    pub(super) fn body_force_at(&self, number: usize, place: usize, time: f64) -> Vector<D> {
        let position = &self.support.list().positions()[place];
        BodyForce::sum(&self.body_forces, self.particles.body[number], position, time)
    }

    /// Moves walls as prescribed for a `step` in s with the velocities half way.
    pub(super) fn move_walls(&self, step: f64, middle: f64, state: &mut [f64]) {
        let (own, _) = self.parts(state);
        for entry in self.motion.iter() {
            let number = self.walls[entry.particle].number as usize;
            own.position[number][entry.component] += step * entry.value.value(entry.place, middle);
        }
    }

    /// Moves a particle with a velocity, inside of the bounds of the domain.
    pub(super) fn advect(&self, step: f64, position: &mut Vector<D>, velocity: Vector<D>) {
        *position += velocity * step;
        let domain = self.support.list().domain();
        if !domain.is_open() {
            *position = domain.wrap(position);
        }
    }
}
