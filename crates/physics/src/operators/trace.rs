//! The boundary as a cloud of cell centres sees it.

use std::ops::Range;

use super::directed::DirectedSupport;
use super::dual_gradient::DualGradient;
use crate::Vector;
use crate::geometry::Particles;

/// A face of the boundary of a body, and the particle of the cell it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face<const D: usize> {
    /// Index of the particle in memory.
    pub owner: u32,
    /// Center of the face in m.
    pub place: Vector<D>,
    /// Outward area vector in m^(D-1).
    pub area: Vector<D>,
}

/// Values on boundary faces of a cloud whose particles lie inside, theory (52).
///
/// A field takes on a face f of particle j the value `sum_k R_f(k) u_k` of a linear field around j,
/// `R_f(k) = delta_jk + (x_f - X_j) . G_jk`, exact for linear fields. A load on the face acts on
/// the particles by the same coefficients, so that its work is that of the value on the face.
#[derive(Clone, Debug)]
pub struct Trace<const D: usize> {
    faces: Vec<Face<D>>,
    /// Row of face f in the other two.
    offsets: Vec<usize>,
    particles: Vec<u32>,
    coefficients: Vec<f64>,
}

impl<const D: usize> Trace<D> {
    /// Coefficients of all faces, with plain gradients: the patch-consistent ones are made from the
    /// areas that these give. Faces whose owner does not exist are left out.
    #[inline(never)]
    pub fn new(
        faces: Vec<Face<D>>,
        particles: &Particles<D>,
        support: &DirectedSupport<D>,
        plain: &DualGradient<D>,
    ) -> Self {
        let mut trace = Self {
            faces: Vec::with_capacity(faces.len()),
            offsets: vec![0],
            particles: Vec::new(),
            coefficients: Vec::new(),
        };
        for face in faces.into_iter().filter(|face| (face.owner as usize) < particles.len()) {
            let j = face.owner as usize;
            let reach = face.place - particles.position[j];
            let row = support.list.range(j);
            let slopes =
                plain.coefficients(row.clone()).iter().map(|g| reach.dot(&Vector::from(*g)));
            trace.particles.push(face.owner);
            trace.coefficients.push(1.0 - slopes.clone().sum::<f64>());
            trace.particles.extend_from_slice(support.list.row(j));
            trace.coefficients.extend(slopes);
            trace.offsets.push(trace.particles.len());
            trace.faces.push(face);
        }
        trace
    }

    /// The faces, by which all else is numbered.
    pub fn faces(&self) -> &[Face<D>] {
        &self.faces
    }

    /// Particles with their coefficients in the value on a face: its owner, and then the support of
    /// that in order.
    pub fn row(&self, face: usize) -> Vec<(u32, f64)> {
        let row = self.range(face);
        let pairs = self.particles[row.clone()].iter().zip(&self.coefficients[row]);
        pairs.map(|(&k, &coefficient)| (k, coefficient)).collect()
    }

    /// The value of a field on a face.
    pub fn value(&self, face: usize, field: &[Vector<D>]) -> Vector<D> {
        let row = self.range(face);
        let terms = self.particles[row.clone()].iter().zip(&self.coefficients[row]);
        terms.map(|(&k, &coefficient)| field[k as usize] * coefficient).sum()
    }

    /// Adds to forces on particles what a force on a face does on them.
    pub fn spread(&self, face: usize, force: &Vector<D>, forces: &mut [Vector<D>]) {
        let row = self.range(face);
        for (&k, &coefficient) in self.particles[row.clone()].iter().zip(&self.coefficients[row]) {
            forces[k as usize] += force * coefficient;
        }
    }

    /// Boundary area vectors of `count` particles in m^(D-1), `sum_f A_f R_f(k)`. They close the
    /// volumes of cells that fill a body, as patch-consistent gradients need.
    pub fn areas(&self, count: usize) -> Vec<Vector<D>> {
        let mut areas = vec![Vector::zeros(); count];
        for (index, face) in self.faces.iter().enumerate() {
            self.spread(index, &face.area, &mut areas);
        }
        areas
    }

    fn range(&self, face: usize) -> Range<usize> {
        self.offsets[face]..self.offsets[face + 1]
    }
}
