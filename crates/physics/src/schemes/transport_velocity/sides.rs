//! What neighbours gather of a particle, filled from a state.

use piola_formulas::pairs::fluid;

use super::common::weigh;
use super::{Columns, Common};
use crate::{Vector, parallel};

/// A particle as its neighbours see it.
pub(super) type Side<const D: usize> = fluid::Side<f64, D>;

/// Takes what a state says of a particle (row), with its mass in kg or the volume that it fills in m^D.
#[inline]
fn take<const D: usize>(
    side: &mut Side<D>,
    (amount, fills): (f64, bool),
    at: &Columns<'_, D>,
    row: usize,
) {
    side.velocity = at.velocity[row];
    side.deviation = at.deviation[row];
    let density = at.density[row];
    side.set(weigh(amount, fills, density), density, at.pressure[row]);
}

impl<const D: usize> Common<D> {
    /// Fills the sides again where a new list has renewed the places since they were loaded.
    pub(super) fn follow_places(&mut self, builds: u64, state: &[f64]) {
        if self.support.list().builds() == builds {
            return;
        }
        self.make_room();
        let (list, mass, at) = (self.support.list(), &self.mass, self.columns(state));
        let (begin, bodies, fills) = (self.first(), &self.particles.body, &self.fills);
        parallel::for_each_chunk(&mut self.sides[..list.owned()], |first, sides| {
            for (side, &number) in sides.iter_mut().zip(&list.numbers()[first..]) {
                let number = number as usize;
                let fills = fills[bodies[number] as usize];
                take(side, (mass[number], fills), &at, number - begin);
            }
        });
        self.show_sides();
        self.find_continua();
    }

    /// Finds the neighbours at the positions of `state` and fills the sides of all particles.
    /// Those of walls are completed by the pass over walls.
    pub(super) fn load(&mut self, state: &[f64]) {
        self.find_neighbors(state);
        self.show_sides();
    }

    /// The same for those who need no sides of copies.
    pub(super) fn find_neighbors(&mut self, state: &[f64]) {
        if !self.removed.is_empty() {
            self.follow_removals(state);
        }
        let (at, begin, owned) = (self.columns(state), self.first(), self.count());
        let (mass, sides) = (&self.mass, &mut self.sides[..owned]);
        let (bodies, fills) = (&self.particles.body, &self.fills);
        let updated = self.support.update_with(sides, |number, side| {
            take(side, (mass[number], fills[bodies[number] as usize]), &at, number - begin);
            at.position[number - begin]
        });
        self.make_room();
        self.find_continua();
        self.lost = updated.is_err().then(|| {
            let lost = |position: &Vector<D>| !position.iter().all(|x| x.is_finite());
            let own = at.position.iter().position(lost).map(|row| begin + row);
            self.team().least(own).unwrap_or(0)
        });
    }

    /// Fills what belongs to the places of particles, where a new list has renewed them.
    fn find_continua(&mut self) {
        let list = self.support.list();
        self.continua.follow(list, &self.particles.body, &self.particles.position, &self.is_wall);
    }
}
