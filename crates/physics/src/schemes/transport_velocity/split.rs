//! The formulation as kick-drift-kick integrators see it, theory (33).

use super::ledger::Kick;
use super::stages::Instant;
use super::{ColumnsMut, Common, Continuum, Shifting, TransportVelocity};
use crate::fields::width;
use crate::schemes::SplitScheme;
use crate::schemes::ledger::Totals;
use crate::{Vector, parallel};

impl<const D: usize, M: Continuum<D>> SplitScheme for TransportVelocity<D, M> {
    #[inline(never)]
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        self.common.kick(duration, state);
        M::DESCRIPTION.ledger.kick(D, duration, self.tail(state));
    }

    #[inline(never)]
    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let middle = Instant { time: time + 0.5 * step, step };
        let mut stages = std::mem::take(&mut self.drift);
        let totals = stages.run(|pass, totals| self.run(pass, middle, state, totals));
        self.drift = stages;
        M::DESCRIPTION.ledger.add(D, &totals, self.tail(state));
    }

    #[inline(never)]
    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        let end = Instant { time, step: 0.0 };
        let mut stages = std::mem::take(&mut self.accelerate);
        let totals = stages.run(|pass, totals| self.run(pass, end, state, totals));
        self.accelerate = stages;
        M::DESCRIPTION.ledger.keep(D, &totals, self.tail(state));
    }
}

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// The ledger of a state and what stands behind it.
    pub(super) fn tail<'a>(&self, state: &'a mut [f64]) -> &'a mut [f64] {
        &mut state[self.common.count() * width(M::DESCRIPTION.fields, D)..]
    }

    /// IPST, of a state that has been loaded.
    pub(super) fn iterate(&mut self, step: f64, state: &mut [f64]) {
        let (common, matter) = (&self.common, &self.matter);
        let list = common.support.list();
        let own = parallel::maximum(list.owned(), 0.0, |place| match list.is_passive(place) {
            true => 0.0,
            false => matter.speed_squared(common, place),
        });
        let [square] = common.team().largest([own]);
        let passes = self.common.iterate_positions(square.sqrt(), step, state);
        M::DESCRIPTION.ledger.behind_mut(D, self.tail(state))[0] = passes;
    }
}

impl<const D: usize> Common<D> {
    /// Changes velocities by stored accelerations.
    fn kick(&self, duration: f64, state: &mut [f64]) {
        let (own, _) = self.parts(state);
        let (is_wall, kick) = (&self.is_wall[self.first()..], own.kick);
        parallel::for_each_chunk(own.velocity, |first, velocity| {
            for (row, velocity) in (first..).zip(velocity) {
                if !is_wall[row] {
                    *velocity += kick[row] * duration;
                }
            }
        });
    }

    /// Writes what the passes have found to the state, with the powers of all accelerations.
    pub(super) fn store<M: Continuum<D>>(&self, state: &mut [f64], totals: &mut Totals) {
        let (own, _) = self.parts(state);
        let (places, begin) = (self.support.list().places(), self.first());
        let sums: Kick = self.team().sums_over_parts(places.len(), own, |first, mut own, sums| {
            for k in 0..own.position.len() {
                let (number, place) = (begin + first + k, places[first + k] as usize);
                self.store_one([number, place, k], &mut own);
                if !self.is_wall[number] {
                    let at = [&own.position[k], &own.velocity[k]];
                    self.add_powers::<M>((number, place), at, sums);
                }
            }
        });
        for (entry, sum) in M::ACCELERATING.iter().zip(&sums) {
            entry.iter().for_each(|entry| totals.drive(*entry, sum));
        }
        if let Some(row) = self.lost.and_then(|number| self.row(number)) {
            self.parts(state).0.kick[row][0] = f64::NAN;
        }
    }

    /// Writes what the passes have found of a particle to entry k of columns.
    fn store_one(&self, [number, place, k]: [usize; 3], own: &mut ColumnsMut<'_, D>) {
        let (side, forces) = (&self.sides[place], &self.forces[place]);
        (own.density[k], own.pressure[k]) = (side.density, side.pressure);
        own.kick[k] = forces.total();
        if let (Shifting::Sun { .. }, false) = (self.settings.shifting, self.is_wall[number]) {
            own.deviation[k] = side.deviation;
        }
    }

    /// Adds the body forces to the accelerations.
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

    /// Moves walls as prescribed for a `step` in s with the velocities half way.
    pub(super) fn move_walls(&self, step: f64, middle: f64, state: &mut [f64]) {
        let (own, _) = self.parts(state);
        for entry in self.motion.iter() {
            if let Some(row) = self.row(self.walls[entry.particle].number as usize) {
                own.position[row][entry.component] += step * entry.at(middle);
            }
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
