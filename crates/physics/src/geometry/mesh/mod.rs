//! Meshes of finite elements, as files have them.
//!
//! Gmsh's format is read here, as the crates for it stop at unknown numbers with a panic and know no
//! physical groups; so is VTK's, of which few lines are needed.

mod cell;
mod error;
mod gmsh;
mod vtk;
mod vtu;
mod words;

use std::collections::BTreeMap;
use std::path::Path;

use super::file::read;

pub use cell::{Cell, CellKind};
pub use error::{MeshError, MeshFault};

/// A fault, and the line it is on if that is known.
type Fault = (Option<u64>, MeshFault);

/// Nodes, cells of all dimensions, and what they are called.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Places of the nodes in m; a plane mesh has z = 0.
    pub nodes: Vec<[f64; 3]>,
    /// Cells, edges, faces and points, in the order of the file.
    pub cells: Vec<Cell>,
    /// Physical groups of Gmsh by their name, or by their number where they have none; values of an
    /// integer array of VTK as `array:value`.
    pub sets: BTreeMap<String, MeshSet>,
    /// Numbers of nodes, one each.
    pub node_data: BTreeMap<String, Vec<f64>>,
    /// Numbers of cells, one each, NaN where the file has none.
    pub cell_data: BTreeMap<String, Vec<f64>>,
}

/// Some cells and nodes that have a name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshSet {
    /// Numbers of cells.
    pub cells: Vec<u32>,
    /// Numbers of nodes.
    pub nodes: Vec<u32>,
}

impl Mesh {
    /// Reads a mesh: Gmsh's `.msh`, version 4.1 or 2.2, ASCII; VTK's unstructured grids, `.vtk` in
    /// ASCII or `.vtu`. What a file is shows at its start, not in its name.
    ///
    /// # Errors
    /// [`MeshError`] with the first fault of the file, and its line where the file has lines.
    pub fn read(path: &Path) -> Result<Self, MeshError> {
        let refuse = |(line, fault)| MeshError { file: path.into(), line, fault };
        let bytes = read(path).map_err(|fault| refuse((None, fault.into())))?;
        Self::parse(&bytes).map_err(refuse)
    }

    fn parse(bytes: &[u8]) -> Result<Self, Fault> {
        let start = bytes.trim_ascii_start();
        let mesh = if start.starts_with(b"$") {
            gmsh::parse(bytes)?
        } else if start.starts_with(b"# vtk DataFile") {
            vtk::parse(bytes)?
        } else if start.starts_with(b"<") {
            vtu::parse(bytes)?
        } else {
            return Err((None, MeshFault::NotAMesh));
        };
        if mesh.cells.is_empty() {
            return Err((None, MeshFault::NoCells));
        }
        Ok(mesh)
    }

    /// Adds a cell to a set.
    fn put(&mut self, set: String, cell: u32) {
        self.sets.entry(set).or_default().cells.push(cell);
    }

    /// Makes sets of the values of integer arrays, and keeps arrays of one number.
    fn add_data(&mut self, name: &str, values: Vec<f64>, is_of_cells: bool) {
        // An array of numbers that all differ tells no parts apart.
        const MOST_SETS: usize = 1000;
        let is_whole = |value: &f64| value.fract() == 0.0 && value.abs() < 2f64.powi(53);
        if values.iter().all(is_whole) {
            let mut found: BTreeMap<i64, Vec<u32>> = BTreeMap::new();
            for (number, value) in (0u32..).zip(&values) {
                found.entry(*value as i64).or_default().push(number);
                if found.len() > MOST_SETS {
                    break;
                }
            }
            if found.len() <= MOST_SETS {
                for (value, members) in found {
                    let set = self.sets.entry(format!("{name}:{value}")).or_default();
                    match is_of_cells {
                        true => set.cells = members,
                        false => set.nodes = members,
                    }
                }
            }
        }
        let data = if is_of_cells { &mut self.cell_data } else { &mut self.node_data };
        data.insert(name.to_owned(), values);
    }
}

/// The number of a node, which must be there.
fn node(number: f64, count: usize, cell: u64) -> Result<u32, MeshFault> {
    if number >= 0.0 && number.fract() == 0.0 && number < count as f64 {
        return Ok(number as u32);
    }
    Err(MeshFault::UnknownNode { cell, node: number })
}
