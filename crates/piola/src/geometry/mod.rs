//! Shapes, lattices and files turned into particles, and regions that select some of them.

mod cut;
mod error;
mod faces;
mod fill;
mod jitter;
mod lattice;
mod particles;
mod points;
mod region;
mod shape;
mod way_out;

pub use error::GeometryError;
pub use faces::Faces;
pub use fill::{FillReport, fill};
pub use lattice::{LatticeKind, LatticeSpec, Placement};
pub use particles::Particles;
pub use points::{PointsError, PointsFault, from_points};
pub use region::Region;
pub use shape::Shape;

#[cfg(test)]
mod tests;
