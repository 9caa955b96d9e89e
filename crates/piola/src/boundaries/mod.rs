//! Prescribed values and loads on selections of particles.

mod body_force;
mod function;
pub(crate) mod prescribed;
mod traction;

pub use body_force::BodyForce;
pub use function::{SpaceTime, padded};
pub use prescribed::PrescribedVelocity;
pub use traction::Traction;
