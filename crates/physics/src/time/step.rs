//! How large the next step is, and why.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::schemes::StepLimit;

/// How the step is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// The CFL number times the stable step of the current state, Upwind (4.3).
    Cfl(f64),
    /// A fixed step in s, checked against the stable step at a CFL number of one.
    Fixed(f64),
    /// At most this, whatever the stable step is: steps of loads, and implicit ones.
    AtMost(f64),
}

/// A step with what limited it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChosenStep {
    /// Its size in s.
    pub step: f64,
    /// The name of the bound that it meets: a limit of the scheme, `fixed` or `output`.
    /// A checkpoint does not keep it: `resumed` it is until the next step.
    #[serde(skip, default = "ChosenStep::resumed")]
    pub limiter: &'static str,
    /// The particle (index in memory) behind the limit.
    pub particle: usize,
}

impl ChosenStep {
    fn resumed() -> &'static str {
        "resumed"
    }
}

/// A fixed step that is beyond the stable one.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the fixed step {step:.4e} s is larger than the stable step {:.4e} s, set by the limit `{}`; \
     lower `time.step`, or set `time.cfl` and let the step follow the state",
    bound.step,
    bound.limiter
)]
pub struct StepTooLarge {
    /// The step asked for in s.
    pub step: f64,
    /// The largest stable one.
    pub bound: ChosenStep,
}

/// A step may exceed its bound by round-off: one that is fixed, or that meets a due time.
const ROUND_OFF: f64 = 1e-9;

/// Below this share of the stable step it is the output that limits a step.
const SHORTENED: f64 = 0.9;

impl StepControl {
    /// The step for a state with these limits, before it is shortened to meet a due time.
    ///
    /// # Errors
    /// A fixed step is beyond the stable one.
    pub fn choose(self, limits: &[StepLimit]) -> Result<ChosenStep, StepTooLarge> {
        let number = match self {
            Self::Cfl(number) => number,
            Self::Fixed(_) => 1.0,
            Self::AtMost(step) => return Ok(ChosenStep { step, limiter: "largest", particle: 0 }),
        };
        let unlimited = ChosenStep { step: f64::INFINITY, limiter: "none", particle: 0 };
        let bound = limits.iter().fold(unlimited, |best, limit| {
            let step = if limit.scaled { number * limit.step } else { limit.step };
            // A bound that is no number is the smallest of all: no step is safe.
            if best.step <= step || best.step.is_nan() {
                best
            } else {
                ChosenStep { step, limiter: limit.name, particle: limit.particle }
            }
        });
        match self {
            Self::Cfl(_) | Self::AtMost(_) => Ok(bound),
            Self::Fixed(step) if !(step <= bound.step * (1.0 + ROUND_OFF)) => {
                Err(StepTooLarge { step, bound })
            }
            Self::Fixed(step) => {
                Ok(ChosenStep { step, limiter: "fixed", particle: bound.particle })
            }
        }
    }

    /// Whether steps may be shortened: to meet a due time, or to try once more.
    pub fn adapts(self) -> bool {
        !matches!(self, Self::Fixed(_))
    }

    /// Shortens `chosen` so that equal steps end exactly at `due`. A fixed step stays as it is: it
    /// meets times that are its multiples, and others at the first step after them.
    ///
    /// Equal, because a step that is long and short by turns, in time with the output, drives
    /// undamped waves by parametric resonance, far below the largest stable step.
    pub fn meet(self, chosen: ChosenStep, time: f64, due: f64) -> ChosenStep {
        let left = due - time;
        if !self.adapts() {
            return chosen;
        }
        if chosen.step * (1.0 + ROUND_OFF) >= left {
            return ChosenStep { step: left, limiter: "output", ..chosen };
        }
        let step = left / (left / (chosen.step * (1.0 + ROUND_OFF))).ceil();
        let limiter = if step < SHORTENED * chosen.step { "output" } else { chosen.limiter };
        ChosenStep { step, limiter, ..chosen }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: [StepLimit; 2] = [
        StepLimit { name: "acoustic", step: 0.1, particle: 7, scaled: true, growth: 1.0 },
        StepLimit {
            name: "upwind dissipation",
            step: 0.05,
            particle: 3,
            scaled: false,
            growth: 1.0,
        },
    ];

    #[test]
    fn the_smallest_bound_names_itself() {
        let chosen = StepControl::Cfl(0.3).choose(&LIMITS).expect("a step exists");
        assert_eq!((chosen.step, chosen.limiter, chosen.particle), (0.03, "acoustic", 7));
        let chosen = StepControl::Cfl(0.9).choose(&LIMITS).expect("a step exists");
        assert_eq!((chosen.step, chosen.limiter), (0.05, "upwind dissipation"));
    }

    #[test]
    fn a_fixed_step_beyond_the_bound_is_refused() {
        assert!(StepControl::Fixed(0.05).choose(&LIMITS).is_ok());
        let refused = StepControl::Fixed(0.06).choose(&LIMITS);
        assert!(matches!(refused, Err(StepTooLarge { bound: ChosenStep { step: 0.05, .. }, .. })));
    }

    #[test]
    fn due_times_are_met_without_tiny_steps() {
        let control = StepControl::Cfl(1.0);
        let chosen = ChosenStep { step: 0.1, limiter: "acoustic", particle: 0 };
        assert_eq!(control.meet(chosen, 1.0, 1.15).step, 0.5 * (1.15 - 1.0));
        assert_eq!(control.meet(chosen, 1.0, 1.05).step, 1.05 - 1.0);
        let met = control.meet(chosen, 1.0, 1.48);
        assert_eq!((met.step, met.limiter), ((1.48 - 1.0) / 5.0, "acoustic"));
        assert_eq!(control.meet(chosen, 1.0, 1.11).limiter, "output");
        // 0.1 + 0.1 + 0.1 is beyond 0.3 by a rounding: no reason for another step.
        assert_eq!(control.meet(chosen, 0.2, 0.1 + 0.1 + 0.1).step, 0.1 + 0.1 + 0.1 - 0.2);
    }
}
