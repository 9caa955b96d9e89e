//! The formulations, one folder each, and what each of them offers to the rest of the program.

mod scheme;
pub mod upwind;

pub use scheme::{Health, Particle, Scheme, StepLimit, snapshot};
