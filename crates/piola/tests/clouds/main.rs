//! Particles from meshes: what is read, what of a body is whose, and what is refused.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

mod faults;
mod patches;
mod reading;
mod relaxation;
mod shares;

use std::path::{Path, PathBuf};

use piola::geometry::{CloudPoints, CloudSpec, CloudVolumes, GeometryError, Particles, from_mesh};

/// Nodes of the whole mesh with their shares of the cells.
const NODES: CloudSpec = CloudSpec {
    points: CloudPoints::Nodes,
    volumes: CloudVolumes::Cells,
    spacings: None,
    part: None,
};

/// Centroids of all cells.
const CELLS: CloudSpec = CloudSpec {
    points: CloudPoints::Cells,
    volumes: CloudVolumes::Cells,
    spacings: None,
    part: None,
};

/// A mesh of these tests, made by Gmsh and by meshio.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clouds/data").join(name)
}

/// A mesh that the fuzzer starts from.
fn seed(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/mesh").join(name)
}

/// Particles from the bytes of a mesh.
fn from_bytes<const D: usize>(
    bytes: &[u8],
    spec: &CloudSpec,
) -> Result<Particles<D>, GeometryError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh");
    std::fs::write(&path, bytes).unwrap();
    from_mesh(&path, spec)
}

/// A hexahedron with a bent top, a wedge beside it and a pyramid over that: all kinds of faces.
const MIXED: &str = "# vtk DataFile Version 3.0
all kinds of cells
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 11 double
0 0 0  1 0 0  1 1 0  0 1 0
0 0 1  1 0 1.1  1 1 0.9  0 1 1.2
2 0 0  2 0.1 1  1.6 -1 0.7
CELLS 3 22
8 0 1 2 3 4 5 6 7
6 1 8 2 5 9 6
5 1 8 9 5 10
CELL_TYPES 3
12 13 14
";
