//! The formulation as kick-drift-kick integrators see it: central differences.

use super::fields::ColumnsMut;
use super::{Elastodynamics, LEDGER};
use crate::schemes::{SplitScheme, solid};

impl<const D: usize> SplitScheme for Elastodynamics<D> {
    /// Two halves with the drift between are Elastodynamics (4.4), whose velocities are half way.
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (own, tail) = ColumnsMut::<D>::of(state, self.mass.len());
        solid::kick(own.velocity, own.kick, duration);
        LEDGER.kick(D, duration, tail);
    }

    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let (own, _) = ColumnsMut::<D>::of(state, self.mass.len());
        solid::drift(own.displacement, own.velocity, &self.prescribed, time, step);
    }

    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        let mut rate = std::mem::take(&mut self.rate);
        let totals = self.evaluate(time, state, &mut rate);
        self.store((time, &rate), totals, state);
        self.rate = rate;
    }
}
