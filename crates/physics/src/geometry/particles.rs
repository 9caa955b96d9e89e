//! The particles that geometry makes and schemes are bound to.

use std::ops::Range;

use super::{GeometryError, Surface};
use crate::Vector;

/// Reference state of the particles of a run, as a struct of arrays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Particles<const D: usize> {
    /// Reference positions X in m.
    pub position: Vec<Vector<D>>,
    /// Quadrature volumes V in m^D: what carries mass and energy. On a lattice with particles on
    /// the boundary a particle on an edge has half a cell, in a corner a quarter.
    pub volume: Vec<f64>,
    /// Kernel weights w in m^D: what multiplies a kernel inside a sum. On a lattice this is the
    /// whole cell for every particle, also at the boundary.
    pub weight: Vec<f64>,
    /// Local particle spacing in m: the largest edge of the particle's lattice cell.
    pub spacing: Vec<f64>,
    /// Number of the body each particle belongs to.
    pub body: Vec<u32>,
    /// Number of each particle in the order of creation, kept when particles are reordered.
    pub id: Vec<u32>,
    /// The boundary of bodies whose particles come from meshes, by index of the particles.
    pub surface: Surface<D>,
}

impl<const D: usize> Particles<D> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Those that follow each other in memory, with their numbers, and without surfaces of meshes.
    pub fn part(&self, own: Range<usize>) -> Self {
        Self {
            position: self.position[own.clone()].to_vec(),
            volume: self.volume[own.clone()].to_vec(),
            weight: self.weight[own.clone()].to_vec(),
            spacing: self.spacing[own.clone()].to_vec(),
            body: self.body[own.clone()].to_vec(),
            id: self.id[own].to_vec(),
            surface: Surface::default(),
        }
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        size_of_val(self.position.as_slice())
            + size_of_val(self.volume.as_slice())
            + size_of_val(self.weight.as_slice())
            + size_of_val(self.spacing.as_slice())
            + size_of_val(self.body.as_slice())
            + size_of_val(self.id.as_slice())
    }

    /// Reorders all arrays: particle `order[i]` becomes particle `i`.
    ///
    /// `order` is a permutation of `0..len`.
    pub fn reorder(&mut self, order: &[u32]) {
        let mut place = vec![0; order.len()];
        (0u32..).zip(order).for_each(|(new, &old)| place[old as usize] = new);
        self.gather(order, &place);
    }

    /// Keeps the particles `order` (indices), none of them of a mesh, in this order, and numbers them anew.
    pub fn keep(&mut self, order: &[u32]) {
        self.gather(order, &[]);
        self.id = (0..order.len() as u32).collect();
    }

    /// Appends some of the particles (indices) of others, none of them of a mesh, as parts of the same bodies. Their
    /// numbers continue where those here end.
    pub fn extend(&mut self, others: &Self, which: &[u32]) {
        let first = self.id.iter().max().map_or(0, |last| last + 1);
        for a in which.iter().map(|&a| a as usize) {
            self.position.push(others.position[a]);
            self.volume.push(others.volume[a]);
            self.weight.push(others.weight[a]);
            self.spacing.push(others.spacing[a]);
            self.body.push(others.body[a]);
            self.id.push(first + others.id[a]);
        }
    }

    /// Makes one particle of each pair of two: the first stays where it is, with the volumes of both.
    /// What belonged to the second one on the surface of a mesh belongs to the first. Returns the old
    /// index of each particle that is left.
    ///
    /// No particle is the second of two pairs, or the second of one and the first of another.
    pub fn join(&mut self, pairs: &[(u32, u32)]) -> Vec<u32> {
        let mut into: Vec<u32> = (0..self.len() as u32).collect();
        for &(first, second) in pairs {
            self.volume[first as usize] += self.volume[second as usize];
            into[second as usize] = first;
        }
        let order: Vec<u32> =
            (0u32..).zip(&into).filter(|(a, b)| a == *b).map(|(a, _)| a).collect();
        let mut place = vec![0; self.len()];
        (0u32..).zip(&order).for_each(|(new, &old)| place[old as usize] = new);
        let places: Vec<u32> = into.iter().map(|&first| place[first as usize]).collect();
        self.gather(&order, &places);
        order
    }

    /// Takes the particles `order` in this order; `place` says where each of the old ones is then.
    fn gather(&mut self, order: &[u32], place: &[u32]) {
        fn apply<T: Copy>(values: &mut Vec<T>, order: &[u32]) {
            *values = order.iter().map(|&old| values[old as usize]).collect();
        }
        apply(&mut self.position, order);
        apply(&mut self.volume, order);
        apply(&mut self.weight, order);
        apply(&mut self.spacing, order);
        apply(&mut self.body, order);
        apply(&mut self.id, order);
        self.surface.renumber(|old| place[old as usize]);
    }

    /// Appends a particle like one of these (index), as part of a body. Its number continues where those here end.
    pub fn repeat(&mut self, index: usize, body: u32) {
        self.id.push(self.len() as u32);
        self.position.push(self.position[index]);
        self.volume.push(self.volume[index]);
        self.weight.push(self.weight[index]);
        self.spacing.push(self.spacing[index]);
        self.body.push(body);
    }

    /// Appends `count` particles like one of these (index), as part of a body, that wait to be born: until then their number
    /// is that of the other, so that no other number depends on how many wait.
    pub fn reserve(&mut self, index: usize, body: u32, count: usize) {
        let first = self.len();
        (0..count).for_each(|_| self.repeat(index, body));
        let own = self.id[index];
        self.id[first..].fill(own);
    }

    /// Appends the particles of another body as body `body`. Their ids continue where those here
    /// end, as if all had been created one after the other.
    ///
    /// # Errors
    /// [`GeometryError::NoParticles`] where the other body has none,
    /// [`GeometryError::TooManyParticles`] where ids would not fit into 32 bits.
    pub fn append(&mut self, other: Self, body: u32) -> Result<(), GeometryError> {
        if other.is_empty() {
            return Err(GeometryError::NoParticles);
        }
        let count = self.len() + other.len();
        if count > u32::MAX as usize {
            return Err(GeometryError::TooManyParticles { count });
        }
        let first = self.len() as u32;
        self.body.extend(vec![body; other.len()]);
        self.id.extend(other.id.iter().map(|id| first + id));
        self.position.extend(other.position);
        self.volume.extend(other.volume);
        self.weight.extend(other.weight);
        self.spacing.extend(other.spacing);
        self.surface.append(other.surface, body, first);
        Ok(())
    }
}
