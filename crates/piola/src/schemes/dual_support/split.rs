//! The formulation as kick-drift-kick integrators see it: central differences.

use super::{BODY_FORCE, DualSupport, MECHANISMS, PRESSURE, Row, Side, TRACTION};
use crate::schemes::SplitScheme;
use crate::{Vector, parallel};

impl<const D: usize> SplitScheme for DualSupport<D> {
    /// Work is force times the mean of the velocities before and after, so that it is the change
    /// of the kinetic energy to round-off.
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (rows, tail) = state.split_at_mut(self.mass.len() * Row::<D>::LENGTH);
        parallel::for_each_row(rows, Row::<D>::LENGTH, |_, row| {
            for axis in 0..D {
                row[axis] += duration * row[Row::<D>::ACCELERATION + axis];
            }
        });
        let (sums, rest) = tail.split_at_mut(Self::ledger_length());
        let (rates, growths) = rest.split_at_mut(sums.len());
        // Of a power that grows evenly, that half way is the mean.
        let grow = |rates: &mut [f64]| {
            for (power, growth) in rates.iter_mut().zip(&growths[..MECHANISMS.len()]) {
                *power += 0.5 * duration * growth;
            }
        };
        grow(rates);
        for (sum, rate) in sums.iter_mut().zip(&*rates) {
            *sum += duration * rate;
        }
        grow(rates);
    }

    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let length = Row::<D>::LENGTH;
        let (rows, _) = state.split_at_mut(self.mass.len() * length);
        parallel::for_each_row(rows, length, |_, row| {
            for axis in 0..D {
                row[Row::<D>::DISPLACEMENT + axis] += step * row[axis];
            }
        });
        // Kicks leave a prescribed velocity alone; it moves its particle by its value half way.
        for entry in self.prescribed.iter() {
            let row = &mut rows[entry.particle * length..][..length];
            let middle = entry.value.value(entry.place, time + 0.5 * step);
            row[Row::<D>::DISPLACEMENT + entry.component] += step * (middle - row[entry.component]);
        }
    }

    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        self.load(state);
        self.discrete.forces(&self.displacement, &mut self.sides, &mut self.force);
        let mut rate = std::mem::take(&mut self.rate);
        self.external_pass(time, state, (&self.force, &self.sides), &mut rate);
        self.store(time, &rate, &self.sides, state);
        self.rate = rate;
    }
}

impl<const D: usize> DualSupport<D> {
    /// Keeps what kicks need of the rates of `state` in it: accelerations, those of prescribed
    /// components zero; rates of the ledger; and how fast the powers grow, force times acceleration.
    pub(super) fn store(&self, time: f64, rate: &[f64], sides: &[Side<f64, D>], state: &mut [f64]) {
        let length = Row::<D>::LENGTH;
        let rows = self.mass.len() * length;
        parallel::for_each_row(&mut state[..rows], length, |a, row| {
            row[Row::<D>::ACCELERATION..].copy_from_slice(&rate[a * length..][..D]);
        });
        for entry in self.prescribed.iter() {
            state[entry.particle * length + Row::<D>::ACCELERATION + entry.component] = 0.0;
        }
        let (rows, tail) = state.split_at_mut(rows);
        let acceleration = |a: usize| {
            Vector::<D>::from_column_slice(&rows[a * length + Row::<D>::ACCELERATION..][..D])
        };
        let body = parallel::sum(self.mass.len(), |a| {
            self.mass[a] * self.body_acceleration(a, time).dot(&acceleration(a))
        });
        let loads = self.loaded.iter();
        let traction = loads.map(|load| load.force(time).dot(&acceleration(load.particle))).sum();
        let pressures = self.pressed.iter().map(|part| {
            let force = part.force(time, &sides[part.particle].gradient);
            force.dot(&acceleration(part.particle))
        });
        let pressure = pressures.sum();
        let ledger = Self::ledger_length();
        tail[ledger..2 * ledger].copy_from_slice(&rate[rows.len()..][..ledger]);
        let growths = &mut tail[2 * ledger..][..MECHANISMS.len()];
        growths.fill(0.0);
        (growths[BODY_FORCE], growths[TRACTION]) = (body, traction);
        growths[PRESSURE] = pressure;
    }
}
