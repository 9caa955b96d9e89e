//! Why a run stops before its end.

use thiserror::Error;

use crate::schemes::Particle;

/// What went wrong, where and when, with what to do about it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// A value is infinite or not a number.
    #[error(
        "particle {} (reference position {:?} m) has a value that is not finite after step \
         {step}, t = {time:.6} s: the step was too large for the state or the state had broken up \
         before; lower `time.cfl`, or raise `scheme.tau_velocity`",
        particle.id,
        particle.reference
    )]
    NotFinite {
        /// The first such particle.
        particle: Particle,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
    },
    /// A particle has lost its volume or turned inside out.
    #[error(
        "particle {} (reference position {:?} m) collapsed: its volume ratio fell to {ratio:.2e} \
         at step {step}, t = {time:.6} s; {advice}",
        particle.id,
        particle.reference
    )]
    Inverted {
        /// The particle.
        particle: Particle,
        /// The smaller of its evolved J and the determinant of its deformation gradient.
        ratio: f64,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
        /// The likely cause and what to change.
        advice: String,
    },
    /// A fixed step is larger than the state allows.
    #[error(
        "the fixed step {step:.4e} s is larger than the stable step {stable:.4e} s, set by the \
         limit `{limiter}`; lower `time.step`, or set `time.cfl` and let the step follow the state"
    )]
    FixedStepTooLarge {
        /// The step asked for in s.
        step: f64,
        /// The largest stable step in s.
        stable: f64,
        /// The limit that sets it.
        limiter: &'static str,
    },
    /// The stable step has become too small to get anywhere.
    #[error(
        "the step fell to {size:.3e} s, below the floor of {floor:.3e} s, at step {step}, \
         t = {time:.6} s: the limit `{limiter}` of particle {} (reference position {:?} m) sets \
         it, and the smallest volume ratio is {ratio:.2e}; {advice}",
        particle.id,
        particle.reference
    )]
    StepBelowFloor {
        /// The particle that sets the step.
        particle: Particle,
        /// The step in s.
        size: f64,
        /// The floor in s.
        floor: f64,
        /// The limit that sets it.
        limiter: &'static str,
        /// The smallest volume ratio of the state.
        ratio: f64,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
        /// The likely cause and what to change.
        advice: String,
    },
    /// The number of steps allowed is used up.
    #[error(
        "it took all the steps it may, {steps}, and is at t = {time:.6} s, before its end; raise `time.max_steps` to go on"
    )]
    TooManySteps {
        /// Steps taken.
        steps: u64,
        /// Simulated time in s.
        time: f64,
    },
}

impl Failure {
    /// One word for tables and checks.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => "not_finite",
            Self::Inverted { .. } => "inverted",
            Self::FixedStepTooLarge { .. } => "fixed_step_too_large",
            Self::StepBelowFloor { .. } => "step_below_floor",
            Self::TooManySteps { .. } => "too_many_steps",
        }
    }
}
