//! The two-stage total-variation-diminishing Runge-Kutta method.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use crate::parallel;
use crate::schemes::Scheme;

/// `u* = u + dt f(u, t)`, `u** = u* + dt f(u*, t + dt)`, `u_new = (u + u**) / 2`,
/// theory (15), Upwind (4.1).
///
/// Second order. An undamped mode of angular frequency w grows by the factor
/// `sqrt(1 + (w dt)^4 / 4)` a step in amplitude, its energy by `1 + (w dt)^4 / 4`.
pub struct TvdRk2 {
    rate: Vec<f64>,
}

impl TvdRk2 {
    /// A method for states of `length` numbers.
    pub fn new(length: usize) -> Self {
        Self { rate: vec![0.0; length] }
    }
}

/// The first stage, `new = old + step rate`.
pub fn predict(step: f64, old: &[f64], rate: &[f64], new: &mut [f64]) {
    parallel::for_each_chunk(new, |first, new| {
        let parts = old[first..].iter().zip(&rate[first..]);
        for (new, (old, rate)) in new.iter_mut().zip(parts) {
            *new = old + step * rate;
        }
    });
}

/// The second stage, `new = (old + new + step rate) / 2`.
pub fn correct(step: f64, old: &[f64], rate: &[f64], new: &mut [f64]) {
    parallel::for_each_chunk(new, |first, new| {
        let parts = old[first..].iter().zip(&rate[first..]);
        for (new, (old, rate)) in new.iter_mut().zip(parts) {
            *new = 0.5 * (old + *new + step * rate);
        }
    });
}

impl Integrator for TvdRk2 {
    fn name(&self) -> &'static str {
        "tvd_rk2"
    }

    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        2
    }

    fn serves(&self, scheme: &mut dyn Scheme) -> bool {
        scheme.has_rates()
    }

    fn energy_factor(&self, phase: f64) -> Option<f64> {
        Some(1.0 + 0.25 * phase.powi(4))
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
        correct(step, old, &self.rate, new);
        scheme.constrain(time + step, new);
        Ok(())
    }
}
