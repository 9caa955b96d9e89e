//! Clock and checkpoints.

use crate::case::source::{Located, Place};
use crate::schemes::ImplicitRule;
use crate::solve::LinearMethod;
use crate::time::IntegratorKind;

/// Clock and integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Time {
    /// Time at which the run ends, in s. It starts at 0.
    pub end: Located<f64>,
    /// Name of the integrator.
    pub integrator: Located<String>,
    /// Its rule, if it takes implicit steps.
    pub rule: Option<ImplicitRule>,
    /// Allowed error of a step, if given.
    pub error: Option<f64>,
    /// Relative residual at which Newton's method has converged, if given.
    pub tolerance: Option<f64>,
    /// How linear equations are solved.
    pub linear_solver: LinearMethod,
    /// How long a step is.
    pub step: Located<StepControl>,
    /// The run fails after this many steps.
    pub max_steps: Option<u64>,
    /// The run fails when the stable step falls below this, in s.
    pub min_step: Option<f64>,
    /// The run fails when a particle is faster than this, in m/s.
    pub max_speed: Option<f64>,
    /// How often the run may go back and continue with half the step.
    pub retries: u64,
}

/// When checkpoints are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Steps between them.
    pub every_steps: Option<u64>,
    /// Simulated time between them in s.
    pub every: Option<f64>,
    /// Wall time between them in s.
    pub every_wall: Option<f64>,
    /// How many are kept.
    pub keep: u64,
    /// Whether one is written at the end.
    pub at_end: bool,
}

impl Default for Checkpoint {
    /// Every five minutes, two of them.
    fn default() -> Self {
        Self { every_steps: None, every: None, every_wall: Some(300.0), keep: 2, at_end: false }
    }
}

impl Time {
    /// No time at all, for a case in which nothing moves.
    pub fn none(place: Place) -> Self {
        Self {
            end: Located::new(0.0, place),
            integrator: Located::new(IntegratorKind::KickDriftKick.name().to_owned(), place),
            rule: None,
            error: None,
            tolerance: None,
            linear_solver: LinearMethod::Automatic,
            step: Located::new(StepControl::AtMost(1.0), place),
            max_steps: None,
            min_step: None,
            max_speed: None,
            retries: 0,
        }
    }
}

/// How long a time step is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// This fraction of the stable step.
    Cfl(f64),
    /// This many seconds, checked against the stable step.
    Fixed(f64),
    /// At most this many seconds, whatever step is stable, or this increment of the load factor.
    AtMost(f64),
}
