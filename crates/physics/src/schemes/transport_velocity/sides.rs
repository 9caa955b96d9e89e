//! What neighbours gather of a particle, filled from a state.

use piola_formulas::pairs::fluid;

use super::{Columns, Common};
use crate::{Vector, parallel};

/// A particle as its neighbours see it.
pub(super) type Side<const D: usize> = fluid::Side<f64, D>;

/// Takes what a state says of a particle (number) with a mass in kg.
#[inline]
fn take<const D: usize>(side: &mut Side<D>, mass: f64, at: &Columns<'_, D>, number: usize) {
    side.velocity = at.velocity[number];
    side.deviation = at.deviation[number];
    side.set(mass, at.density[number], at.pressure[number]);
}

impl<const D: usize> Common<D> {
    /// Fills the sides again where a new list has renewed the places since they were loaded.
    pub(super) fn follow_places(&mut self, builds: u64, state: &[f64]) {
        if self.support.list().builds() == builds {
            return;
        }
        let (list, mass, at) = (self.support.list(), &self.mass, self.columns(state));
        parallel::for_each_chunk(&mut self.sides, |first, sides| {
            for (side, &number) in sides.iter_mut().zip(&list.numbers()[first..]) {
                take(side, mass[number as usize], &at, number as usize);
            }
        });
        self.find_continua();
    }

    /// Finds the neighbours at the positions of `state` and fills the sides of all particles.
    /// Those of walls are completed by the pass over walls.
    pub(super) fn load(&mut self, state: &[f64]) {
        if !self.removed.is_empty() {
            self.follow_removals(state);
        }
        let at = self.columns(state);
        let (mass, sides) = (&self.mass, &mut self.sides);
        let updated = self.support.update_with(sides, |number, side| {
            take(side, mass[number], &at, number);
            at.position[number]
        });
        self.find_continua();
        self.lost = updated.is_err().then(|| {
            let lost = |position: &Vector<D>| !position.iter().all(|x| x.is_finite());
            at.position.iter().position(lost).unwrap_or(0)
        });
    }

    /// Fills what belongs to the places of particles, where a new list has renewed them.
    fn find_continua(&mut self) {
        let list = self.support.list();
        self.continua.follow(list, &self.particles.body, &self.particles.position, &self.is_wall);
    }
}
