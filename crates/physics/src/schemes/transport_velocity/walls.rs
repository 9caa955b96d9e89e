//! Walls of ghost particles, CTVF (46) to (53), theory (31), (32), (72).

use nalgebra::SVector;
use piola_formulas::{Number, fluid};

use super::{AtRest, Common, Continuum, Slip};
use crate::geometry::Faces;
use crate::operators::NeighborBlock;
use crate::{Vector, parallel};

/// How far beside a wall particle, in spacings, the one in front of it may be: half of the diagonal of
/// a face of particles in 3D is 0.71.
pub(super) const BESIDE: f64 = 0.75;

/// Whether a way from the middle of a cell of a lattice, however that is turned, ends in the cell or next to it: within half of
/// its diagonal.
pub(super) fn is_in_cell<T: Number, const D: usize>(way: &SVector<T, D>, spacing: f64) -> T::Mask {
    let square = way.iter().fold(T::from(0.0), |sum, part| sum + *part * *part);
    square.at_most(T::from(0.25 * D as f64 * spacing * spacing))
}

/// A particle of a wall.
#[derive(Clone, Debug)]
pub(super) struct WallParticle<const D: usize> {
    pub number: u32,
    /// The faces towards the fluid that it is behind.
    pub faces: Faces<D>,
    pub slip: Slip,
}

/// What a wall particle takes from the fluid.
#[derive(Clone, Copy, Debug)]
pub struct WallValues<const D: usize> {
    /// Velocity with which the wall moves in m/s.
    pub motion: Vector<D>,
    /// Velocity with which its surface slides besides, in m/s.
    pub(super) sliding: Vector<D>,
    /// Acceleration of the wall in m/s^2.
    acceleration: Vector<D>,
    pub velocity: Vector<D>,
    pub deviation: Vector<D>,
    pub shear: Vector<D>,
    pressure: f64,
    /// Deviatoric stress of solids in Pa, as xx, yy, zz, yz, xz, xy.
    pub deviator: [f64; 6],
    /// The normal towards what is around, if that slides.
    pub mirror: Option<Vector<D>>,
}

impl<const D: usize> Default for WallValues<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        Self {
            motion: zero,
            sliding: zero,
            acceleration: zero,
            velocity: zero,
            deviation: zero,
            shear: zero,
            pressure: 0.0,
            deviator: [0.0; 6],
            mirror: None,
        }
    }
}

impl<const D: usize> Common<D> {
    /// Completes the sides of wall particles from those of the fluid around them.
    pub(super) fn wall_pass<M: Continuum<D>>(&mut self, matter: &mut M, time: f64) {
        if self.walls.is_empty() {
            return;
        }
        let mut values = std::mem::take(&mut self.wall_values);
        self.move_surfaces(time, &mut values);
        let own = self.own_walls();
        let walls = &self.walls[own.clone()];
        parallel::for_each_chunk(&mut values[own.clone()], |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                self.extrapolate(matter, &walls[first + offset], time, row, &mut block);
            }
        });
        for (wall, values) in walls.iter().zip(&values[own]) {
            let number = wall.number as usize;
            let place = self.place_of_wall(wall);
            let AtRest { density, wave_speed } = *self.at_rest(number);
            let pressure = values.pressure;
            let density = fluid::density(pressure, density, wave_speed);
            let mass = self.mass_at(number, density);
            let side = &mut self.sides[place];
            side.velocity = values.velocity;
            side.deviation = values.deviation;
            side.set(mass, density, pressure);
            matter.set_wall(place, values);
        }
        self.wall_values = values;
        self.show_sides();
        matter.show_walls(self);
    }

    /// Sets velocity and acceleration of the walls themselves.
    fn move_surfaces(&self, time: f64, values: &mut [WallValues<D>]) {
        values.fill(WallValues::default());
        for entry in self.motion.iter() {
            let wall = &mut values[entry.particle];
            wall.motion[entry.component] = entry.at(time);
            wall.acceleration[entry.component] = entry.rate(time);
        }
        for (index, wall) in values.iter_mut().enumerate() {
            wall.motion = self.guided.velocity(index).unwrap_or(wall.motion);
        }
        for entry in self.sliding.iter() {
            let wall = &mut values[entry.particle];
            wall.sliding[entry.component] = entry.at(time);
        }
    }

    /// Interpolates the fluid at a wall particle, CTVF (46), (47), (52), and reflects its velocities,
    /// CTVF (48) to (51). Without fluid around it moves with the wall and bears no pressure.
    fn extrapolate<M: Continuum<D>>(
        &self,
        matter: &M,
        wall: &WallParticle<D>,
        time: f64,
        values: &mut WallValues<D>,
        block: &mut NeighborBlock<D>,
    ) {
        let place = self.place_of_wall(wall);
        let around = matter.around(self, place, values, block);
        let surface = values.motion + values.sliding;
        if !(around.weight > 0.0) {
            values.velocity = values.motion;
            values.shear = surface;
            return;
        }
        values.deviator.iter_mut().for_each(|stress| *stress /= around.weight);
        let gravity = self.body_force_at(wall.number as usize, place, time);
        // An edge faces the fluid that is there: what hits one of its sides must not be turned along it.
        let normal = &wall.faces.towards(&-around.arm);
        let lift = gravity - values.acceleration;
        let ghost = around.ghost([&values.motion, &values.sliding], &lift, normal);
        (values.velocity, values.deviation) = (ghost.velocity, ghost.deviation);
        values.pressure = ghost.pressure;
        values.shear = match wall.slip {
            Slip::No => ghost.dragged,
            Slip::Free => ghost.velocity,
        };
        matter.reflect(wall.slip, normal, &ghost, values);
    }

    /// The place of a wall particle of this rank.
    fn place_of_wall(&self, wall: &WallParticle<D>) -> usize {
        self.support.list().places()[wall.number as usize - self.first()] as usize
    }

    /// Which wall particle has a number.
    pub(super) fn wall_of(&self, number: u32) -> Option<usize> {
        self.walls.binary_search_by_key(&number, |wall| wall.number).ok()
    }

    /// How far a place is in front of the face of wall particle `index` in m, less than zero behind it, for the
    /// way from there, with the normal of the face; nothing beyond an edge.
    pub(super) fn over(&self, index: usize, way: &Vector<D>) -> Option<(f64, &Vector<D>)> {
        let (height, normal) = self.walls[index].faces.in_front(way)?;
        let aside = way.norm_squared() - way.dot(normal).powi(2);
        let is_beside = aside <= (BESIDE * self.particles.spacing[0]).powi(2);
        is_beside.then_some((height, normal))
    }

    /// The same of a place inside of the wall, as far as it is not in front of it: what has gone over the end of a wall, and
    /// what is on its far side, does not count. The cells of walls that somebody else moves may be stretched, and are not asked for.
    pub(super) fn inside(&self, index: usize, way: &Vector<D>) -> Option<(f64, &Vector<D>)> {
        let is_inside =
            self.guided.velocity(index).is_some() || is_in_cell(way, self.particles.spacing[0]);
        self.over(index, way).filter(|_| is_inside)
    }
}
