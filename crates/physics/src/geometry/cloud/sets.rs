//! What the named sets of a mesh are in a cloud.

use std::collections::{BTreeMap, HashMap};

use super::cells::Solid;
use super::faces::{Boundary, key};
use super::{CloudPoints, Numbers};
use crate::geometry::mesh::{Mesh, MeshSet};

/// Most names in a message.
const MOST_NAMES: usize = 12;

/// The part of a named set that lies in a body.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NamedSet {
    /// Particles in ascending order: nodes of its cells, faces, edges and points; of a cloud of
    /// centroids its cells, and those behind its faces.
    pub particles: Vec<u32>,
    /// Faces of the cloud in ascending order: those of its faces that lie on the boundary.
    pub faces: Vec<u32>,
}

/// Names for a message, not too many of them.
pub(super) fn listed<'a>(names: impl ExactSizeIterator<Item = &'a String>) -> String {
    let more = names.len().saturating_sub(MOST_NAMES);
    let first: Vec<String> = names.take(MOST_NAMES).map(|name| format!("`{name}`")).collect();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    first.join(", ") + &more
}

/// All sets that have a part in the body.
pub(super) fn sets<const D: usize>(
    mesh: &Mesh,
    solids: &[Solid<D>],
    numbers: &Numbers,
    boundary: &[Boundary<D>],
) -> BTreeMap<String, NamedSet> {
    let mut finder = Finder { mesh, numbers, solid_of: HashMap::new(), faces: HashMap::new() };
    for (number, solid) in (0u32..).zip(solids) {
        finder.solid_of.insert(solid.cell, number);
    }
    let mut next = 0;
    for face in boundary {
        let parts = face.parts(numbers).len() as u32;
        finder.faces.insert(key(&face.nodes), (face.solid as u32, next, parts));
        next += parts;
    }
    let all = mesh.sets.iter().map(|(name, set)| (name.clone(), finder.part::<D>(set)));
    all.filter(|(_, set)| !set.particles.is_empty() || !set.faces.is_empty()).collect()
}

struct Finder<'a> {
    mesh: &'a Mesh,
    numbers: &'a Numbers,
    /// The cell of the body by its number in the mesh.
    solid_of: HashMap<usize, u32>,
    /// By the nodes of a face of the boundary, its cell, its first face of the cloud and how many.
    faces: HashMap<[u32; 4], (u32, u32, u32)>,
}

impl Finder<'_> {
    fn part<const D: usize>(&self, set: &MeshSet) -> NamedSet {
        let mut found = NamedSet::default();
        let is_of_cells = self.numbers.points == CloudPoints::Cells;
        for &number in &set.cells {
            let cell = &self.mesh.cells[number as usize];
            if !is_of_cells {
                let own = cell.nodes().iter().filter_map(|&a| self.numbers.of_node[a as usize]);
                found.particles.extend(own);
            }
            if cell.kind.dimension() == D {
                let own = self.solid_of.get(&(number as usize));
                found.particles.extend(own.filter(|_| is_of_cells));
            } else if cell.kind.dimension() + 1 == D
                && let Some(&(solid, first, parts)) = self.faces.get(&key(cell.nodes()))
            {
                found.faces.extend(first..first + parts);
                found.particles.extend(is_of_cells.then_some(solid));
            }
        }
        let nodes = set.nodes.iter().filter_map(|&a| self.numbers.of_node[a as usize]);
        found.particles.extend(nodes);
        for list in [&mut found.particles, &mut found.faces] {
            list.sort_unstable();
            list.dedup();
        }
        found
    }
}
