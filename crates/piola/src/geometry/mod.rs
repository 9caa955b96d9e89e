//! Shapes, lattices and files turned into particles.

mod particles;

pub use particles::Particles;
