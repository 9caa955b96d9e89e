//! The formulation as kick-drift-kick integrators see it: central differences.

use super::fields::ColumnsMut;
use super::{BODY_FORCE, DualSupport, LEDGER, PRESSURE, TRACTION};
use crate::schemes::ledger::Totals;
use crate::schemes::{SplitScheme, solid};
use crate::{Tensor, parallel};

impl<const D: usize> SplitScheme for DualSupport<D> {
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
        self.store((time, &rate), &self.strained.gradient, totals, state);
        self.rate = rate;
    }
}

impl<const D: usize> DualSupport<D> {
    /// Keeps what kicks need of the rates of `state` in it: accelerations, those of prescribed
    /// components zero, and the ledger with how fast the powers grow, force times acceleration.
    pub(super) fn store(
        &self,
        (time, rate): (f64, &[f64]),
        gradient: &[Tensor<D>],
        mut totals: Totals,
        state: &mut [f64],
    ) {
        let (own, tail) = ColumnsMut::<D>::of(state, self.mass.len());
        solid::keep_accelerations(own.kick, self.columns(rate).velocity, &self.prescribed);
        let kick = &*own.kick;
        let body = |a: usize| self.mass[a] * self.body_acceleration(a, time).dot(&kick[a]);
        totals.grow(BODY_FORCE, parallel::sum(self.mass.len(), body));
        let loads = self.loaded.iter();
        totals.grow(TRACTION, loads.map(|it| it.force(time).dot(&kick[it.particle])).sum());
        let pressures = self.pressed.iter().map(|part| {
            let force = part.force(time, &gradient[part.particle]);
            force.dot(&kick[part.particle])
        });
        totals.grow(PRESSURE, pressures.sum());
        LEDGER.keep(D, &totals, tail);
    }
}
