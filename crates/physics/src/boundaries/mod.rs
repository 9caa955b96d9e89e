//! Prescribed values and loads on selections of particles.

mod body_force;
mod function;
mod held;
mod history;
pub(crate) mod prescribed;
pub(crate) mod pressure;
mod spring;
pub(crate) mod traction;
mod wave_maker;

pub use body_force::BodyForce;
pub use function::{SpaceTime, padded};
pub use held::{PrescribedDisplacement, PrescribedFaces, Tie};
pub use history::{History, Profiled, Scaled};
pub use prescribed::PrescribedVelocity;
pub use pressure::FollowerPressure;
pub use spring::Spring;
pub use traction::Traction;
pub use wave_maker::{Harmonic, Push, Sea, Water, WaveMaker};
