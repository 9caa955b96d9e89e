//! The three-stage strong-stability-preserving Runge-Kutta method.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use super::tvd_rk2::predict;
use crate::parallel;
use crate::schemes::Scheme;

/// `u1 = u + dt f(u, t)`, `u2 = 3/4 u + 1/4 (u1 + dt f(u1, t + dt))`,
/// `u_new = 1/3 u + 2/3 (u2 + dt f(u2, t + dt/2))`, of Shu and Osher.
///
/// Third order. An undamped mode of angular frequency w loses the share `z^4 / 12 - z^6 / 36`,
/// z = w dt, of its energy a step, up to `z = sqrt(3)`, from where on it grows.
pub struct SspRk3 {
    rate: Vec<f64>,
}

impl SspRk3 {
    /// A method for states of `length` numbers.
    pub fn new(length: usize) -> Self {
        Self { rate: vec![0.0; length] }
    }
}

/// A later stage, `new = old + share (new + step rate - old)`.
fn blend(share: f64, step: f64, old: &[f64], rate: &[f64], new: &mut [f64]) {
    parallel::for_each_chunk(new, |first, new| {
        let parts = old[first..].iter().zip(&rate[first..]);
        for (new, (old, rate)) in new.iter_mut().zip(parts) {
            *new = old + share * (*new + step * rate - old);
        }
    });
}

impl Integrator for SspRk3 {
    fn name(&self) -> &'static str {
        "ssp_rk3"
    }

    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        3
    }

    fn serves(&self, scheme: &mut dyn Scheme) -> bool {
        scheme.has_rates()
    }

    fn energy_factor(&self, phase: f64) -> Option<f64> {
        let square = phase * phase;
        Some(1.0 + square * square * (square / 36.0 - 1.0 / 12.0))
    }

    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        if !scheme.has_rates() {
            return Err(Unserved::new(self.name(), scheme).into());
        }
        scheme.rates(time, old, &mut self.rate);
        predict(step, old, &self.rate, new);
        scheme.constrain(time + step, new);
        scheme.rates(time + step, new, &mut self.rate);
        blend(0.25, step, old, &self.rate, new);
        scheme.constrain(time + 0.5 * step, new);
        scheme.rates(time + 0.5 * step, new, &mut self.rate);
        blend(2.0 / 3.0, step, old, &self.rate, new);
        scheme.constrain(time + step, new);
        Ok(())
    }
}
