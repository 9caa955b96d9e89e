//! What neighbours gather of a particle, filled from a state.

use super::{Row, TransportVelocity};
use crate::{Vector, parallel};

/// A particle as its neighbours see it, in one place so that it costs one stretch of memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<const D: usize> {
    /// Momentum velocity u in m/s; of a wall particle that of CTVF (48).
    pub velocity: Vector<D>,
    /// Deviation d = uhat - u of the transport velocity in m/s.
    pub deviation: Vector<D>,
    /// Density in kg/m^3.
    pub density: f64,
    /// Pressure in Pa.
    pub pressure: f64,
    /// `p / rho^2` in Pa m^6/kg^2.
    pub load: f64,
    /// `m / rho` in m^D.
    pub volume: f64,
}

impl<const D: usize> Default for Side<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        let (velocity, deviation) = (zero, zero);
        Self { velocity, deviation, density: 0.0, pressure: 0.0, load: 0.0, volume: 0.0 }
    }
}

impl<const D: usize> Side<D> {
    /// Mass in kg.
    #[inline]
    pub fn mass(&self) -> f64 {
        self.volume * self.density
    }

    /// Takes what stands in a row of the state of a particle with a mass in kg.
    #[inline]
    fn take(&mut self, mass: f64, row: &[f64]) {
        self.velocity = Row::<D>::velocity(row);
        self.deviation = Row::<D>::deviation(row);
        self.set(mass, row[Row::<D>::DENSITY], row[Row::<D>::PRESSURE]);
    }

    /// Sets density and pressure and what follows from them and the mass in kg.
    #[inline]
    pub fn set(&mut self, mass: f64, density: f64, pressure: f64) {
        self.density = density;
        self.pressure = pressure;
        self.load = pressure / (density * density);
        self.volume = mass / density;
    }
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
                side.take(mass[number as usize], row);
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
            side.take(mass[number], row);
            Row::<D>::position(row)
        });
        self.load_matter(state);
        self.lost = updated.is_err().then(|| {
            let lost = |row: &[f64]| !Row::<D>::position(row).iter().all(|x| x.is_finite());
            state.chunks_exact(Row::<D>::LENGTH).position(lost).unwrap_or(0)
        });
    }
}
