//! The boundary of bodies whose particles come from meshes, and the names of its parts.

use std::collections::BTreeMap;

use super::cloud::{BoundaryFace, CloudPoints, NamedSet};
use crate::Vector;

/// Faces and named sets of particles. Nothing where no body comes from a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface<const D: usize> {
    /// Where the particles of a body are in its mesh, for the bodies that have one.
    pub bodies: BTreeMap<u32, CloudPoints>,
    /// The faces of cells that lie on the boundaries of these bodies.
    pub faces: Vec<BoundaryFace<D>>,
    /// The named sets that have a part in them.
    pub sets: BTreeMap<String, NamedSet>,
}

impl<const D: usize> Surface<D> {
    /// Outward area vectors of `count` particles in m^(D-1): of nodes their shares of the faces,
    /// which sum to zero, and times their places to the volume. Zero for centroids of cells, which
    /// lie inside, and for particles of other bodies.
    pub fn areas(&self, count: usize) -> Vec<Vector<D>> {
        let mut areas = vec![Vector::zeros(); count];
        for face in self.faces.iter().filter(|face| face.is_of_nodes()) {
            for sample in face.samples() {
                for (particle, share) in sample.shares {
                    areas[particle as usize] += sample.area * share;
                }
            }
        }
        areas
    }

    /// Numbers particles anew: those of `old` become `number(old)`.
    pub(super) fn renumber(&mut self, number: impl Fn(u32) -> u32) {
        for face in &mut self.faces {
            face.particles.iter_mut().for_each(|particle| *particle = number(*particle));
        }
        for set in self.sets.values_mut() {
            set.particles.iter_mut().for_each(|particle| *particle = number(*particle));
            set.particles.sort_unstable();
        }
    }

    /// Adds the boundary of what becomes body `body`, whose particles follow `first` others.
    pub(super) fn append(&mut self, mut other: Self, body: u32, first: u32) {
        other.renumber(|particle| particle + first);
        self.bodies.extend(other.bodies.into_values().map(|points| (body, points)));
        let faces = self.faces.len() as u32;
        self.faces.extend(other.faces);
        for (name, set) in other.sets {
            let own = self.sets.entry(name).or_default();
            own.particles.extend(set.particles);
            own.faces.extend(set.faces.iter().map(|face| face + faces));
        }
    }
}
