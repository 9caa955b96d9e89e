//! Explicit strong-stability-preserving Runge-Kutta methods, one for each table of stages.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use crate::schemes::Scheme;
use crate::schemes::blend::{BlendStage, SSP_RK3, TVD_RK2, advance};

/// A method of Shu and Osher: each stage is a blend of the begin of the step and of a forward Euler
/// step from the stage before.
pub struct RungeKutta {
    name: &'static str,
    stages: &'static [BlendStage],
    /// The factor of the energy of an undamped mode a step, of the square of `z = w dt`.
    energy: fn(f64) -> f64,
    rate: Vec<f64>,
}

impl RungeKutta {
    /// The method of two stages for states of `length` numbers, theory (15), Upwind (4.1).
    ///
    /// Second order. An undamped mode of angular frequency w grows by the factor
    /// `sqrt(1 + (w dt)^4 / 4)` a step in amplitude, its energy by `1 + (w dt)^4 / 4`.
    pub fn tvd_rk2(length: usize) -> Self {
        let energy = |square: f64| 1.0 + 0.25 * square * square;
        Self { name: "tvd_rk2", stages: &TVD_RK2, energy, rate: vec![0.0; length] }
    }

    /// The method of three stages for states of `length` numbers.
    ///
    /// Third order. An undamped mode of angular frequency w loses the share `z^4 / 12 - z^6 / 36`,
    /// z = w dt, of its energy a step, up to `z = sqrt(3)`, from where on it grows.
    pub fn ssp_rk3(length: usize) -> Self {
        let energy = |square: f64| 1.0 + square * square * (square / 36.0 - 1.0 / 12.0);
        Self { name: "ssp_rk3", stages: &SSP_RK3, energy, rate: vec![0.0; length] }
    }
}

impl Integrator for RungeKutta {
    fn name(&self) -> &'static str {
        self.name
    }

    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        self.stages.len() as u64
    }

    fn energy_factor(&self, phase: f64) -> Option<f64> {
        Some((self.energy)(phase * phase))
    }

    fn renewed(&self, scheme: &mut dyn Scheme) -> Option<Box<dyn Integrator>> {
        Some(Box::new(Self { rate: vec![0.0; scheme.initial_state().len()], ..*self }))
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
            return Err(Unserved::new(self.name, scheme).into());
        }
        let mut at = time;
        for (number, stage) in self.stages.iter().enumerate() {
            let from: &[f64] = if number == 0 { old } else { new };
            scheme.rates(at, from, &mut self.rate);
            advance(stage.blend, step, old, &self.rate, new);
            at = time + stage.at * step;
            scheme.constrain(at, new);
        }
        Ok(())
    }
}
