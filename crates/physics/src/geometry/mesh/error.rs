//! What can be wrong with a mesh.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::coordinates;
use crate::geometry::file::{FileFault, MOST_BYTES};

/// Why a mesh cannot be used, and where.
#[derive(Debug, Error)]
#[error("{}{}: {fault}", file.display(), line.map_or(String::new(), |line| format!(", line {line}")))]
pub struct MeshError {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1, where the fault is on one.
    pub line: Option<u64>,
    /// What is wrong.
    pub fault: MeshFault,
}

/// What can be wrong with a mesh.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// The system refuses to read it.
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    /// It is a folder or a device.
    #[error("is not a file")]
    NotAFile,
    /// It is larger than what is read.
    #[error("is larger than {} bytes, expected a smaller mesh", MOST_BYTES)]
    TooLarge,
    /// It starts like no format that is known.
    #[error("is not a mesh, expected a Gmsh mesh (.msh) or a VTK unstructured grid (.vtk, .vtu)")]
    NotAMesh,
    /// A format, or a part of one, that is not read.
    #[error("{what} cannot be read; {help}")]
    Unsupported {
        /// What it is.
        what: String,
        /// What to do.
        help: &'static str,
    },
    /// A part is not there.
    #[error("has no {what}")]
    Missing {
        /// The part.
        what: String,
    },
    /// The file ends too soon.
    #[error("the file ends, expected {expected}")]
    Ends {
        /// What should come.
        expected: &'static str,
    },
    /// Something else stands where something is expected.
    #[error("got `{got}`, expected {expected}")]
    Unexpected {
        /// The start of what is there.
        got: String,
        /// What should be there.
        expected: &'static str,
    },
    /// Two parts of a file that contradict each other.
    #[error("{what} has {got} entries, expected {expected}")]
    Count {
        /// What is counted.
        what: String,
        /// How many there are.
        got: usize,
        /// How many there should be.
        expected: usize,
    },
    /// Data that cannot be unpacked.
    #[error("{what} cannot be unpacked: {why}")]
    Packed {
        /// The array.
        what: String,
        /// Why.
        why: String,
    },
    /// A number that is used twice.
    #[error("{what} {number} appears twice")]
    Twice {
        /// A node, or a cell.
        what: &'static str,
        /// Its number.
        number: u64,
    },
    /// A cell of a node that is not there.
    #[error("cell {cell} refers to node {node}, which the file does not contain")]
    UnknownNode {
        /// Number of the cell.
        cell: u64,
        /// Number of the node.
        node: f64,
    },
    /// A cell with curved edges.
    #[error("a cell of the type {number} is of higher order, expected straight edges; {help}")]
    HigherOrder {
        /// The number of the type in the format.
        number: u64,
        /// What to do.
        help: &'static str,
    },
    /// A cell that is no simple one.
    #[error(
        "cells of the type {number} are not supported, expected points, lines, triangles, \
         quadrilaterals, tetrahedra, hexahedra, wedges and pyramids"
    )]
    UnknownCell {
        /// The number of the type in the format.
        number: u64,
    },
    /// A mesh of nothing.
    #[error("holds no cells, expected a mesh")]
    NoCells,
    /// Cells of other dimensions.
    #[error(
        "has {}{}; a case of dimension {expected} is made of cells of this dimension, or of a \
         named set of them",
        found.iter().map(|d| format!("cells of dimension {d}")).collect::<Vec<_>>().join(" and "),
        if *is_of_more { "" } else { " only" }
    )]
    Dimension {
        /// Dimension of the case.
        expected: usize,
        /// Dimensions of the cells.
        found: Vec<usize>,
        /// Whether these are more than those of the case.
        is_of_more: bool,
    },
    /// A mesh of fewer dimensions that is not where they are.
    #[error(
        "cell {cell} lies at {} = {got} m, others at {expected} m; a mesh of dimension {dimension} \
         must lie {}", ["x", "y", "z"][*axis],
        if *dimension == 2 { "in a plane z = constant" } else { "on a line along x" }
    )]
    NotFlat {
        /// Number of the cell.
        cell: u64,
        /// The axis across.
        axis: usize,
        /// The coordinate of a node in m.
        got: f64,
        /// That of others in m.
        expected: f64,
        /// Dimension of the case.
        dimension: usize,
    },
    /// A cell of no measure.
    #[error(
        "cell {cell} at {at} is flat: its measure is {measure} m^D; repair the mesh",
        at = coordinates(place)
    )]
    Flat {
        /// Number of the cell.
        cell: u64,
        /// Its centre in m.
        place: Vec<f64>,
        /// Its measure in m^D.
        measure: f64,
    },
    /// A cell that is turned inside out.
    #[error(
        "cell {cell} at {at} is inverted: its measure is {measure} m^D, opposite in sign to \
         the others; reverse the order of its nodes, or repair the mesh",
        at = coordinates(place)
    )]
    Inverted {
        /// Number of the cell.
        cell: u64,
        /// Its centre in m.
        place: Vec<f64>,
        /// Its measure in m^D.
        measure: f64,
    },
    /// A cell that is partly turned inside out.
    #[error(
        "cell {cell} at {at} is folded: a part of it is inverted; repair the mesh",
        at = coordinates(place)
    )]
    Folded {
        /// Number of the cell.
        cell: u64,
        /// Its centre in m.
        place: Vec<f64>,
    },
    /// Cells that overlap.
    #[error(
        "cell {cell} at {at} has a face that two other cells share; a face belongs to at \
         most two cells: remove duplicate cells",
        at = coordinates(place)
    )]
    Shared {
        /// Number of the cell.
        cell: u64,
        /// The centre of the face in m.
        place: Vec<f64>,
    },
    /// A set that is not there.
    #[error(
        "has no set `{name}`{}",
        if known.is_empty() { ", and no sets at all".into() } else { format!("; it has {known}") }
    )]
    NoSet {
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
    /// An array that is not there.
    #[error(
        "has no array `{name}` of {what}{}",
        if known.is_empty() { ", and no such array at all".into() } else { format!("; it has {known}") }
    )]
    NoArray {
        /// The name.
        name: String,
        /// Nodes, or cells.
        what: &'static str,
        /// The names there are.
        known: String,
    },
    /// A volume or a spacing that no particle can have.
    #[error("the array `{name}` has {got} for {what} {number}, expected a number above 0")]
    NotPositive {
        /// Name of the array.
        name: String,
        /// Node, or cell.
        what: &'static str,
        /// Its number: that of a cell in the file, that of a node from 0.
        number: u64,
        /// The number in the array.
        got: f64,
    },
    /// Volumes that do not make up the body.
    #[error(
        "the volumes of the array `{name}` sum to {sum} m^D, but the cells to {volume}; expected \
         the same to one part in ten thousand"
    )]
    Sum {
        /// Name of the array.
        name: String,
        /// Their sum.
        sum: f64,
        /// That of the cells.
        volume: f64,
    },
}

impl From<FileFault> for MeshFault {
    fn from(fault: FileFault) -> Self {
        match fault {
            FileFault::Unreadable(error) => Self::Unreadable(error),
            FileFault::NotAFile => Self::NotAFile,
            FileFault::TooLarge => Self::TooLarge,
        }
    }
}
