//! Particles that leave the others: through a wall, or out of the box around everything.

use super::Common;
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

/// The density that says that its particle has been removed.
const REMOVED: f64 = 0.0;

/// What to change where particles escape.
const ADVICE: &str = "if a few lost drops do not matter, `scheme.escaped = \"remove\"` takes them \
    out and counts them; otherwise make the wall thicker than the support of the kernel and without \
    holes, raise the wave speed of the fluid, or lower `time.cfl`";

impl<const D: usize> Common<D> {
    /// See [`TransportVelocity::guard`](super::TransportVelocity::guard).
    pub(super) fn guard(&mut self, guard: Guard) {
        let position = &self.particles.position;
        let Some(&first) = position.first().filter(|_| !self.walls.is_empty()) else { return };
        let low = position.iter().fold(first, |low, x| low.inf(x));
        let high = position.iter().fold(first, |high, x| high.sup(x));
        if guard.removes && self.removed.is_empty() {
            self.removed = vec![false; position.len()];
        }
        self.guard = Some((guard, (high - low).max()));
    }

    /// Whether a density is that of a particle that has been removed.
    pub(super) fn is_removed(density: f64) -> bool {
        density == REMOVED
    }

    /// Takes particles out of the interaction, or back into it, as `state` has them.
    pub(super) fn follow_removals(&mut self, state: &[f64]) {
        let (removed, density) = (&self.removed, self.columns(state).density);
        let differs =
            |number: usize| f64::from(Self::is_removed(density[number]) != removed[number]);
        if parallel::maximum(removed.len(), 0.0, differs) == 0.0 {
            return;
        }
        for (number, density) in density.iter().enumerate() {
            let is_removed = Self::is_removed(*density);
            if is_removed != self.removed[number] {
                (self.removed[number], self.is_wall[number]) = (is_removed, is_removed);
            }
        }
        self.support.exclude(&self.is_wall, &self.removed);
    }

    /// The particles that have escaped in `state`, which has been loaded, by number.
    pub(super) fn escaped(&self, state: &[f64]) -> Vec<usize> {
        let Some(bounds) = self.bounds(state).filter(|_| self.lost.is_none()) else {
            return Vec::new();
        };
        let count = self.particles.len();
        let any = parallel::maximum(count, 0.0, |place| {
            f64::from(self.escape_at(place, &bounds).is_some())
        });
        if any == 0.0 {
            return Vec::new();
        }
        let places = self.support.list().places().iter().enumerate();
        let escaped =
            places.filter(|(_, place)| self.escape_at(**place as usize, &bounds).is_some());
        escaped.map(|(number, _)| number).collect()
    }

    /// What is known of a particle that has escaped in `state`, which has been loaded.
    pub(super) fn escape_of(&self, number: usize, state: &[f64]) -> Option<Escape> {
        let (guard, bounds) = (&self.guard.as_ref()?.0, self.bounds(state)?);
        let wall = self.escape_at(self.support.list().places()[number] as usize, &bounds)?;
        let at = self.columns(state);
        let name = |wall: u32| guard.bodies.get(self.particles.body[wall as usize] as usize);
        Some(Escape {
            position: at.position[number].iter().copied().collect(),
            speed: at.velocity[number].norm(),
            behind: wall
                .map_or(Behind::Box, |wall| Behind::Wall(name(wall).cloned().unwrap_or_default())),
            advice: ADVICE,
        })
    }

    /// The box that the fluid may be in, if anybody asks.
    pub(super) fn bounds(&self, state: &[f64]) -> Option<(Vector<D>, Vector<D>)> {
        let reach = Vector::repeat(self.guard.as_ref()?.1);
        let mut bounds: Option<(Vector<D>, Vector<D>)> = None;
        let at = self.columns(state);
        for wall in &self.walls {
            let position = at.position[wall.number as usize];
            let (low, high) = bounds.unwrap_or((position, position));
            bounds = Some((low.inf(&position), high.sup(&position)));
        }
        bounds.map(|(low, high)| (low - reach, high + reach))
    }

    /// The number of the wall particle behind which the one at `place` is, or `Some(None)` if it
    /// has left the bounds.
    fn escape_at(&self, place: usize, bounds: &(Vector<D>, Vector<D>)) -> Option<Option<u32>> {
        let list = self.support.list();
        // Of those that follow another level that one sees whether they are where they must not be.
        if list.is_passive(place) || self.is_wall[list.numbers()[place] as usize] {
            return None;
        }
        let position = &list.positions()[place];
        let periodic = list.domain().periodic();
        if (0..D).any(|axis| {
            let inside = bounds.0[axis]..=bounds.1[axis];
            periodic[axis].is_none() && !inside.contains(&position[axis])
        }) {
            return Some(None);
        }
        let depth = -TOLERANCE * self.particles.spacing[0];
        let reach = self.support.kernel().support_radius(self.support.smoothing_length());
        let (number, way) = self.wall_behind(place, reach, |place| list.positions()[place])?;
        let (_, normal) = self.inside(self.wall_of(number)?, &way)?;
        (way.dot(normal) < depth).then_some(Some(number))
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
        let mut total = Total::default();
        if !self.guard.as_ref().is_some_and(|(guard, _)| guard.removes) {
            return total;
        }
        self.load(state);
        let escaped = self.escaped(state);
        let (own, _) = self.parts(state);
        for number in escaped {
            let mass = self.mass[number];
            let (velocity, pressure) = (own.velocity[number], own.pressure[number]);
            let energy = velocity.norm_squared() + self.compliance(number) * pressure * pressure;
            total.power -= 0.5 * mass * energy;
            add_moments(&own.position[number], &(velocity * -mass), &mut total.force);
            for column in [&mut *own.velocity, own.deviation, own.kick] {
                column[number] = Vector::zeros();
            }
            (own.pressure[number], own.density[number]) = (0.0, REMOVED);
        }
        total
    }

    /// Number of particles that have been removed in `state`.
    pub(super) fn removed_count(&self, state: &[f64]) -> f64 {
        let density = self.columns(state).density;
        parallel::sum(self.removed.len(), |number| f64::from(Self::is_removed(density[number])))
    }
}
