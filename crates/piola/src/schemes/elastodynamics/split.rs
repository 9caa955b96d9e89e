//! The formulation as kick-drift-kick integrators see it: central differences.

use super::{Elastodynamics, MECHANISMS};
use crate::schemes::solid::Row;
use crate::schemes::{SplitScheme, solid};

impl<const D: usize> SplitScheme for Elastodynamics<D> {
    /// Two halves with the drift between are Elastodynamics (4.4), whose velocities are half way.
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
        self.evaluate(time);
        let mut rate = std::mem::take(&mut self.rate);
        self.external_pass(time, &mut rate);
        self.store(time, &rate, state);
        self.rate = rate;
    }
}
