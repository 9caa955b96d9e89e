//! The cells that make up a body.

use super::Fault;
use crate::Vector;
use crate::geometry::mesh::{Cell, CellKind, Mesh, MeshFault};

/// Measures below this share of the largest edge to the power D are those of flat cells.
const FLAT: f64 = 1e-12;

/// Parts of a cell that point the wrong way by this share of it are no rounding.
const FOLD: f64 = 1e-9;

/// Coordinates of a flat mesh differ by less than this share of its extent.
const SAME_PLANE: f64 = 1e-9;

/// A cell of dimension D, cut into simplices between its faces and the mean of its nodes.
pub(super) struct Solid<const D: usize> {
    /// Its number in the mesh.
    pub cell: usize,
    /// Its measure in m^D, positive.
    pub measure: f64,
    /// Whether its nodes turn the other way, so that its faces do too.
    pub is_turned: bool,
    pub pieces: Vec<Piece<D>>,
}

/// A simplex of a cell: corners on a face, last the mean of all nodes.
pub(super) struct Piece<const D: usize> {
    pub corners: Vec<Corner<D>>,
    /// Its measure in m^D, positive.
    pub measure: f64,
}

/// A corner of a piece.
#[derive(Clone)]
pub(super) struct Corner<const D: usize> {
    pub place: Vector<D>,
    /// The nodes that it is the mean of.
    pub nodes: Vec<u32>,
}

/// The place of a node.
pub(super) fn place<const D: usize>(mesh: &Mesh, node: u32) -> Vector<D> {
    Vector::from_column_slice(&mesh.nodes[node as usize][..D])
}

/// The mean of some nodes.
pub(super) fn mean<const D: usize>(mesh: &Mesh, nodes: &[u32]) -> Corner<D> {
    let sum: Vector<D> = nodes.iter().map(|&node| place(mesh, node)).sum();
    Corner { place: sum / nodes.len() as f64, nodes: nodes.to_vec() }
}

/// A face in simplices: itself, or triangles around the mean of its nodes.
pub(super) fn face_pieces<const D: usize>(mesh: &Mesh, nodes: &[u32]) -> Vec<Vec<Corner<D>>> {
    let corner = |node: u32| mean(mesh, &[node]);
    if nodes.len() <= D {
        return vec![nodes.iter().map(|&node| corner(node)).collect()];
    }
    let turn = nodes.iter().zip(nodes.iter().cycle().skip(1));
    turn.map(|(&a, &b)| vec![corner(a), corner(b), mean(mesh, nodes)]).collect()
}

/// Area vector of a simplex of dimension D - 1 in m^(D-1), by the right hand in space; `forward` is
/// its sign on a line, where it is a point.
pub(super) fn area<const D: usize>(corners: &[Vector<D>], forward: bool) -> Vector<D> {
    let edge = |k: usize, axis: usize| corners[k][axis] - corners[0][axis];
    let components = match D {
        1 => [if forward { 1.0 } else { -1.0 }, 0.0, 0.0],
        2 => [edge(1, 1), -edge(1, 0), 0.0],
        _ => {
            let cross = |i: usize, j: usize| edge(1, i) * edge(2, j) - edge(1, j) * edge(2, i);
            [0.5 * cross(1, 2), 0.5 * cross(2, 0), 0.5 * cross(0, 1)]
        }
    };
    Vector::from_column_slice(&components[..D])
}

/// The cells of dimension D of a part of a mesh.
pub(super) fn solids<const D: usize>(
    mesh: &Mesh,
    part: Option<&str>,
) -> Result<Vec<Solid<D>>, Fault> {
    let numbers = members(mesh, part)?;
    let of_body: Vec<usize> =
        numbers.iter().copied().filter(|&n| mesh.cells[n].kind.dimension() == D).collect();
    let mut found: Vec<usize> = numbers.iter().map(|&n| mesh.cells[n].kind.dimension()).collect();
    found.sort_unstable();
    found.dedup();
    let is_of_more = part.is_none() && found.last().is_some_and(|&dimension| dimension > D);
    if of_body.is_empty() || is_of_more {
        let found = if is_of_more { found.into_iter().filter(|d| *d > D).collect() } else { found };
        return Err((None, MeshFault::Dimension { expected: D, found, is_of_more }));
    }
    is_flat::<D>(mesh, &of_body)?;
    let mut solids = Vec::with_capacity(of_body.len());
    for number in of_body {
        solids.push(solid::<D>(mesh, number)?);
    }
    no_turn_of_a_kind(mesh, &solids)?;
    Ok(solids)
}

/// The numbers of the cells of a part.
fn members(mesh: &Mesh, part: Option<&str>) -> Result<Vec<usize>, Fault> {
    let Some(name) = part else { return Ok((0..mesh.cells.len()).collect()) };
    let set = mesh.sets.get(name).filter(|set| !set.cells.is_empty()).ok_or_else(|| {
        let known = super::sets::listed(mesh.sets.keys());
        (None, MeshFault::NoSet { name: name.to_owned(), known })
    })?;
    let mut cells: Vec<usize> = set.cells.iter().map(|&cell| cell as usize).collect();
    cells.sort_unstable();
    cells.dedup();
    Ok(cells)
}

fn line(cell: &Cell) -> Option<u64> {
    (cell.line > 0).then_some(cell.line)
}

/// Refuses a mesh of fewer than three dimensions that leaves them.
fn is_flat<const D: usize>(mesh: &Mesh, numbers: &[usize]) -> Result<(), Fault> {
    let nodes = || numbers.iter().flat_map(|&n| mesh.cells[n].nodes().iter().map(move |&a| (n, a)));
    let extent = |axis: usize| {
        let places = || nodes().map(|(_, node)| mesh.nodes[node as usize][axis]);
        places().fold(f64::NEG_INFINITY, f64::max) - places().fold(f64::INFINITY, f64::min)
    };
    let size = (0..3).map(extent).fold(0.0, f64::max);
    for axis in D..3 {
        let first = nodes().next().map_or(0.0, |(_, node)| mesh.nodes[node as usize][axis]);
        for (number, node) in nodes() {
            let got = mesh.nodes[node as usize][axis];
            if (got - first).abs() > SAME_PLANE * size {
                let cell = &mesh.cells[number];
                let (expected, dimension) = (first, D);
                let cell_number = cell.number;
                let fault =
                    MeshFault::NotFlat { cell: cell_number, axis, got, expected, dimension };
                return Err((line(cell), fault));
            }
        }
    }
    Ok(())
}

fn solid<const D: usize>(mesh: &Mesh, number: usize) -> Result<Solid<D>, Fault> {
    let cell = &mesh.cells[number];
    let centre = mean::<D>(mesh, cell.nodes());
    let mut pieces = Vec::new();
    for (face, places) in cell.kind.faces().iter().enumerate() {
        let nodes: Vec<u32> = places.iter().map(|&place| cell.nodes()[place]).collect();
        for mut corners in face_pieces(mesh, &nodes) {
            let on_face: Vec<Vector<D>> = corners.iter().map(|corner| corner.place).collect();
            let measure = (on_face[0] - centre.place).dot(&area(&on_face, face > 0)) / D as f64;
            corners.push(centre.clone());
            pieces.push(Piece { corners, measure });
        }
    }
    let measure: f64 = pieces.iter().map(|piece| piece.measure).sum();
    let reach = cell.nodes().iter().map(|&node| (place(mesh, node) - centre.place).norm());
    let size = 2.0 * reach.fold(0.0, f64::max);
    let at = || centre.place.as_slice().to_vec();
    if !(measure.abs() > FLAT * size.powi(D as i32)) {
        let fault = MeshFault::Flat { cell: cell.number, place: at(), measure };
        return Err((line(cell), fault));
    }
    let sign = measure.signum();
    for piece in &mut pieces {
        piece.measure *= sign;
        if piece.measure < -FOLD * measure.abs() {
            return Err((line(cell), MeshFault::Folded { cell: cell.number, place: at() }));
        }
    }
    Ok(Solid { cell: number, measure: measure.abs(), is_turned: sign < 0.0, pieces })
}

/// Refuses cells that turn against most others of their kind. Programs disagree on which way the
/// nodes of a wedge turn, but each always turns them alike.
fn no_turn_of_a_kind<const D: usize>(mesh: &Mesh, solids: &[Solid<D>]) -> Result<(), Fault> {
    let kind = |solid: &Solid<D>| mesh.cells[solid.cell].kind;
    let mut kinds: Vec<CellKind> = Vec::new();
    for solid in solids {
        if !kinds.contains(&kind(solid)) {
            kinds.push(kind(solid));
        }
    }
    for of_kind in kinds {
        let own = || solids.iter().filter(|solid| kind(solid) == of_kind);
        let turned = own().filter(|solid| solid.is_turned).count();
        let most = 2 * turned > own().count();
        if let Some(odd) = own().find(|solid| solid.is_turned != most) {
            let cell = &mesh.cells[odd.cell];
            let at = mean::<D>(mesh, cell.nodes()).place.as_slice().to_vec();
            let measure = if odd.is_turned { -odd.measure } else { odd.measure };
            let fault = MeshFault::Inverted { cell: cell.number, place: at, measure };
            return Err((line(cell), fault));
        }
    }
    Ok(())
}
