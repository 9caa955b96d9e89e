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
    /// Mass in kg.
    pub mass: f64,
}

impl<const D: usize> Default for Side<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        let (velocity, deviation) = (zero, zero);
        Self { velocity, deviation, density: 0.0, pressure: 0.0, load: 0.0, volume: 0.0, mass: 0.0 }
    }
}

impl<const D: usize> Side<D> {
    /// Sets density and pressure and what follows from them.
    #[inline]
    pub fn set(&mut self, density: f64, pressure: f64) {
        self.density = density;
        self.pressure = pressure;
        self.load = pressure / (density * density);
        self.volume = self.mass / density;
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Finds the neighbours at the positions of `state` and fills the sides of all particles.
    /// Those of walls are completed by the pass over walls.
    pub(super) fn load(&mut self, state: &[f64]) {
        if !self.removed.is_empty() {
            self.follow_removals(state);
        }
        let updated = self.support.update(|number| Row::<D>::position(Row::<D>::of(state, number)));
        self.lost = updated.is_err().then(|| {
            let lost = |row: &[f64]| !Row::<D>::position(row).iter().all(|x| x.is_finite());
            state.chunks_exact(Row::<D>::LENGTH).position(lost).unwrap_or(0)
        });
        let (list, mass) = (self.support.list(), &self.mass);
        let numbers = list.numbers();
        let fastest = parallel::maximum_of_chunks(&mut self.sides, 0.0, |first, sides| {
            let mut fastest = 0.0;
            for (side, &number) in sides.iter_mut().zip(&numbers[first..]) {
                let row = Row::<D>::of(state, number as usize);
                side.velocity = Row::<D>::velocity(row);
                side.deviation = Row::<D>::deviation(row);
                side.mass = mass[number as usize];
                side.set(row[Row::<D>::DENSITY], row[Row::<D>::PRESSURE]);
                if !list.is_passive_number(number as usize) {
                    fastest = parallel::larger(fastest, side.velocity.norm_squared());
                }
            }
            fastest
        });
        self.largest_speed = fastest.sqrt();
    }
}
