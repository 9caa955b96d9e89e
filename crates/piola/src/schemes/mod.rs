//! The formulations, one folder each, and what each of them offers to the rest of the program.

pub mod dual_support;
pub mod momentum;
mod scheme;
pub mod upwind;

pub use momentum::{MomentumComponent, momentum_components};
pub use scheme::{Health, Ledger, Particle, Scheme, StepLimit, snapshot};
