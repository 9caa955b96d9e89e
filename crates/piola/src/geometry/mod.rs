//! Shapes, lattices and files turned into particles.

mod particles;
mod stub;

pub use particles::Particles;
pub use stub::*;
