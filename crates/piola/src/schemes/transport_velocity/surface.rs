//! Free surfaces: normals, the particles on them, and how far they are, CTVF section 3.4.

use super::TransportVelocity;
use crate::operators::{Needs, NeighborBlock};
use crate::{Vector, parallel};

/// Cosine of the half-angle of the cone around the outward normal in which a particle of the
/// surface has no neighbour: 60 degrees, in 2D and 3D.
const CONE: f64 = 0.5;

/// What is known of a particle's place at a free surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opening<const D: usize> {
    /// Unit vector away from the fluid where the particle has few neighbours, or zero.
    pub sharp: Vector<D>,
    /// Smoothed unit normal of CTVF (43), or zero far from surfaces.
    pub normal: Vector<D>,
    /// Whether the particle is on the surface.
    pub is_surface: bool,
    /// `h_b` of CTVF algorithm 1 in m: 0 on the surface, and near to it so small that the support
    /// ends there.
    pub reach: f64,
}

impl<const D: usize> Default for Opening<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        Self { sharp: zero, normal: zero, is_surface: false, reach: 0.0 }
    }
}

impl<const D: usize> Opening<D> {
    /// Takes from a displacement what leads into or out of a surface that is within the support `h`,
    /// theory (30) where particles on it are shifted, too.
    pub fn tangential(&self, displacement: Vector<D>, h: f64) -> Vector<D> {
        match self.reach < h {
            true => displacement - self.normal * displacement.dot(&self.normal),
            false => displacement,
        }
    }

    /// Takes from a displacement what leads into or out of a surface, CTVF (44), (45), theory (30).
    pub fn along_surface(&self, displacement: Vector<D>) -> Vector<D> {
        if self.is_surface {
            return Vector::zeros();
        }
        displacement - self.normal * displacement.dot(&self.normal)
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills the sums of CTVF (42), theory (29), where no pass over forces has done so.
    pub(super) fn opening_pass(&mut self) {
        let mut forces = std::mem::take(&mut self.forces);
        let (support, list, sides) = (&self.support, self.support.list(), &self.sides);
        parallel::for_each_chunk(&mut forces, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                if list.is_passive(place) {
                    continue;
                }
                let (mut sum, mut rest) = (Vector::zeros(), support.all(place));
                while support.fill(&mut rest, Needs::Slope, &mut block) {
                    for neighbor in block.iter().filter(|b| self.is_own(place, b.place)) {
                        let weight = sides[neighbor.place].volume * neighbor.slope;
                        sum -= neighbor.separation * weight;
                    }
                }
                row.opening = sum;
            }
        });
        self.forces = forces;
    }

    /// Finds free surfaces from the sums of CTVF (42) in `forces`.
    pub(super) fn find_surfaces(&mut self) {
        let mut openings = std::mem::take(&mut self.openings);
        let h = self.support.smoothing_length();
        let (forces, list) = (&self.forces, self.support.list());
        parallel::for_each_chunk(&mut openings, |first, rows| {
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *row = Opening { reach: h, ..Opening::default() };
                let sum = forces[place].opening;
                let is_open = sum.norm() >= 0.25 / h;
                if is_open && !list.is_passive(place) {
                    row.sharp = sum.normalize();
                }
            }
        });
        let sharp: &[Opening<D>] = &openings;
        let mut found = std::mem::take(&mut self.found);
        parallel::for_each_chunk(&mut found, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                if !list.is_passive(first + offset) {
                    *row = self.surface_at(first + offset, sharp, &mut block);
                }
            }
        });
        for (opening, (normal, is_surface)) in openings.iter_mut().zip(&found) {
            (opening.normal, opening.is_surface) = (*normal, *is_surface);
        }
        let mut reaches = std::mem::take(&mut self.densities);
        parallel::for_each_chunk(&mut reaches, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                if !list.is_passive(first + offset) {
                    *row = self.reach_at(first + offset, &found, &mut block);
                }
            }
        });
        for (opening, reach) in openings.iter_mut().zip(&reaches) {
            opening.reach = *reach;
        }
        (self.openings, self.found, self.densities) = (openings, found, reaches);
    }

    /// The smoothed normal, CTVF (43), and whether the particle is on a surface: it has no
    /// neighbour inside the cone, or it is alone (summed density below half of rho0).
    fn surface_at(
        &self,
        place: usize,
        openings: &[Opening<D>],
        block: &mut NeighborBlock<D>,
    ) -> (Vector<D>, bool) {
        let (support, me) = (&self.support, &self.sides[place]);
        let mut density = me.mass() * support.centre();
        let mut normal = openings[place].sharp * (me.volume * support.centre());
        let mut rest = support.all(place);
        while support.fill(&mut rest, Needs::Value, block) {
            for neighbor in block.iter().filter(|b| self.is_own(place, b.place)) {
                let other = &self.sides[neighbor.place];
                density += other.mass() * neighbor.value;
                normal += openings[neighbor.place].sharp * (other.volume * neighbor.value);
            }
        }
        let number = support.list().numbers()[place] as usize;
        let alone = density < 0.5 * self.reference_density(number);
        if normal.norm_squared() == 0.0 {
            return (normal, alone);
        }
        normal.normalize_mut();
        let mut covered = false;
        let mut rest = support.all(place);
        while !covered && support.fill(&mut rest, Needs::Nothing, block) {
            covered = block
                .iter()
                .filter(|neighbor| self.is_own(place, neighbor.place))
                .any(|neighbor| -neighbor.separation.dot(&normal) > CONE * neighbor.square.sqrt());
        }
        (normal, alone || !covered)
    }

    /// `h_b` of CTVF algorithm 1, with the kernel's own support for the paper's 3.
    fn reach_at(
        &self,
        place: usize,
        found: &[(Vector<D>, bool)],
        block: &mut NeighborBlock<D>,
    ) -> f64 {
        if found[place].1 {
            return 0.0;
        }
        let mut nearest = f64::INFINITY;
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, Needs::Nothing, block) {
            let near = block.iter().filter(|b| found[b.place].1 && self.is_own(place, b.place));
            for neighbor in near {
                nearest = nearest.min(neighbor.square);
            }
        }
        let factor = self.support.kernel().support_over_h();
        self.support.smoothing_length().min(nearest.sqrt() / factor)
    }
}
