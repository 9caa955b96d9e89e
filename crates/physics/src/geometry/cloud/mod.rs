//! Meshes turned into particles, which know the boundary they came from.

mod cells;
mod faces;
mod sets;
mod volumes;

use std::collections::BTreeMap;
use std::path::Path;

use super::mesh::{Mesh, MeshError, MeshFault};
use super::{GeometryError, Particles, Surface};

use cells::{Solid, solids};
pub use faces::{BoundaryFace, FaceSample};
pub use sets::NamedSet;

/// A fault, and the line it is on if that is known.
type Fault = (Option<u64>, MeshFault);

/// Where in a mesh particles are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CloudPoints {
    /// At the nodes.
    Nodes,
    /// At the centroids of the cells.
    Cells,
}

/// How much of the body is a particle's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CloudVolumes {
    /// Its cell; a node has an equal share of each of its cells, of a simplex `V/(D + 1)`.
    Cells,
    /// What is nearer to a node than to others of the same cell, as in a Voronoi diagram, found by
    /// points inside each cell. The centroid of a cell has the cell.
    Nearest,
    /// The numbers of an array of the file in m^D, of nodes or of cells as the particles are. They
    /// must sum to the measure of the cells to 1e-4 of it, and are scaled to do so exactly.
    Array(String),
}

/// What is made of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CloudSpec {
    /// Where particles are.
    pub points: CloudPoints,
    /// What volumes they have.
    pub volumes: CloudVolumes,
    /// The array of the file that has their spacings in m, of nodes or of cells as the particles are;
    /// the edges of cubes of their kernel weights if `None`.
    pub spacings: Option<String>,
    /// The set of cells that is the body, the whole mesh if `None`.
    pub part: Option<String>,
}

/// Reads a mesh and makes particles of its cells of dimension `D`, in the order of the file, with
/// their [`Surface`].
///
/// The volume of a particle is what it has of the body. The kernel weight of a node on the boundary
/// is that over the share of the full angle that the body fills there, as particles of a lattice have
/// whole cells at faces, edges and corners; the spacing is the edge of a cube of this weight.
///
/// # Errors
/// [`GeometryError::Mesh`] for files that are no mesh; for meshes of other dimensions, cells that are
/// flat, inverted, folded or there twice; for sets and arrays that are not there, and volumes that do
/// not make up the body. [`GeometryError::TooManyParticles`].
#[inline(never)]
pub fn from_mesh<const D: usize>(
    path: &Path,
    spec: &CloudSpec,
) -> Result<Particles<D>, GeometryError> {
    let mesh = Mesh::read(path)?;
    let count = mesh.nodes.len().max(mesh.cells.len());
    if count >= u32::MAX as usize {
        return Err(GeometryError::TooManyParticles { count });
    }
    let refuse = |(line, fault)| MeshError { file: path.into(), line, fault };
    Ok(particles(&mesh, spec).map_err(refuse)?)
}

fn particles<const D: usize>(mesh: &Mesh, spec: &CloudSpec) -> Result<Particles<D>, Fault> {
    let solids = solids::<D>(mesh, spec.part.as_deref())?;
    let numbers = Numbers::new(mesh, &solids, spec.points);
    let mut particles = volumes::particles(mesh, &solids, &numbers, spec)?;
    let boundary = faces::boundary(mesh, &solids)?;
    particles.surface = Surface {
        bodies: BTreeMap::from([(0, spec.points)]),
        faces: boundary.iter().flat_map(|face| face.parts(&numbers)).collect(),
        sets: sets::sets(mesh, &solids, &numbers, &boundary),
    };
    Ok(particles)
}

/// Numbers of particles.
struct Numbers {
    points: CloudPoints,
    /// The particle of each node of the mesh, if it has one.
    of_node: Vec<Option<u32>>,
    /// How many particles there are.
    count: usize,
}

impl Numbers {
    fn new<const D: usize>(mesh: &Mesh, solids: &[Solid<D>], points: CloudPoints) -> Self {
        let mut of_node = vec![None; mesh.nodes.len()];
        if points == CloudPoints::Cells {
            return Self { points, of_node, count: solids.len() };
        }
        for solid in solids {
            for &node in mesh.cells[solid.cell].nodes() {
                of_node[node as usize] = Some(0);
            }
        }
        let used = of_node.iter_mut().flatten();
        let count = (0u32..).zip(used).map(|(number, own)| *own = number).count();
        Self { points, of_node, count }
    }
}
