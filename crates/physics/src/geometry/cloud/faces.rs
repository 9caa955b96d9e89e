//! The boundary of a body of cells.

use std::collections::HashMap;

use super::cells::{Solid, area, face_pieces, mean};
use super::{CloudPoints, Fault, Numbers};
use crate::Vector;
use crate::geometry::mesh::{Mesh, MeshFault};

/// Faces of four corners that leave their plane by less than this share of their area are plane.
const PLANE: f64 = 1e-10;

/// A part of the boundary, with the particles that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryFace<const D: usize> {
    /// Its centre in m.
    pub place: Vector<D>,
    /// Its outward area vector in m^(D-1).
    pub area: Vector<D>,
    /// The particles of its corners, in their order; of a cloud of centroids that of its cell.
    pub particles: Vec<u32>,
    /// Its simplices: places, and for each the share of each corner.
    simplices: Vec<Vec<(Vector<D>, Vec<f64>)>>,
}

/// A point of a face for sums over it.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceSample<const D: usize> {
    /// Where it is, in m.
    pub place: Vector<D>,
    /// The part of the outward area that it stands for, in m^(D-1).
    pub area: Vector<D>,
    /// Shares of the particles in what acts here; they sum to 1.
    pub shares: Vec<(u32, f64)>,
}

impl<const D: usize> BoundaryFace<D> {
    /// Whether its corners are particles; otherwise the cell behind it is one.
    pub fn is_of_nodes(&self) -> bool {
        let corner = self.simplices.first().and_then(|simplex| simplex.first());
        corner.is_some_and(|(_, shares)| shares.len() == self.particles.len())
    }

    /// Points for sums over the face: exact for polynomials of the fourth degree.
    #[inline(never)]
    pub fn samples(&self) -> Vec<FaceSample<D>> {
        let mut samples = Vec::new();
        let is_of_nodes = self.is_of_nodes();
        for simplex in &self.simplices {
            let places: Vec<Vector<D>> = simplex.iter().map(|(place, _)| *place).collect();
            let area = if D == 1 { self.area } else { area(&places, true) };
            for (weights, part) in rule(D) {
                let at = |value: &dyn Fn(usize) -> f64| -> f64 {
                    (0..D).map(|k| weights[k] * value(k)).sum()
                };
                let place = Vector::from_fn(|axis, _| at(&|k| places[k][axis]));
                let shares = match is_of_nodes {
                    true => {
                        let share = |corner: usize| at(&|k| simplex[k].1[corner]);
                        let corners = self.particles.iter().enumerate();
                        corners.map(|(corner, &particle)| (particle, share(corner))).collect()
                    }
                    false => vec![(self.particles[0], 1.0)],
                };
                samples.push(FaceSample { place, area: area * *part, shares });
            }
        }
        samples
    }
}

/// Points of a simplex of D corners by their weights, with the part of it they stand for.
fn rule(dimension: usize) -> &'static [([f64; 3], f64)] {
    // Gauss on a line; the six points of Dunavant on a triangle.
    const NEAR: f64 = 0.112_701_665_379_258_3;
    const A: f64 = 0.445_948_490_915_964_9;
    const B: f64 = 0.091_576_213_509_770_7;
    const OF_A: f64 = 0.223_381_589_678_011_47;
    const OF_B: f64 = 1.0 / 3.0 - OF_A;
    const TRIANGLE: [([f64; 3], f64); 6] = [
        ([A, A, 1.0 - 2.0 * A], OF_A),
        ([A, 1.0 - 2.0 * A, A], OF_A),
        ([1.0 - 2.0 * A, A, A], OF_A),
        ([B, B, 1.0 - 2.0 * B], OF_B),
        ([B, 1.0 - 2.0 * B, B], OF_B),
        ([1.0 - 2.0 * B, B, B], OF_B),
    ];
    match dimension {
        1 => &[([1.0, 0.0, 0.0], 1.0)],
        2 => &[
            ([NEAR, 1.0 - NEAR, 0.0], 5.0 / 18.0),
            ([0.5, 0.5, 0.0], 4.0 / 9.0),
            ([1.0 - NEAR, NEAR, 0.0], 5.0 / 18.0),
        ],
        _ => &TRIANGLE,
    }
}

/// A face of one cell only.
pub(super) struct Boundary<const D: usize> {
    /// The number of its cell among those of the body.
    pub solid: usize,
    /// Its nodes, which turn around the outward normal.
    pub nodes: Vec<u32>,
    /// Its simplices: each corner with its share of the nodes.
    simplices: Vec<Vec<(Vector<D>, Vec<f64>)>>,
    /// Area vectors of the simplices.
    areas: Vec<Vector<D>>,
}

/// Nodes in ascending order, by which the faces of two cells are recognised as one.
pub(super) fn key(nodes: &[u32]) -> [u32; 4] {
    let mut key = [u32::MAX; 4];
    key.iter_mut().zip(nodes).for_each(|(key, node)| *key = *node);
    key.sort_unstable();
    key
}

/// The faces that belong to one cell only, in the order of the cells.
pub(super) fn boundary<const D: usize>(
    mesh: &Mesh,
    solids: &[Solid<D>],
) -> Result<Vec<Boundary<D>>, Fault> {
    let nodes_of = |solid: &Solid<D>, places: &[usize]| -> Vec<u32> {
        let own = mesh.cells[solid.cell].nodes();
        places.iter().map(|&place| own[place]).collect()
    };
    let mut cells: HashMap<[u32; 4], u8> = HashMap::new();
    for solid in solids {
        let cell = &mesh.cells[solid.cell];
        for places in cell.kind.faces() {
            let nodes = nodes_of(solid, places);
            let count = cells.entry(key(&nodes)).or_insert(0);
            *count += 1;
            if *count > 2 {
                let at = mean::<D>(mesh, &nodes).place.as_slice().to_vec();
                let line = (cell.line > 0).then_some(cell.line);
                return Err((line, MeshFault::Shared { cell: cell.number, place: at }));
            }
        }
    }
    let mut boundary = Vec::new();
    for (number, solid) in solids.iter().enumerate() {
        for (face, places) in mesh.cells[solid.cell].kind.faces().iter().enumerate() {
            let mut nodes = nodes_of(solid, places);
            if cells.get(&key(&nodes)) == Some(&1) {
                if solid.is_turned {
                    nodes.reverse();
                }
                boundary.push(Boundary::new(mesh, number, nodes, (face > 0) != solid.is_turned));
            }
        }
    }
    Ok(boundary)
}

impl<const D: usize> Boundary<D> {
    fn new(mesh: &Mesh, solid: usize, nodes: Vec<u32>, forward: bool) -> Self {
        let shares = |own: &[u32]| -> Vec<f64> {
            let share = |node: &u32| if own.contains(node) { 1.0 / own.len() as f64 } else { 0.0 };
            nodes.iter().map(share).collect()
        };
        let pieces = face_pieces::<D>(mesh, &nodes);
        let simplices: Vec<Vec<(Vector<D>, Vec<f64>)>> = pieces
            .iter()
            .map(|corners| corners.iter().map(|c| (c.place, shares(&c.nodes))).collect())
            .collect();
        let areas = simplices.iter().map(|simplex| {
            let places: Vec<Vector<D>> = simplex.iter().map(|(place, _)| *place).collect();
            area(&places, forward)
        });
        Self { solid, nodes, areas: areas.collect(), simplices }
    }

    /// The face as the cloud sees it; in parts where it is not plane and values of its centre would
    /// not do for it.
    pub fn parts(&self, numbers: &Numbers) -> Vec<BoundaryFace<D>> {
        let is_of_cells = numbers.points == CloudPoints::Cells;
        let particles: Vec<u32> = match is_of_cells {
            true => vec![self.solid as u32],
            false => {
                let own = |&node: &u32| numbers.of_node[node as usize];
                self.nodes.iter().filter_map(own).collect()
            }
        };
        let total: Vector<D> = self.areas.iter().sum();
        let size = total.norm();
        let is_plane = self.areas.iter().all(|area| {
            let along = total * (area.dot(&total) / (size * size));
            (area - along).norm() <= PLANE * size
        });
        let face = |simplices: &[Vec<(Vector<D>, Vec<f64>)>], areas: &[Vector<D>]| {
            let whole: f64 = areas.iter().map(Vector::norm).sum();
            let centre = |simplex: &Vec<(Vector<D>, Vec<f64>)>| -> Vector<D> {
                simplex.iter().map(|(place, _)| place).sum::<Vector<D>>() / D as f64
            };
            let parts = simplices.iter().zip(areas);
            BoundaryFace {
                place: parts.map(|(s, area)| centre(s) * (area.norm() / whole)).sum(),
                area: areas.iter().sum(),
                particles: particles.clone(),
                simplices: simplices.to_vec(),
            }
        };
        if is_plane || !is_of_cells {
            return vec![face(&self.simplices, &self.areas)];
        }
        let parts = self.simplices.chunks(1).zip(self.areas.chunks(1));
        parts.map(|(simplex, area)| face(simplex, area)).collect()
    }
}
