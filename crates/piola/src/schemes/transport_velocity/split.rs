//! The formulation as kick-drift-kick integrators see it, theory (33).

use super::{DensityRule, PressureRule, Rates, Row, Shifting, TransportVelocity};
use crate::boundaries::BodyForce;
use crate::schemes::SplitScheme;
use crate::{Vector, parallel};

impl<const D: usize> SplitScheme for TransportVelocity<D> {
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (rows, tail) = self.parts(state);
        let is_wall = &self.is_wall;
        parallel::for_each_row(rows, Row::<D>::LENGTH, |number, row| {
            if !is_wall[number] {
                for axis in 0..D {
                    row[axis] += duration * row[Row::<D>::ACCELERATION + axis];
                }
            }
        });
        Self::book_kick(duration, tail);
    }

    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let middle = time + 0.5 * step;
        self.hold_velocities(middle, state);
        if let Shifting::Iterative { .. } = self.settings.shifting {
            self.iterate_positions(step, state);
        }
        self.load(state);
        self.push_apart(step, state);
        self.correct_gradients();
        self.wall_pass(middle);
        if self.solids.is_some() {
            self.rate_pass(middle);
            return self.drift_solids(step, middle, state);
        }
        let evolves = self.settings.density == DensityRule::Continuity;
        let diffuses = matches!(self.settings.pressure, PressureRule::Edac { .. });
        if evolves || diffuses {
            self.rate_pass(middle);
        }
        let (rows, tail) = self.parts(state);
        let (scheme, places) = (&*self, self.support.list().places());
        let sums = parallel::sums_over_rows(rows, Row::<D>::LENGTH, |number, row, sums| {
            if scheme.is_wall[number] {
                return;
            }
            let place = places[number] as usize;
            scheme.add_drift((number, place), (step, diffuses), row, sums);
            if evolves {
                row[Row::<D>::DENSITY] += step * scheme.density_rate(place);
            }
            if diffuses {
                row[Row::<D>::PRESSURE] += step * scheme.pressure_rates(place).iter().sum::<f64>();
            }
            scheme.move_row(step, row);
        });
        Self::book_drift(&sums, tail);
        self.move_walls(step, middle, state);
    }

    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        self.remove_escaped(state);
        let is_fluid = self.solids.is_none();
        let algebraic = is_fluid && self.settings.pressure == PressureRule::StateEquation;
        let before = if algebraic { self.compression_energy(state) } else { 0.0 };
        self.load(state);
        let fastest = self.update_density_and_pressure();
        self.correct_gradients();
        self.wall_pass(time);
        self.force_pass();
        self.add_body_forces(time);
        self.hold_accelerations();
        self.shift(fastest);
        self.hold_off();
        let (rows, tail) = self.parts(state);
        let (scheme, places) = (&*self, self.support.list().places());
        let sums = parallel::sums_over_rows(rows, Row::<D>::LENGTH, |number, row, sums| {
            let place = places[number] as usize;
            scheme.store(number, place, row);
            if !scheme.is_wall[number] {
                scheme.add_powers(number, place, row, sums);
            }
        });
        Self::book_powers(&sums, tail);
        if let Some(number) = self.lost {
            state[number * Row::<D>::LENGTH + Row::<D>::ACCELERATION] = f64::NAN;
        }
        if algebraic {
            let gained = self.compression_energy(state) - before;
            let (_, tail) = self.parts(state);
            Self::book_pressure(gained, tail);
        }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Writes what the passes have found of a particle to its row.
    fn store(&self, number: usize, place: usize, row: &mut [f64]) {
        let (side, forces) = (&self.sides[place], &self.forces[place]);
        row[Row::<D>::DENSITY] = side.density;
        row[Row::<D>::PRESSURE] = side.pressure;
        let acceleration = forces.total();
        row[Row::<D>::ACCELERATION..][..D].copy_from_slice(acceleration.as_slice());
        if let (Shifting::Sun { .. }, false) = (self.settings.shifting, self.is_wall[number]) {
            row[Row::<D>::DEVIATION..][..D].copy_from_slice(side.deviation.as_slice());
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
    pub(super) fn move_walls(&self, step: f64, middle: f64, rows: &mut [f64]) {
        for entry in self.motion.iter() {
            let number = self.walls[entry.particle].number as usize;
            let row = &mut rows[number * Row::<D>::LENGTH..][..Row::<D>::LENGTH];
            row[Row::<D>::POSITION + entry.component] +=
                step * entry.value.value(entry.place, middle);
        }
    }

    /// Moves the particle of a row along its transport velocity.
    pub(super) fn move_row(&self, step: f64, row: &mut [f64]) {
        for axis in 0..D {
            let velocity = row[axis] + row[Row::<D>::DEVIATION + axis];
            row[Row::<D>::POSITION + axis] += step * velocity;
        }
        self.wrap(row);
    }

    /// Moves the position of a row into the bounds of the domain.
    fn wrap(&self, row: &mut [f64]) {
        let domain = self.support.list().domain();
        if !domain.is_open() {
            let wrapped = domain.wrap(&Row::<D>::position(row));
            row[Row::<D>::POSITION..][..D].copy_from_slice(wrapped.as_slice());
        }
    }
}
