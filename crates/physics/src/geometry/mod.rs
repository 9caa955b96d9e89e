//! Shapes, lattices and files turned into particles, and regions that select some of them.

mod cloud;
mod concentric;
mod cut;
mod error;
mod faces;
mod facets;
mod file;
mod fill;
mod given;
mod jitter;
mod lattice;
mod mesh;
mod outline;
mod particles;
mod points;
mod polygon;
mod probe;
mod region;
mod shape;
mod surface;
mod surroundings;
mod way_out;

pub use cloud::{
    BoundaryFace, CloudPoints, CloudSpec, CloudVolumes, FaceSample, NamedSet, from_mesh,
};
pub use error::GeometryError;
pub use faces::Faces;
pub(crate) use faces::turned_normal;
pub use facets::{Arrangement, Facets, Soundness, Spot, SurfaceError};
pub(crate) use fill::MOST_SITES;
pub use fill::{FillReport, fill, turns};
pub use given::{PointCloud, PointCloudError};
pub(crate) use jitter::uniform;
pub use lattice::{LatticeKind, LatticeSpec, Placement};
pub use mesh::{Cell, CellKind, Mesh, MeshError, MeshFault, MeshSet};
pub use outline::{Outline, OutlineError};
pub use particles::Particles;
pub use points::{PointsError, PointsFault, from_points};
pub(crate) use probe::Probe;
pub use region::Region;
pub use shape::{LayerSide, Shape, ball_volume};
pub use surface::Surface;
pub use surroundings::surroundings;
pub(crate) use way_out::slope;

#[cfg(test)]
mod tests;
