//! Free surfaces: normals, the particles on them, and how far they are, CTVF section 3.4.

use piola_formulas::kernels::Needs;
use piola_formulas::pairs::sums;

use super::Common;
use crate::geometry::ball_volume;
use crate::operators::{Among, NeighborBlock, OfOther, Term, add_at, visit};
use crate::{Vector, parallel};

/// Cosine of the half-angle of the cone around the outward normal in which a particle of the
/// surface has no neighbour: 60 degrees, in 2D and 3D.
pub(super) const CONE: f64 = 0.5;

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

impl<const D: usize> Common<D> {
    /// Fills the sums of CTVF (42), theory (29), where no pass over forces has done so.
    pub(super) fn opening_pass(&mut self) {
        let mut forces = std::mem::take(&mut self.forces);
        let (support, list) = (&self.support, self.support.list());
        let source = (self.sides.as_slice(), &self.continua);
        let sum = Term { law: sums::Opening::<D>, source, among: Among::All };
        parallel::for_each_chunk(&mut forces, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                if !list.is_passive(place) {
                    row.opening = Vector::zeros();
                    add_at(support, &sum, place, &mut block, &mut row.opening);
                }
            }
        });
        self.forces = forces;
    }

    /// Finds free surfaces from the sums of CTVF (42) in `forces`.
    ///
    /// Most particles are far from them. Their neighbours are looked through for marks only: first for
    /// those of a sharp normal, then for those of a surface.
    pub(super) fn find_surfaces(&mut self) {
        self.sharpen();
        self.mark_surfaces();
        self.reach_surfaces();
    }

    /// Fills the sharp normals and marks who has one.
    pub(super) fn sharpen(&mut self) {
        let h = self.support.smoothing_length();
        let (forces, list) = (&self.forces, self.support.list());
        let owned = list.owned();
        let (openings, marks) = (&mut self.openings[..owned], &mut self.marks[..owned]);
        parallel::for_each_pair_of_chunks(openings, marks, |first, rows, marks| {
            for (offset, (row, mark)) in rows.iter_mut().zip(marks).enumerate() {
                let place = first + offset;
                *row = Opening { reach: h, ..Opening::default() };
                let sum = forces[place].opening;
                *mark = sum.norm() >= 0.25 / h && !list.is_passive(place);
                if *mark {
                    row.sharp = sum.normalize();
                }
            }
        });
        self.show_openings();
    }

    /// Shows the sharp normals and the marks to the ranks that have copies.
    fn show_openings(&mut self) {
        let (team, owned) = (self.support.list().team(), self.support.list().owned());
        let (own, copies) = self.openings.split_at_mut(owned);
        let (own_marks, marks) = self.marks.split_at_mut(owned);
        let show = |place: usize, numbers: &mut Vec<f64>| {
            numbers.extend_from_slice(own[place].sharp.as_slice());
            numbers.push(f64::from(u8::from(own_marks[place])));
        };
        team.refresh_numbers(D + 1, show, |copy, numbers| {
            copies[copy].sharp.copy_from_slice(&numbers[..D]);
            marks[copy] = numbers[D] > 0.0;
        });
    }

    /// Fills the smoothed normals and marks who is on a surface.
    pub(super) fn mark_surfaces(&mut self) {
        let mut found = std::mem::take(&mut self.found);
        let even_count = self.even_count();
        let list = self.support.list();
        let (sharp, sharp_marks): (&[Opening<D>], &[bool]) = (&self.openings, &self.marks);
        parallel::for_each_chunk(&mut found, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *row = (Vector::zeros(), false);
                if !list.is_passive(place) {
                    let marked = sharp_marks[place] || self.sees_mark(place, sharp_marks);
                    if marked || self.has_few_neighbors(place, even_count) {
                        *row = self.surface_at(place, sharp, &mut block);
                    }
                }
            }
        });
        let owned = list.owned();
        let (openings, marks) = (&mut self.openings[..owned], &mut self.marks[..owned]);
        parallel::for_each_pair_of_chunks(marks, openings, |first, marks, rows| {
            for (offset, (mark, row)) in marks.iter_mut().zip(rows).enumerate() {
                (row.normal, row.is_surface) = found[first + offset];
                *mark = row.is_surface;
            }
        });
        self.found = found;
        self.show_openings();
    }

    /// Fills how far surfaces are.
    pub(super) fn reach_surfaces(&mut self) {
        let mut openings = std::mem::take(&mut self.openings);
        let (list, surfaces) = (self.support.list(), self.marks.as_slice());
        parallel::for_each_chunk(&mut openings[..list.owned()], |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                if surfaces[place] {
                    row.reach = 0.0;
                } else if !list.is_passive(place) && self.sees_mark(place, surfaces) {
                    row.reach = self.reach_at(place, surfaces, &mut block);
                }
            }
        });
        self.openings = openings;
    }

    /// Whether a neighbour of the same continuum is marked.
    #[inline]
    fn sees_mark(&self, place: usize, marks: &[bool]) -> bool {
        let is_marked = |other: &u32| marks[*other as usize];
        let is_own = |other: &u32| self.continua.is_own(place, *other as usize);
        self.support
            .places_of(place)
            .iter()
            .any(|places| places.iter().any(|other| is_marked(other) && is_own(other)))
    }

    /// Neighbours of a particle among others that are evenly spread: the volume of the support over
    /// that of a particle.
    pub(super) fn even_count(&self) -> usize {
        let support = self.support.kernel().support_radius(self.support.smoothing_length());
        ball_volume(D, support / self.particles.spacing[0]) as usize
    }

    /// Whether a particle has less than half of the neighbours of its continuum that an even spread
    /// gives it. One that has more is not alone.
    fn has_few_neighbors(&self, place: usize, even_count: usize) -> bool {
        let others = self.support.places_of(place);
        let count: usize = match self.continua.are_several() {
            true => {
                let is_own = |other: &&u32| self.continua.is_own(place, **other as usize);
                others.iter().map(|places| places.iter().filter(is_own).count()).sum()
            }
            false => others.iter().map(|places| places.len()).sum(),
        };
        2 * count < even_count
    }

    /// The smoothed normal, CTVF (43), and whether the particle is on a surface: it has no
    /// neighbour inside the cone, or it is alone (summed density below half of rho0).
    fn surface_at(
        &self,
        place: usize,
        openings: &[Opening<D>],
        block: &mut NeighborBlock<D>,
    ) -> (Vector<D>, bool) {
        let (support, me, centre) = (&self.support, &self.sides[place], self.support.centre());
        let sharp = OfOther(|other: usize| openings[other].sharp);
        let source = ((self.sides.as_slice(), &self.continua), sharp);
        let sum = Term { law: sums::SurfaceNormal::<D>, source, among: Among::All };
        let own = openings[place].sharp * (me.volume * centre);
        let mut found = (me.mass() * centre, own);
        add_at(support, &sum, place, block, &mut found);
        let (density, mut normal) = found;
        let number = support.list().numbers()[place] as usize;
        let alone = density < 0.5 * self.at_rest(number).density;
        if normal.norm_squared() == 0.0 {
            return (normal, alone);
        }
        normal.normalize_mut();
        let mut covered = false;
        visit(support, place, Among::All, Needs::Nothing, block, |other, pair| {
            let is_in_cone = -pair.separation.dot(&normal) > CONE * pair.square.sqrt();
            covered |= is_in_cone && self.continua.is_own(place, other);
        });
        (normal, alone || !covered)
    }

    /// `h_b` of CTVF algorithm 1, with the kernel's own support for the paper's 3.
    fn reach_at(&self, place: usize, surfaces: &[bool], block: &mut NeighborBlock<D>) -> f64 {
        let mut nearest = f64::INFINITY;
        visit(&self.support, place, Among::Active, Needs::Nothing, block, |other, pair| {
            if surfaces[other] && self.continua.is_own(place, other) {
                nearest = nearest.min(pair.square);
            }
        });
        let factor = self.support.kernel().support_over_h();
        self.support.smoothing_length().min(nearest.sqrt() / factor)
    }
}
