//! What keeps particles in front of walls, theory (80).

use piola_formulas::kernels::Needs;

use super::extent::Extent;
use super::{Common, Shifting};
use crate::operators::{Among, NeighborBlock, visit};
use crate::{Vector, parallel};

/// What of a spacing in front of a face a particle touches it.
pub(super) const TOUCH: f64 = 0.25;
/// What of a spacing behind a face a particle counts as behind it: more than round-off.
const BEHIND: f64 = 0.01;

/// What walls do to a particle that touches them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hold<const D: usize> {
    /// Its acceleration in m/s^2.
    acceleration: Vector<D>,
    /// What it takes from its deviation in m/s.
    deviation: Vector<D>,
    /// The number of the wall particle that bears it.
    wall: u32,
}

impl<const D: usize> Default for Hold<D> {
    fn default() -> Self {
        Self { acceleration: Vector::zeros(), deviation: Vector::zeros(), wall: u32::MAX }
    }
}

impl<const D: usize> Common<D> {
    /// Holds off particles that touch a wall: closer than a quarter of a spacing to the face
    /// their acceleration into it vanishes, and their velocity into it decays in dx/c,
    ///
    /// `a <- a + n max(0, - a . n - (u_n + min(d . n, 0))/tau)`, `tau = dx/c`, theory (80),
    ///
    /// with u relative to the wall: what comes with up to a quarter of c comes to rest in front of the face.
    /// Deviations by (27) are cut, `d <- d - n min(d . n, 0)`. The wall gets what it does to them.
    ///
    /// The pressure of a particle that has no neighbours but walls follows from nothing, so that
    /// a film of single particles is pulled in by its own tension. The rates of a particle of a solid hardly depend on
    /// its own velocity: nothing else stops one that moves into the wall ahead of its neighbours.
    pub(super) fn hold_off(&mut self) {
        let mut holds = std::mem::take(&mut self.holds);
        let list = self.support.list();
        let owned = list.owned();
        parallel::for_each_chunk(&mut holds[..owned], |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *row = match list.is_passive(place) {
                    true => Hold::default(),
                    false => self.hold_at(place, &mut block),
                };
            }
        });
        if let Shifting::Sun { .. } = self.settings.shifting {
            let (sides, holds) = (&mut self.sides[..owned], &mut holds[..owned]);
            parallel::for_each_pair_of_chunks(sides, holds, |_, sides, holds| {
                for (side, hold) in sides.iter_mut().zip(holds) {
                    side.deviation -= hold.deviation;
                }
            });
        }
        self.holds = holds;
    }

    /// Adds what walls do to what touches them to the forces of both.
    pub(super) fn bear(&mut self) {
        let (holds, team) = (&self.holds, self.team());
        let holds_any = |place: usize| f64::from(u8::from(holds[place].wall != u32::MAX));
        if team.largest([parallel::maximum(self.count(), 0.0, holds_any)]) == [0.0] {
            return;
        }
        self.show_holds();
        let mut forces = std::mem::take(&mut self.forces);
        let (list, sides, holds) = (self.support.list(), &self.sides, &self.holds);
        parallel::for_each_chunk(&mut forces, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                if !list.is_passive(place) {
                    row.walls += holds[place].acceleration;
                    continue;
                }
                let add = |other: usize, _: &_| {
                    if holds[other].wall == list.numbers()[place] {
                        let ratio = sides[other].mass() / sides[place].mass();
                        row.walls -= holds[other].acceleration * ratio;
                    }
                };
                let (pairs, needs) = (&self.support, Needs::Nothing);
                visit(pairs, place, Among::Active, needs, &mut block, add);
            }
        });
        self.forces = forces;
    }

    /// Shows what walls do to own particles to the ranks that have copies of them.
    fn show_holds(&mut self) {
        let (team, owned) = (self.support.list().team(), self.support.list().owned());
        let (own, copies) = self.holds.split_at_mut(owned);
        let show = |place: usize, numbers: &mut Vec<f64>| {
            numbers.extend_from_slice(own[place].acceleration.as_slice());
            numbers.push(f64::from(own[place].wall));
        };
        team.refresh_numbers(D + 1, show, |copy, numbers| {
            copies[copy].acceleration.copy_from_slice(&numbers[..D]);
            copies[copy].wall = numbers[D] as u32;
        });
    }

    /// What walls do to the particle at `place`. In a corner several faces do.
    fn hold_at(&self, place: usize, block: &mut NeighborBlock<D>) -> Hold<D> {
        let mut hold = Hold::default();
        let [_, walls] = self.support.places_of(place);
        if walls.is_empty() {
            return hold;
        }
        let load = self.forces[place].total();
        let (pairs, needs) = (&self.support, Needs::Nothing);
        visit(pairs, place, Among::Passive, needs, block, |wall, pair| {
            self.hold_by(wall, &pair.separation, place, &load, &mut hold);
        });
        // What follows another level is not shifted into walls, but its forces are that level's.
        match self.is_wall[self.support.list().numbers()[place] as usize] {
            true => Hold { deviation: hold.deviation, ..Hold::default() },
            false => hold,
        }
    }

    /// Adds what the wall particle at `wall` does to the particle at `place`, which stands at a
    /// `separation` from it under a `load` of m/s^2.
    fn hold_by(
        &self,
        wall: usize,
        separation: &Vector<D>,
        place: usize,
        load: &Vector<D>,
        hold: &mut Hold<D>,
    ) {
        let (side, spacing) = (&self.sides[place], self.particles.spacing[0]);
        let numbers = self.support.list().numbers();
        let Some(index) = self.wall_of(numbers[wall]) else { return };
        let Some((height, normal)) = self.over(index, separation) else { return };
        if !(-spacing..TOUCH * spacing).contains(&height) {
            return;
        }
        let motion = &self.wall_values[index].motion;
        let shift = (side.deviation - hold.deviation).dot(normal).min(0.0);
        let mut approach = (side.velocity - motion).dot(normal);
        match self.settings.shifting {
            Shifting::Sun { .. } => hold.deviation += normal * shift,
            _ => approach += shift,
        }
        let rate = self.at_rest(numbers[place] as usize).wave_speed / spacing;
        let push = -(load + hold.acceleration).dot(normal) - approach * rate;
        if push > 0.0 {
            hold.acceleration += normal * push;
            hold.wall = numbers[wall];
        }
    }

    /// Number of particles that are behind a face of a wall in `state`.
    pub(super) fn behind_count(&self, state: &[f64]) -> f64 {
        if self.holds.is_empty() {
            return 0.0;
        }
        let (list, Some(walls)) = (self.support.list(), self.extent_of_walls(state)) else {
            return 0.0;
        };
        parallel::sum(list.numbers().len(), |place| {
            let counts = !self.is_wall[list.numbers()[place] as usize];
            f64::from(u8::from(counts && self.is_behind(place, state, &walls)))
        })
    }

    /// Whether the particle at `place` is behind the face of the wall particle that is nearest, in the box around walls.
    fn is_behind(&self, place: usize, state: &[f64], walls: &Extent<D>) -> bool {
        let list = self.support.list();
        let at = self.columns(state);
        let position = |place: usize| at.position[list.numbers()[place] as usize];
        // Candidates of the list are all that are near, at any state since it was made.
        self.wall_behind(place, f64::INFINITY, position).is_some_and(|(number, way)| {
            let inside = self.wall_of(number).and_then(|index| self.inside(index, &way));
            inside.is_some_and(|(height, _)| height < -BEHIND * self.particles.spacing[0])
                && walls.contains(&position(place), list.domain())
        })
    }
}
