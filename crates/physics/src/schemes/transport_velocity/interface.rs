//! Walls that somebody else moves: the surfaces of solids in the fluid.

use std::ops::Range;

use bytemuck::Pod;

use super::TransportVelocity;
use super::fluid::LEDGER;
use crate::geometry::Faces;
use crate::neighbors::{Domain, search};
use crate::schemes::SplitScheme;
use crate::{Tensor, Vector, parallel};

/// How a wall particle that somebody else moves does so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Guide<const D: usize> {
    /// Its velocity in m/s.
    pub velocity: Vector<D>,
    /// Its deformation gradient, which its faces follow; nothing where they have.
    pub deformation: Option<Tensor<D>>,
}

/// A wall particle that somebody else moves.
#[derive(Clone, Debug)]
struct Guidance<const D: usize> {
    /// Its number among these.
    number: usize,
    velocity: Vector<D>,
    /// Its faces at the start.
    rest: Faces<D>,
}

/// The wall particles that somebody else moves.
#[derive(Clone, Debug)]
pub(super) struct Guided<const D: usize> {
    /// By index among walls; nothing for other walls.
    walls: Vec<Option<Guidance<D>>>,
    /// By number: whether the wall particle is seen on the side of its face alone.
    is_sided: Vec<bool>,
}

impl<const D: usize> Guided<D> {
    /// Whether a particle (number) is a wall particle that is seen on the side of its face alone.
    pub fn is_sided(&self, number: u32) -> bool {
        self.is_sided.get(number as usize).is_some_and(|is_sided| *is_sided)
    }

    /// Velocity of a wall by its index, if somebody else moves it.
    pub fn velocity(&self, index: usize) -> Option<Vector<D>> {
        self.walls.get(index)?.as_ref().map(|guided| guided.velocity)
    }
}

impl<const D: usize> Default for Guided<D> {
    fn default() -> Self {
        Self { walls: Vec::new(), is_sided: Vec::new() }
    }
}

/// Wall particles by number, in an order that somebody else has.
#[derive(Clone, Debug, Default)]
pub(crate) struct WallSelection {
    numbers: Vec<u32>,
    /// Their indices in the order of numbers, of which each rank has a range.
    order: Vec<u32>,
}

impl WallSelection {
    /// Those of these numbers.
    pub fn new(numbers: Vec<u32>) -> Self {
        let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
        order.sort_unstable_by_key(|&index| numbers[index as usize]);
        Self { numbers, order }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Indices of those with numbers of a range.
    pub fn within(&self, range: &Range<usize>) -> &[u32] {
        let number = |index: u32| self.numbers[index as usize] as usize;
        let place = |bound: usize| self.order.partition_point(|&index| number(index) < bound);
        &self.order[place(range.start)..place(range.end)]
    }

    /// Bytes that it holds.
    pub fn memory(&self) -> usize {
        size_of_val(self.numbers.as_slice()) + size_of_val(self.order.as_slice())
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// The numbers of its particles: all, or those of this rank.
    pub(crate) fn own(&self) -> Range<usize> {
        self.common.first()..self.common.first() + self.common.count()
    }

    /// What wall particles have, whichever rank they are of: `of` takes the row of one in a state of this rank, and its
    /// number.
    fn of_walls<T: Pod>(
        &self,
        walls: &WallSelection,
        of: impl Fn(usize, usize) -> T,
        found: &mut Vec<T>,
    ) {
        let (team, own) = (self.common.team(), self.own());
        let of = |number: u32| of(number as usize - own.start, number as usize);
        if team.is_alone() {
            found.clear();
            found.extend(walls.numbers.iter().map(|&number| of(number)));
            return;
        }
        let mine = walls.within(&own).iter().map(|&index| of(walls.numbers[index as usize]));
        found.resize(walls.len(), T::zeroed());
        for (&index, value) in walls.order.iter().zip(team.rows_of_all(mine.collect())) {
            found[index as usize] = value;
        }
    }

    /// The particles of walls that are of some bodies: numbers, bodies and reference positions in m.
    pub(crate) fn walls_of(&self, bodies: &[u32]) -> Vec<(u32, u32, Vector<D>)> {
        let particles = &self.common.particles;
        let walls = self.common.walls.iter().map(|wall| wall.number as usize);
        let own = walls.filter(|&a| bodies.contains(&particles.body[a]));
        own.map(|a| (a as u32, particles.body[a], particles.position[a])).collect()
    }

    /// The first particle (number) that is no such wall and closer to one of these where the bodies begin than
    /// two lattices side by side are: less than 0.72 spacings, at which one lattice is in the middle of the cells of
    /// another in the plane.
    pub(crate) fn too_close_to(&self, walls: &[(u32, u32, Vector<D>)]) -> Option<usize> {
        let position = &self.common.particles.position;
        let reach = vec![0.72 * self.spacing(); position.len()];
        let near = search(position, &reach, self.domain()).ok()?;
        let mut is_own = vec![false; position.len()];
        walls.iter().for_each(|(number, ..)| is_own[*number as usize] = true);
        let is_near = |a: &usize| near.row(*a).iter().any(|&b| is_own[b as usize]);
        (0..position.len()).find(|a| !is_own[*a] && is_near(a))
    }

    /// The particles (numbers) of walls that nothing else moves.
    pub(crate) fn own_walls(&self) -> impl Iterator<Item = u32> {
        let walls = self.common.walls.iter().enumerate();
        let own = walls.filter(|(index, _)| self.common.guided.velocity(*index).is_none());
        own.map(|(_, wall)| wall.number)
    }

    /// The faces of a wall particle (number) as they are now.
    pub(crate) fn faces_of(&self, number: u32) -> Option<&Faces<D>> {
        self.common.faces(number as usize)
    }

    /// Whether walls move that nothing else moves.
    pub(crate) fn moves_walls(&self) -> bool {
        !self.common.motion.is_empty()
    }

    /// Finds places and velocities of walls that nothing else moves in a state. On several ranks, what has been `found` of
    /// walls that stand is kept.
    pub(crate) fn places_of(
        &self,
        state: &[f64],
        walls: &WallSelection,
        found: &mut Vec<[Vector<D>; 2]>,
    ) {
        // Other ranks need not be asked again for those that stand, nor for none.
        let is_known = walls.len() == 0 || !self.moves_walls() && found.len() == walls.len();
        if is_known && !self.common.team().is_alone() {
            return;
        }
        let at = self.common.columns(state);
        self.of_walls(walls, |row, _| [at.position[row], at.velocity[row]], found);
    }

    /// The velocity at a time in s of the surface of a wall particle (index in a selection) that moves with a velocity.
    pub(crate) fn surface_velocity(
        &self,
        time: f64,
        (walls, index): (&WallSelection, usize),
        mut velocity: Vector<D>,
    ) -> Vector<D> {
        if let Some(index) = self.common.wall_of(walls.numbers[index]) {
            for entry in self.common.sliding.of(index) {
                velocity[entry.component] += entry.at(time);
            }
        }
        velocity
    }

    /// Wave speed of the fluid in m/s.
    pub(crate) fn wave_speed(&self) -> f64 {
        self.matter.fluid().wave_speed
    }

    /// Density of the fluid where nothing presses, in kg/m^3.
    pub(crate) fn density(&self) -> f64 {
        self.matter.fluid().density
    }

    /// Particle spacing in m.
    pub(crate) fn spacing(&self) -> f64 {
        self.common.particles.spacing[0]
    }

    /// The box that it is in.
    pub(crate) fn domain(&self) -> &Domain<D> {
        self.common.support.list().domain()
    }

    /// Lets somebody else move wall particles, by number. Where two of them are in one place each stands
    /// for one side of a thin body: fluid on its other side does not see it.
    pub(crate) fn let_walls_be_guided(&mut self, numbers: &[u32]) {
        let common = &mut self.common;
        let place = |number: &u32| common.particles.position[*number as usize].map(f64::to_bits);
        let mut placed: Vec<_> = numbers.iter().map(|it| (place(it).data.0, *it)).collect();
        placed.sort_unstable();
        common.guided.is_sided = vec![false; common.particles.len()];
        for pair in placed.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            pair.iter().for_each(|(_, number)| common.guided.is_sided[*number as usize] = true);
        }
        common.guided.walls = vec![None; common.walls.len()];
        for (number, &wall) in numbers.iter().enumerate() {
            let Some(index) = common.wall_of(wall) else { continue };
            let rest = common.walls[index].faces.clone();
            common.guided.walls[index] = Some(Guidance { number, velocity: Vector::zeros(), rest });
        }
    }

    /// Says how the guided wall particles move at the moment, by their number among those.
    pub(crate) fn guide(&mut self, how: impl Fn(usize) -> Guide<D> + Sync) {
        let common = &mut self.common;
        let (walls, guided) = (&mut common.walls, &mut common.guided.walls);
        parallel::for_each_pair_of_chunks(guided, walls, |_, guided, walls| {
            for (guided, wall) in guided.iter_mut().zip(walls) {
                if let Some(Guidance { number, velocity, rest }) = guided {
                    let guide = how(*number);
                    *velocity = guide.velocity;
                    if let Some(deformation) = &guide.deformation {
                        wall.faces.follow(rest, deformation);
                    }
                }
            }
        });
        for (_, wall) in common.guided.walls.iter().zip(&common.walls).filter(|it| it.0.is_some()) {
            if common.guided.is_sided(wall.number)
                && let Some(side) = wall.faces.normals().first()
            {
                common.support.show_on(wall.number, *side);
            }
        }
    }

    /// Puts a wall particle (number) somewhere in a state, if it is one of this rank.
    pub(crate) fn place_wall(
        &self,
        state: &mut [f64],
        number: u32,
        place: &Vector<D>,
        velocity: &Vector<D>,
    ) {
        let Some(row) = self.common.row(number as usize) else { return };
        let (own, _) = self.common.parts(state);
        own.position[row] = self.domain().wrap(place);
        own.velocity[row] = *velocity;
    }

    /// Finds the forces of the fluid on walls in N, as a state has them.
    pub(crate) fn forces_on(
        &self,
        state: &[f64],
        walls: &WallSelection,
        found: &mut Vec<Vector<D>>,
    ) {
        let at = self.common.columns(state);
        let mass = |row: usize, number| self.common.mass_at(number, at.density[row]);
        self.of_walls(walls, |row, number| at.kick[row] * mass(row, number), found);
    }

    /// Finds the accelerations of the start anew, with walls as they have been placed and guided since.
    pub(crate) fn restart(&mut self, state: &mut [f64]) {
        self.common.parts(state).0.deviation.fill(Vector::zeros());
        self.accelerate(0.0, state);
        LEDGER.clear(D, self.tail(state));
    }
}
