//! What neighbours gather of a particle, filled from a state.

use piola_formulas::pairs::fluid;

use super::{Row, TransportVelocity};
use crate::parallel;

/// A particle as its neighbours see it.
pub(super) type Side<const D: usize> = fluid::Side<f64, D>;

/// Takes what stands in a row of the state of a particle with a mass in kg.
#[inline]
fn take<const D: usize>(side: &mut Side<D>, mass: f64, row: &[f64]) {
    side.velocity = Row::<D>::velocity(row);
    side.deviation = Row::<D>::deviation(row);
    side.set(mass, row[Row::<D>::DENSITY], row[Row::<D>::PRESSURE]);
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills the sides again where a new list has renewed the places since they were loaded.
    pub(super) fn follow_places(&mut self, builds: u64, state: &[f64]) {
        if self.support.list().builds() == builds {
            return;
        }
        let (list, mass) = (self.support.list(), &self.mass);
        parallel::for_each_chunk(&mut self.sides, |first, sides| {
            for (side, &number) in sides.iter_mut().zip(&list.numbers()[first..]) {
                let row = Row::<D>::of(state, number as usize);
                take(side, mass[number as usize], row);
            }
        });
        self.load_matter(state);
    }

    /// Finds the neighbours at the positions of `state` and fills the sides of all particles.
    /// Those of walls are completed by the pass over walls.
    pub(super) fn load(&mut self, state: &[f64]) {
        if !self.removed.is_empty() {
            self.follow_removals(state);
        }
        let (mass, sides) = (&self.mass, &mut self.sides);
        let updated = self.support.update_with(sides, |number, side| {
            let row = Row::<D>::of(state, number);
            take(side, mass[number], row);
            Row::<D>::position(row)
        });
        self.load_matter(state);
        self.lost = updated.is_err().then(|| {
            let lost = |row: &[f64]| !Row::<D>::position(row).iter().all(|x| x.is_finite());
            state.chunks_exact(Row::<D>::LENGTH).position(lost).unwrap_or(0)
        });
    }
}
