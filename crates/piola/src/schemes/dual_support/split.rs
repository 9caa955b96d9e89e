//! The formulation as kick-drift-kick integrators see it: central differences.

use super::fields::ColumnsMut;
use super::{BODY_FORCE, DualSupport, MECHANISMS, PRESSURE, Side, TRACTION};
use crate::parallel;
use crate::schemes::{Scheme, SplitScheme, solid};

impl<const D: usize> SplitScheme for DualSupport<D> {
    fn kick(&mut self, duration: f64, state: &mut [f64]) {
        let (own, tail) = ColumnsMut::<D>::of(state, self.mass.len());
        let lengths = (Self::ledger_length(), MECHANISMS.len());
        solid::kick(own.velocity, own.kick, tail, lengths, duration);
    }

    fn drift(&mut self, time: f64, step: f64, state: &mut [f64]) {
        let (own, _) = ColumnsMut::<D>::of(state, self.mass.len());
        solid::drift(own.displacement, own.velocity, &self.prescribed, time, step);
    }

    fn accelerate(&mut self, time: f64, state: &mut [f64]) {
        let mut rate = std::mem::take(&mut self.rate);
        self.rates(time, state, &mut rate);
        self.store(time, &rate, &self.sides, state);
        self.rate = rate;
    }
}

impl<const D: usize> DualSupport<D> {
    /// Keeps what kicks need of the rates of `state` in it: accelerations, those of prescribed
    /// components zero; rates of the ledger; and how fast the powers grow, force times acceleration.
    pub(super) fn store(&self, time: f64, rate: &[f64], sides: &[Side<f64, D>], state: &mut [f64]) {
        let rate = self.columns(rate);
        let (own, tail) = ColumnsMut::<D>::of(state, self.mass.len());
        parallel::copy(own.kick, rate.velocity);
        for entry in self.prescribed.iter() {
            own.kick[entry.particle][entry.component] = 0.0;
        }
        let kick = &*own.kick;
        let body = parallel::sum(self.mass.len(), |a| {
            self.mass[a] * self.body_acceleration(a, time).dot(&kick[a])
        });
        let loads = self.loaded.iter();
        let traction = loads.map(|load| load.force(time).dot(&kick[load.particle])).sum();
        let pressures = self.pressed.iter().map(|part| {
            let force = part.force(time, &sides[part.particle].gradient);
            force.dot(&kick[part.particle])
        });
        let pressure = pressures.sum();
        let ledger = Self::ledger_length();
        tail[ledger..2 * ledger].copy_from_slice(&rate.tail[..ledger]);
        let growths = &mut tail[2 * ledger..][..MECHANISMS.len()];
        growths.fill(0.0);
        (growths[BODY_FORCE], growths[TRACTION]) = (body, traction);
        growths[PRESSURE] = pressure;
    }
}
