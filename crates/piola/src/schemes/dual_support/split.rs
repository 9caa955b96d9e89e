//! The formulation as kick-drift-kick integrators see it: central differences.

use super::{BODY_FORCE, DualSupport, MECHANISMS, PRESSURE, Row, Side, TRACTION};
use crate::schemes::{SplitScheme, solid};
use crate::{Vector, parallel};

impl<const D: usize> SplitScheme for DualSupport<D> {
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (rows, tail) = state.split_at_mut(self.mass.len() * Row::<D>::LENGTH);
        solid::kick::<D>(rows, tail, (Self::ledger_length(), MECHANISMS.len()), duration);
    }

    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let (rows, _) = state.split_at_mut(self.mass.len() * Row::<D>::LENGTH);
        solid::drift::<D>(rows, &self.prescribed, time, step);
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
