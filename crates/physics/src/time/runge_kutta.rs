//! Explicit strong-stability-preserving Runge-Kutta methods, one for each table of stages.

use piola_formulas::Number;

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use crate::parallel;
use crate::schemes::Scheme;

/// What a stage makes of the state `old` at the begin of the step and of `new + step rate`, a forward
/// Euler step from the state of the stage before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blend {
    /// `old + step rate`: the first stage.
    Predict,
    /// `(old + new + step rate) / 2`.
    Halve,
    /// `old + share (new + step rate - old)`.
    Share(f64),
}

impl Blend {
    /// What the stage makes of a number and its rate.
    #[inline(always)]
    pub(crate) fn value<T: Number>(self, step: T, old: T, rate: T, new: T) -> T {
        match self {
            Self::Predict => old + step * rate,
            Self::Halve => (old + new + step * rate) * 0.5,
            Self::Share(share) => old + (new + step * rate - old) * share,
        }
    }
}

/// A stage of a method: how it is made, and the time it stands at, as a share of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stage {
    pub blend: Blend,
    pub at: f64,
}

/// `u1 = u + dt f(u, t)`, `u_new = (u + u1 + dt f(u1, t + dt)) / 2`.
const TVD_RK2: [Stage; 2] =
    [Stage { blend: Blend::Predict, at: 1.0 }, Stage { blend: Blend::Halve, at: 1.0 }];

/// `u1 = u + dt f(u, t)`, `u2 = 3/4 u + 1/4 (u1 + dt f(u1, t + dt))`,
/// `u_new = 1/3 u + 2/3 (u2 + dt f(u2, t + dt/2))`.
const SSP_RK3: [Stage; 3] = [
    Stage { blend: Blend::Predict, at: 1.0 },
    Stage { blend: Blend::Share(0.25), at: 0.5 },
    Stage { blend: Blend::Share(2.0 / 3.0), at: 1.0 },
];

/// A method of Shu and Osher: each stage is a blend of the begin of the step and of a forward Euler
/// step from the stage before.
pub struct RungeKutta {
    name: &'static str,
    stages: &'static [Stage],
    /// The factor of the energy of an undamped mode a step, of the square of `z = w dt`.
    energy: fn(f64) -> f64,
    rate: Vec<f64>,
}

impl RungeKutta {
    /// The stages of the method of a name, if it is one.
    pub(crate) fn stages(name: &str) -> Option<&'static [Stage]> {
        match name {
            "tvd_rk2" => Some(&TVD_RK2),
            "ssp_rk3" => Some(&SSP_RK3),
            _ => None,
        }
    }

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

/// One stage: `new`, the state of the stage before, becomes that of this one.
pub fn advance(blend: Blend, step: f64, old: &[f64], rate: &[f64], new: &mut [f64]) {
    // One loop a blend, so that none is chosen within it.
    match blend {
        Blend::Predict => each(Blend::Predict, step, old, rate, new),
        Blend::Halve => each(Blend::Halve, step, old, rate, new),
        Blend::Share(share) => each(Blend::Share(share), step, old, rate, new),
    }
}

#[inline(always)]
fn each(blend: Blend, step: f64, old: &[f64], rate: &[f64], new: &mut [f64]) {
    parallel::for_each_chunk(new, |first, new| {
        let parts = old[first..].iter().zip(&rate[first..]);
        for (new, (old, rate)) in new.iter_mut().zip(parts) {
            *new = blend.value(step, *old, *rate, *new);
        }
    });
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
