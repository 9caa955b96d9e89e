//! Prescribed values and loads on selections of particles.

mod function;
pub(crate) mod prescribed;
mod traction;

pub use function::{SpaceTime, padded};
pub use prescribed::PrescribedVelocity;
pub use traction::Traction;
