//! The stages of explicit Runge-Kutta methods, each a blend of states and a rate.

use piola_formulas::Number;

use crate::parallel;

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

/// A stage of a method: its name, how it is made, and the time it stands at, as a share of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BlendStage {
    pub name: &'static str,
    pub blend: Blend,
    pub at: f64,
}

/// `u1 = u + dt f(u, t)`, `u_new = (u + u1 + dt f(u1, t + dt)) / 2`.
pub(crate) const TVD_RK2: [BlendStage; 2] = [
    BlendStage { name: "predict", blend: Blend::Predict, at: 1.0 },
    BlendStage { name: "halve", blend: Blend::Halve, at: 1.0 },
];

/// `u1 = u + dt f(u, t)`, `u2 = 3/4 u + 1/4 (u1 + dt f(u1, t + dt))`,
/// `u_new = 1/3 u + 2/3 (u2 + dt f(u2, t + dt/2))`.
pub(crate) const SSP_RK3: [BlendStage; 3] = [
    BlendStage { name: "predict", blend: Blend::Predict, at: 1.0 },
    BlendStage { name: "blend_quarter", blend: Blend::Share(0.25), at: 0.5 },
    BlendStage { name: "blend_two_thirds", blend: Blend::Share(2.0 / 3.0), at: 1.0 },
];

/// The stages of the method of a name, if it is one.
pub(crate) fn stages(integrator: &str) -> Option<&'static [BlendStage]> {
    match integrator {
        "tvd_rk2" => Some(&TVD_RK2),
        "ssp_rk3" => Some(&SSP_RK3),
        _ => None,
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
