//! What keeps fluid in front of walls, theory (80).

use piola_formulas::kernels::Needs;

use super::{Shifting, TransportVelocity};
use crate::operators::{Among, NeighborBlock, visit};
use crate::{Vector, parallel};

/// What of a spacing in front of a face a particle touches it.
pub(super) const TOUCH: f64 = 0.25;
/// How far beside a wall particle, in spacings, the one in front of it may be: half of the diagonal of
/// a face of particles in 3D is 0.71.
pub(super) const BESIDE: f64 = 0.75;
/// What of a spacing behind a face a particle counts as behind it: more than round-off.
const BEHIND: f64 = 0.01;

/// What walls do to a particle of the fluid that touches them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hold<const D: usize> {
    /// Its acceleration in m/s^2.
    acceleration: Vector<D>,
    /// What it takes from its deviation in m/s.
    deviation: Vector<D>,
    /// The place of the wall particle that bears it.
    wall: u32,
}

impl<const D: usize> Default for Hold<D> {
    fn default() -> Self {
        Self { acceleration: Vector::zeros(), deviation: Vector::zeros(), wall: u32::MAX }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Holds off particles of the fluid that touch a wall: closer than a quarter of a spacing to the face
    /// their acceleration into it vanishes, and their velocity into it decays in dx/c,
    ///
    /// `a <- a + n max(0, - a . n - (u_n + min(d . n, 0))/tau)`, `tau = dx/c`, theory (80),
    ///
    /// with u relative to the wall: what comes with up to a quarter of c comes to rest in front of the face.
    /// Deviations by (27) are cut, `d <- d - n min(d . n, 0)`. The wall gets what it does to the fluid.
    ///
    /// The pressure of a particle that has no neighbours but walls follows from nothing, so that
    /// a film of single particles is pulled in by its own tension.
    pub(super) fn hold_off(&mut self) {
        if self.holds.is_empty() {
            return;
        }
        let mut holds = std::mem::take(&mut self.holds);
        let list = self.support.list();
        parallel::for_each_chunk(&mut holds, |first, rows| {
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
            parallel::for_each_pair_of_chunks(&mut self.sides, &mut holds, |_, sides, holds| {
                for (side, hold) in sides.iter_mut().zip(holds) {
                    side.deviation -= hold.deviation;
                }
            });
        }
        self.holds = holds;
    }

    /// Adds what walls do to the fluid to the forces of both.
    pub(super) fn bear(&mut self) {
        let holds = &self.holds;
        let holds_any = |place: usize| f64::from(u8::from(holds[place].wall != u32::MAX));
        if parallel::maximum(holds.len(), 0.0, holds_any) == 0.0 {
            return;
        }
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
                    if holds[other].wall == place as u32 {
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
        hold
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
        let Some(index) = self.wall_of(self.support.list().numbers()[wall]) else { return };
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
        let rate = self.fluid.wave_speed / spacing;
        let push = -(load + hold.acceleration).dot(normal) - approach * rate;
        if push > 0.0 {
            hold.acceleration += normal * push;
            hold.wall = wall as u32;
        }
    }

    /// Which wall particle has a number.
    pub(super) fn wall_of(&self, number: u32) -> Option<usize> {
        self.walls.binary_search_by_key(&number, |wall| wall.number).ok()
    }

    /// Number of particles of the fluid that are behind a face of a wall in `state`; 0 for solids.
    pub(super) fn behind_count(&self, state: &[f64]) -> f64 {
        if self.holds.is_empty() {
            return 0.0;
        }
        let list = self.support.list();
        parallel::sum(list.numbers().len(), |place| {
            f64::from(u8::from(!list.is_passive(place) && self.is_behind(place, state)))
        })
    }

    /// How far a place is in front of the face of wall particle `index` in m, less than zero behind it, for the
    /// way from there, with the normal of the face; nothing beyond an edge.
    pub(super) fn over(&self, index: usize, way: &Vector<D>) -> Option<(f64, &Vector<D>)> {
        let (height, normal) = self.walls[index].faces.in_front(way)?;
        let aside = way.norm_squared() - way.dot(normal).powi(2);
        let is_beside = aside <= (BESIDE * self.particles.spacing[0]).powi(2);
        is_beside.then_some((height, normal))
    }

    /// Whether the particle at `place` is behind the face of the wall particle that is nearest.
    fn is_behind(&self, place: usize, state: &[f64]) -> bool {
        let list = self.support.list();
        let at = self.columns(state);
        let position = |place: usize| at.position[list.numbers()[place] as usize];
        let (me, mut nearest) = (position(place), None::<(f64, usize)>);
        // Candidates of the list are all that are near, at any state since it was made.
        for &other in list.passive_row(place) {
            let square = list.domain().separation(&me, &position(other as usize)).norm_squared();
            if nearest.is_none_or(|(least, _)| square < least) {
                nearest = Some((square, other as usize));
            }
        }
        nearest.is_some_and(|(_, wall)| {
            let way = list.domain().separation(&position(wall), &me);
            let over = self.wall_of(list.numbers()[wall]).and_then(|index| self.over(index, &way));
            over.is_some_and(|(height, _)| height < -BEHIND * self.particles.spacing[0])
        })
    }
}
