//! Kinds of cells.

use super::MeshFault;

/// The shape of a cell, with straight edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// A point.
    Point,
    /// A line from a node to another.
    Line,
    /// Three nodes.
    Triangle,
    /// Four nodes around a face.
    Quadrilateral,
    /// Four nodes.
    Tetrahedron,
    /// Eight nodes, the lower face and the upper one.
    Hexahedron,
    /// Six nodes, the lower triangle and the upper one.
    Wedge,
    /// Four nodes around a face, and a top.
    Pyramid,
}

impl CellKind {
    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quadrilateral | Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Wedge => 6,
            Self::Hexahedron => 8,
        }
    }

    /// Dimensions of its inside.
    pub fn dimension(self) -> usize {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle | Self::Quadrilateral => 2,
            Self::Tetrahedron | Self::Hexahedron | Self::Wedge | Self::Pyramid => 3,
        }
    }

    /// Places in the cell of the nodes of its faces, which turn around the outward normal where the
    /// cell's measure is positive.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Point => &[],
            Self::Line => &[&[0], &[1]],
            Self::Triangle => &[&[0, 1], &[1, 2], &[2, 0]],
            Self::Quadrilateral => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Self::Tetrahedron => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]],
            Self::Hexahedron => &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
            Self::Wedge => &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
            Self::Pyramid => &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
        }
    }

    /// The kind that Gmsh numbers so.
    pub(super) fn of_gmsh(number: u64) -> Result<Self, MeshFault> {
        Ok(match number {
            1 => Self::Line,
            2 => Self::Triangle,
            3 => Self::Quadrilateral,
            4 => Self::Tetrahedron,
            5 => Self::Hexahedron,
            6 => Self::Wedge,
            7 => Self::Pyramid,
            15 => Self::Point,
            8..=14 | 16..=31 | 36..=93 => {
                let help = "set Mesh.ElementOrder to 1 in Gmsh";
                return Err(MeshFault::HigherOrder { number, help });
            }
            _ => return Err(MeshFault::UnknownCell { number }),
        })
    }

    /// The kind that VTK numbers so, and the order of its nodes where that differs.
    pub(super) fn of_vtk(number: u64) -> Result<(Self, Option<&'static [usize]>), MeshFault> {
        Ok(match number {
            1 => (Self::Point, None),
            3 => (Self::Line, None),
            5 => (Self::Triangle, None),
            8 => (Self::Quadrilateral, Some(&[0, 1, 3, 2])),
            9 => (Self::Quadrilateral, None),
            10 => (Self::Tetrahedron, None),
            11 => (Self::Hexahedron, Some(&[0, 1, 3, 2, 4, 5, 7, 6])),
            12 => (Self::Hexahedron, None),
            13 => (Self::Wedge, None),
            14 => (Self::Pyramid, None),
            21..=37 | 60..=81 => {
                let help = "write the mesh with linear cells";
                return Err(MeshFault::HigherOrder { number, help });
            }
            _ => return Err(MeshFault::UnknownCell { number }),
        })
    }
}

/// A cell of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Its kind.
    pub kind: CellKind,
    /// Its number in the file.
    pub number: u64,
    /// Its line in the file, 0 if there are none.
    pub line: u64,
    nodes: [u32; 8],
}

impl Cell {
    /// A cell with as many nodes as its kind has.
    pub(super) fn new(kind: CellKind, number: u64, line: u64, nodes: &[u32]) -> Self {
        let mut own = [0; 8];
        own.iter_mut().zip(nodes).for_each(|(own, node)| *own = *node);
        Self { kind, number, line, nodes: own }
    }

    /// Its nodes.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.kind.nodes()]
    }
}
