//! The clock: integrators, step control, and the executor that owns a run.

mod executor;
mod failure;
mod integrator;
mod kick_drift_kick;
mod observer;
mod schedule;
mod step;
pub mod tvd_rk2;

pub use executor::{Executor, Outcome, Progress, Summary, Timing};
pub use failure::Failure;
pub use integrator::{Integrator, IntegratorKind};
pub use kick_drift_kick::KickDriftKick;
pub use observer::{Moment, ObserveError, Observer};
pub use schedule::Schedule;
pub use step::{ChosenStep, StepControl};
pub use tvd_rk2::TvdRk2;
