//! The clock: integrators, step control, and the executor that owns a run.

mod checkpoint;
mod clock;
mod executor;
mod failure;
mod history;
mod integrator;
mod judgement;
mod kick_drift_kick;
mod load_steps;
mod newmark;
mod observer;
mod schedule;
mod step;
mod summary;
mod theta;
pub mod tvd_rk2;

pub use checkpoint::{Checkpoint, CheckpointPolicy, CheckpointStore, Checkpoints, Misfit};
pub use executor::Executor;
pub use failure::Failure;
pub use history::Trace;
pub use integrator::{Integrator, IntegratorKind};
pub use judgement::supersonic;
pub use kick_drift_kick::KickDriftKick;
pub use load_steps::LoadStepping;
pub use newmark::NewmarkStepping;
pub use observer::{Moment, ObserveError, Observer};
pub use schedule::Schedule;
pub use step::{ChosenStep, StepControl, StepTooLarge};
pub use summary::{Outcome, Progress, Retry, Summary, Timing};
pub use theta::ThetaStepping;
pub use tvd_rk2::TvdRk2;
