//! The clock: integrators, step control, and the executor that takes the steps of a run.

mod checkpoint;
mod clock;
mod coupled;
mod executor;
mod failure;
mod history;
mod implicit;
mod integrator;
mod judgement;
mod kick_drift_kick;
mod load_steps;
mod observer;
mod run;
mod runge_kutta;
mod schedule;
mod step;
mod summary;

pub use checkpoint::{Checkpoint, CheckpointPolicy, CheckpointStore, Checkpoints, Misfit};
pub use coupled::Coupled;
pub use executor::Executor;
pub use failure::Failure;
pub use history::Trace;
pub use implicit::ImplicitStepping;
pub use integrator::{Integrator, IntegratorKind, Unserved};
pub use judgement::supersonic;
pub use kick_drift_kick::KickDriftKick;
pub use load_steps::LoadStepping;
pub use observer::{Moment, ObserveError, Observer};
pub use runge_kutta::RungeKutta;
pub use schedule::Schedule;
pub use step::{ChosenStep, StepControl, StepTooLarge};
pub use summary::{Outcome, Progress, Retry, Summary, Timing};
