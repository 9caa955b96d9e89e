//! Particles that leave the others: through a wall, or out of the box around everything.

use super::extent::Extent;
use super::walls::WallParticle;
use super::{ColumnsMut, Common};
use crate::Vector;
use crate::parallel;
use crate::schemes::ledger::Total;
use crate::schemes::momentum::add_moments;
use crate::schemes::{Behind, Escape};

/// What a run does about particles that escape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guard {
    /// Names of the bodies by their numbers.
    pub bodies: Vec<String>,
    /// Whether such particles are removed; otherwise they are a fault of the state.
    pub removes: bool,
}

/// What of a spacing a particle may be behind the first layer of a wall. The layer may stand on
/// the wall's face, which the fluid touches up to round-off.
pub(super) const TOLERANCE: f64 = 0.1;

/// Two planes less than this part of a spacing apart are one.
const SAME_PLANE: f64 = 0.25;

/// The density that says that its particle has been removed.
const REMOVED: f64 = 0.0;

/// What to change where particles escape.
const ADVICE: &str = "if a few lost drops do not matter, `scheme.escaped = \"remove\"` takes them \
    out and counts them; otherwise make the wall thicker than the support of the kernel and without \
    holes, raise the wave speed of the fluid, or lower `time.cfl`";

/// What to change where particles come over the end of a wall.
const END_ADVICE: &str = "if a few lost drops do not matter, `scheme.escaped = \"remove\"` takes them \
    out and counts them; otherwise make the wall longer, so that nothing flies over its end, or close what it \
    encloses";

/// Where particles may be.
pub(super) struct Room<const D: usize> {
    /// Inside of this.
    pub bounds: Extent<D>,
    /// Beyond this is no wall.
    pub walls: Extent<D>,
}

impl<const D: usize> Room<D> {
    /// That up to so many m from walls in a box.
    pub fn around(walls: Extent<D>, margin: f64) -> Self {
        Self { bounds: walls.widened(margin), walls }
    }
}

/// Where a particle has escaped to.
enum Place<const D: usize> {
    /// Out of the bounds.
    Outside,
    /// Into a wall, at the wall particle of this number.
    Wall {
        number: u32,
        /// How far it is in front of the face of that in m, less than zero, and the normal.
        height: f64,
        normal: Vector<D>,
    },
}

impl<const D: usize> Common<D> {
    /// See [`TransportVelocity::guard`](super::TransportVelocity::guard).
    pub(super) fn guard(&mut self, guard: Guard) {
        let all = Extent::around(self.particles.position.iter().copied());
        let Some(all) = all.filter(|_| !self.walls.is_empty()) else { return };
        if guard.removes && self.removed.is_empty() {
            self.removed = vec![false; self.particles.len()];
        }
        self.guard = Some((guard, all.length()));
    }

    /// Whether a density is that of a particle that has been removed.
    pub(super) fn is_removed(density: f64) -> bool {
        density == REMOVED
    }

    /// Takes particles out of the interaction, or back into it, as `state` has them.
    pub(super) fn follow_removals(&mut self, state: &[f64]) {
        let (begin, density) = (self.first(), self.columns(state).density);
        let removed = &self.removed[begin..];
        let differs = |row: usize| Self::is_removed(density[row]) != removed[row];
        let own = parallel::maximum(density.len(), 0.0, |row| f64::from(differs(row)));
        if self.team().largest([own]) == [0.0] {
            return;
        }
        let own = (0..density.len()).filter(|row| differs(*row)).map(|row| (begin + row) as u64);
        for number in self.team().rows_of_all(own.collect()) {
            let is_removed = &mut self.removed[number as usize];
            *is_removed = !*is_removed;
            self.is_wall[number as usize] = *is_removed;
        }
        self.support.exclude(&self.is_wall, &self.removed);
    }

    /// The particles of this rank that have escaped in `state`, which has been loaded, by number.
    pub(super) fn escaped(&self, state: &[f64]) -> Vec<usize> {
        let Some(room) = self.room(state).filter(|_| self.lost.is_none()) else {
            return Vec::new();
        };
        let any = parallel::maximum(self.count(), 0.0, |place| {
            f64::from(self.escape_at(place, &room).is_some())
        });
        if any == 0.0 {
            return Vec::new();
        }
        let places = self.support.list().places().iter().enumerate();
        let escaped = places.filter(|(_, place)| self.escape_at(**place as usize, &room).is_some());
        escaped.map(|(row, _)| self.first() + row).collect()
    }

    /// What is known of a particle that has escaped in `state`, which has been loaded.
    pub(super) fn escape_of(&self, number: usize, state: &[f64]) -> Option<Escape> {
        let (guard, room) = (&self.guard.as_ref()?.0, self.room(state)?);
        let (list, at) = (self.support.list(), self.columns(state));
        let (position, velocity) = (&at.position[number], &at.velocity[number]);
        let (behind, advice) = match self.escape_at(list.places()[number] as usize, &room)? {
            Place::Outside => (Behind::Box, ADVICE),
            Place::Wall { number, height, normal } => {
                let body = self.particles.body[number as usize] as usize;
                let name = guard.bodies.get(body).cloned().unwrap_or_default();
                // What moves into the wall has come through that of its planes which it has passed last. The face
                // of a flat wall may be on the box around all walls: both have been passed at once.
                let (inwards, all) = (-velocity.dot(&normal), list.domain());
                let same = SAME_PLANE * self.particles.spacing[0];
                let since = room.walls.since(position, velocity, all);
                let is_later = since * inwards < -height - same;
                match inwards > 0.0 && is_later {
                    true => (Behind::End(name), END_ADVICE),
                    false => (Behind::Wall(name), ADVICE),
                }
            }
        };
        let (position, speed) = (position.iter().copied().collect(), velocity.norm());
        Some(Escape { position, speed, behind, advice })
    }

    /// Where particles may be in `state`, if anybody asks.
    pub(super) fn room(&self, state: &[f64]) -> Option<Room<D>> {
        Some(Room::around(self.extent_of_walls(state)?, self.margin()?))
    }

    /// How far from the box around the cells of walls particles may be in m, if anybody asks.
    pub(super) fn margin(&self) -> Option<f64> {
        let (_, reach) = self.guard.as_ref()?;
        Some(reach - 0.5 * self.particles.spacing[0])
    }

    /// The box around the cells of all particles of walls in `state`.
    pub(super) fn extent_of_walls(&self, state: &[f64]) -> Option<Extent<D>> {
        let at = self.columns(state);
        let row = |wall: &WallParticle<D>| wall.number as usize - self.first();
        let places = self.walls[self.own_walls()].iter().map(|wall| at.position[row(wall)]);
        let own = Extent::around(places)
            .map_or([[f64::NEG_INFINITY; D]; 2], |own| [(-own.low).into(), own.high.into()]);
        let [low, high] = own.map(|ends| Vector::from(self.team().largest(ends)));
        let all = Extent { low: -low, high };
        (!self.walls.is_empty()).then(|| all.widened(0.5 * self.particles.spacing[0]))
    }

    /// Where the particle at `place` has escaped to, if it has.
    fn escape_at(&self, place: usize, room: &Room<D>) -> Option<Place<D>> {
        let list = self.support.list();
        // Of those that follow another level that one sees whether they are where they must not be.
        if list.is_passive(place) || self.is_wall[list.numbers()[place] as usize] {
            return None;
        }
        let position = &list.positions()[place];
        if !room.bounds.contains(position, list.domain()) {
            return Some(Place::Outside);
        }
        let depth = -TOLERANCE * self.particles.spacing[0];
        let reach = self.support.kernel().support_radius(self.support.smoothing_length());
        let (number, way) = self.wall_behind(place, reach, |place| list.positions()[place])?;
        let (height, normal) = self.inside(self.wall_of(number)?, &way)?;
        let is_in = way.dot(normal) < depth && room.walls.contains(position, list.domain());
        is_in.then_some(Place::Wall { number, height, normal: *normal })
    }

    /// The number of the wall particle that is nearest to the one at `place`, with the way from there; nothing
    /// without one within `reach` m. Of those in one place, which stand for the sides of a thin body, that whose
    /// face the particle is furthest in front of.
    pub(super) fn wall_behind(
        &self,
        place: usize,
        reach: f64,
        position: impl Fn(usize) -> Vector<D>,
    ) -> Option<(u32, Vector<D>)> {
        let list = self.support.list();
        let (me, mut nearest) = (position(place), None::<(f64, f64, u32, Vector<D>)>);
        for &other in list.passive_row(place) {
            let way = list.domain().separation(&position(other as usize), &me);
            let (square, number) = (way.norm_squared(), list.numbers()[other as usize]);
            let height = || {
                let index = self.wall_of(number);
                let found = index.and_then(|index| self.walls[index].faces.in_front(&way));
                found.map_or(f64::NEG_INFINITY, |(height, _)| height)
            };
            let is_nearer = nearest.is_none_or(|(least, highest, ..)| {
                square < least
                    || square == least && self.guided.is_sided(number) && height() > highest
            });
            if is_nearer && square < reach * reach {
                nearest = Some((square, height(), number, way));
            }
        }
        nearest.map(|(_, _, number, way)| (number, way))
    }

    /// Removes what has escaped in `state`, if that is what is to be done: such particles rest where
    /// they were found and nothing feels them. Their energy and momentum leave by ways of their own.
    pub(super) fn remove_escaped(&mut self, state: &mut [f64]) -> Total {
        if !self.guard.as_ref().is_some_and(|(guard, _)| guard.removes) {
            return Total::default();
        }
        self.find_neighbors(state);
        let escaped = self.escaped(state);
        let begin = self.first();
        let rows: Vec<usize> = escaped.iter().map(|number| number - begin).collect();
        let matter = |row: usize| [self.mass[begin + row], self.compliance(begin + row)];
        self.team().sum_in_order(take_out(&rows, matter, &mut self.parts(state).0))
    }

    /// Number of particles that have been removed in `state`.
    pub(super) fn removed_count(&self, state: &[f64]) -> f64 {
        let density = self.columns(state).density;
        parallel::sum(self.removed.len(), |number| f64::from(Self::is_removed(density[number])))
    }
}

/// Takes particles (rows) out of their columns, and returns what leaves with each. `matter` has the mass in kg and
/// `1 / (rho0 c)^2` of each.
pub(super) fn take_out<const D: usize>(
    rows: &[usize],
    matter: impl Fn(usize) -> [f64; 2],
    own: &mut ColumnsMut<'_, D>,
) -> impl Iterator<Item = Total> {
    rows.iter().map(move |&row| {
        let [mass, compliance] = matter(row);
        let (velocity, pressure) = (own.velocity[row], own.pressure[row]);
        let energy = velocity.norm_squared() + compliance * pressure * pressure;
        let mut total = Total::of(-0.5 * mass * energy);
        add_moments(&own.position[row], &(velocity * -mass), &mut total.force);
        for column in [&mut *own.velocity, own.deviation, own.kick] {
            column[row] = Vector::zeros();
        }
        (own.pressure[row], own.density[row]) = (0.0, REMOVED);
        total
    })
}
