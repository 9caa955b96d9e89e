//! Why a run stops before its end.

use piola_device::DeviceError;
use piola_ranks::RankError;
use thiserror::Error;

use super::integrator::Unserved;
use crate::coordinates;
use crate::schemes::{Behind, Escape, Inaccurate, Missed, NoSolution, Particle, StepsError};

/// What went wrong, where and when, with what to do about it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// A value is infinite or not a number.
    #[error(
        "particle {} (reference position {} m) has a value that is not finite after step \
         {step}, t = {time:.6} s: the step was too large for the state or the state had broken up \
         before; take smaller steps (`time.cfl` or `time.step`), or {advice}",
        particle.id,
        coordinates(&particle.reference)
    )]
    NotFinite {
        /// Index in memory of the first such particle.
        index: usize,
        /// That particle.
        particle: Particle,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
        /// What else makes the scheme more robust.
        advice: &'static str,
    },
    /// A particle has lost its volume or turned inside out.
    #[error(
        "particle {} (reference position {} m) collapsed: its volume ratio fell to {ratio:.2e} \
         at step {step}, t = {time:.6} s; {advice}",
        particle.id,
        coordinates(&particle.reference)
    )]
    Inverted {
        /// Index of the particle in memory.
        index: usize,
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
    /// A particle is where it must not be.
    #[error(
        "particle {} (reference position {} m) {} at {} m with {:.4e} m/s, after step {step}, \
         t = {time:.6} s; {}",
        particle.id,
        coordinates(&particle.reference),
        match &escape.behind {
            Behind::Wall(wall) => format!("has passed through the wall `{wall}`, and is"),
            Behind::End(wall) => {
                format!("has come over the end of the wall `{wall}`, which has no face there, and is")
            }
            Behind::Box => "has left the bounding box of the case, and is".into(),
            Behind::Surface => "has passed through the surface that it touches, and is".into(),
            Behind::Neighbors => {
                "is twice as far from an initial neighbour as at the start, or inverted together \
                 with its neighbours, and is"
                    .into()
            }
        },
        coordinates(&escape.position),
        escape.speed,
        escape.advice
    )]
    Escaped {
        /// Index of the particle in memory.
        index: usize,
        /// The particle.
        particle: Particle,
        /// Where it is, how fast, and what it has left behind.
        escape: Box<Escape>,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
    },
    /// Particles were to be born, and too few were in reserve. A run of a case makes more and takes the step again.
    #[error(
        "no particles are left in reserve for {missing} that were to be born in step {step}, t = {time:.6} s; raise \
         `scheme.reserve`"
    )]
    NoneInReserve {
        /// How many could not be born.
        missing: u64,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
    },
    /// What the run depends on outside of it has failed.
    #[error("{cause}; the run ended at t = {time:.6} s, step {step}")]
    Outside {
        /// What failed, in a sentence without its stop.
        cause: String,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
    },
    /// A particle is much faster than anything was at the start.
    #[error(
        "particle {} (reference position {} m) moves at {speed:.4e} m/s after step {step}, \
         t = {time:.6} s, where at most {limit:.4e} m/s is expected (ten times the sum of the \
         largest speed and the wave speed at the start, unless `time.max_speed` says otherwise): \
         the state has broken up, or the material is far too soft for its loads; check the \
         parameters of the material and their units, take smaller steps (`time.cfl` or \
         `time.step`) or \
         {advice}, or raise `time.max_speed` if such speeds are meant",
        particle.id,
        coordinates(&particle.reference)
    )]
    TooFast {
        /// Index of the particle in memory.
        index: usize,
        /// The particle.
        particle: Particle,
        /// Its speed in m/s.
        speed: f64,
        /// The limit in m/s.
        limit: f64,
        /// Steps taken.
        step: u64,
        /// Simulated time in s.
        time: f64,
        /// What else makes the scheme more robust.
        advice: &'static str,
    },
    /// A fixed step is larger than the state allows.
    #[error(
        "the fixed step {step:.4e} s is larger than the stable step {stable:.4e} s at \
         t = {time:.6} s, set by the limit `{limiter}` of particle {} (reference position {} m); \
         lower `time.step`, or set `time.cfl` and let the step follow the state",
        particle.id,
        coordinates(&particle.reference)
    )]
    FixedStepTooLarge {
        /// Index in memory of the particle that sets the limit.
        index: usize,
        /// That particle.
        particle: Particle,
        /// The step asked for in s.
        step: f64,
        /// The largest stable step in s.
        stable: f64,
        /// The limit that sets it.
        limiter: &'static str,
        /// Simulated time in s.
        time: f64,
    },
    /// The stable step has become too small to get anywhere.
    #[error(
        "the step fell to {size:.3e} s, below the floor of {floor:.3e} s, at step {step}, \
         t = {time:.6} s: the limit `{limiter}` of particle {} (reference position {} m) sets \
         it, and the smallest volume ratio is {ratio:.2e}; {advice}",
        particle.id,
        coordinates(&particle.reference)
    )]
    StepBelowFloor {
        /// Index in memory of the particle that sets the step.
        index: usize,
        /// That particle.
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
    /// The equations of a step have no solution, as far as was looked.
    #[error(transparent)]
    NoSolution(NoSolution),
    /// The integrator cannot move the scheme.
    #[error(transparent)]
    Unserved(#[from] Unserved),
    /// A step is less accurate than was asked for. The run takes a shorter one.
    #[error(transparent)]
    Inaccurate(#[from] Inaccurate),
    /// A device cannot go on.
    #[error(
        "the device failed: {0}; the run is back at the last saved state, and `--resume` \
         continues from there, on any device or on the processor"
    )]
    Device(#[from] DeviceError),
    /// The ranks that compute the run cannot go on together.
    #[error(
        "the ranks cannot go on: {0}; the run is back at the last saved state, and `--resume` continues from there, on \
         any number of ranks"
    )]
    Ranks(#[from] RankError),
    /// The number of steps allowed is used up.
    #[error(
        "it took the maximum number of steps, {steps}, and is at t = {time:.6} s, before its end; \
         raise `time.max_steps` to continue"
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
            Self::Escaped { .. } => "escaped",
            Self::NoneInReserve { .. } => "none_in_reserve",
            Self::Outside { .. } => "outside",
            Self::TooFast { .. } => "too_fast",
            Self::FixedStepTooLarge { .. } => "fixed_step_too_large",
            Self::StepBelowFloor { .. } => "step_below_floor",
            Self::NoSolution(missed) => match missed.kind {
                Missed::NoConvergence => "no_convergence",
                Missed::Inverted => "inverted",
                Missed::Unstable => "unstable",
            },
            Self::Unserved(_) => "unserved",
            Self::Inaccurate(_) => "inaccurate",
            Self::Device(_) => "device",
            Self::Ranks(_) => "ranks",
            Self::TooManySteps { .. } => "too_many_steps",
        }
    }

    /// Whether whoever takes the steps is lost, and the state with it.
    pub fn is_loss(&self) -> bool {
        matches!(self, Self::Device(_) | Self::Ranks(_))
    }

    /// The particle (index in memory) that it names, if it names one.
    pub fn particle(&self) -> Option<usize> {
        match self {
            Self::NotFinite { index, .. }
            | Self::Inverted { index, .. }
            | Self::Escaped { index, .. }
            | Self::TooFast { index, .. }
            | Self::FixedStepTooLarge { index, .. }
            | Self::StepBelowFloor { index, .. } => Some(*index),
            // What led there is in its message; to take the steps once more would take long.
            Self::NoSolution(_)
            | Self::NoneInReserve { .. }
            | Self::Outside { .. }
            | Self::Unserved(_)
            | Self::Inaccurate(_)
            | Self::Device(_)
            | Self::Ranks(_)
            | Self::TooManySteps { .. } => None,
        }
    }
}

impl From<StepsError> for Failure {
    fn from(error: StepsError) -> Self {
        match error {
            StepsError::Device(error) => error.into(),
            StepsError::Ranks(error) => error.into(),
            StepsError::NoSolution(missed) => Self::NoSolution(missed),
            StepsError::Inaccurate(missed) => missed.into(),
        }
    }
}
