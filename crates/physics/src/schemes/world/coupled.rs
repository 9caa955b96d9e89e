//! What the systems of a world do to each other in a step.

use std::ops::Range;

use super::contact::Origin;
use super::description::SHARED;
use super::flow::{Way, most_steps, shortest, steps_within};
use super::{MOST_STEPS, Solid, World};
use crate::geometry::turned_normal;
use crate::schemes::momentum::{MOST_COMPONENTS, add_moments, momentum_components};
use crate::schemes::parts::Part;
use crate::schemes::transport_velocity::Guide;
use crate::schemes::{CoupledScheme, Ledger, Scheme, SplitScheme};
use crate::{Vector, parallel};

impl<const D: usize> Solid<D> {
    /// What brings forces that it keeps in its part of a state into line with velocities that have changed; what implicit
    /// steps keep is of their own making.
    fn settling(&mut self) -> Option<&mut dyn SplitScheme> {
        let is_explicit = self.cfl.is_some();
        self.scheme.split().filter(|_| is_explicit)
    }

    /// Place and velocity of the wall particle in `row` of the interface.
    pub(super) fn wall(&self, own: &[f64], row: usize) -> [Vector<D>; 2] {
        let place = self.interface.place(row, self.displacements(own, row));
        [place, self.interface.carried(row, |b| self.velocity(own, b))]
    }
}

impl<const D: usize> World<D> {
    /// The solids with their parts of a state.
    fn with_parts(&self) -> impl Iterator<Item = (&Solid<D>, &Part)> {
        self.solids.iter().zip(&self.parts.all[1..])
    }

    /// Puts the walls of the fluid where the solids are, with their velocities.
    pub(super) fn carry_walls(&mut self, state: &mut [f64]) {
        let mut carried = std::mem::take(&mut self.carried);
        let mut rest = carried.as_mut_slice();
        for (solid, part) in self.with_parts() {
            let own = &state[part.state.clone()];
            let (walls, others) = rest.split_at_mut(solid.interface.walls().len());
            parallel::for_each_chunk(walls, |first, walls| {
                (first..).zip(walls).for_each(|(row, wall)| *wall = solid.wall(own, row));
            });
            rest = others;
        }
        let fluid = &mut state[self.parts.all[0].state.clone()];
        let numbers = self.solids.iter().flat_map(|solid| solid.interface.walls());
        for (&number, [place, velocity]) in numbers.zip(&carried) {
            self.fluid.place_wall(fluid, number, place, velocity);
        }
        self.carried = carried;
    }

    /// Tells the fluid how its walls move and which way they face in a state.
    pub(super) fn guide(&mut self, state: &[f64]) {
        let (solids, parts) = (&self.solids, &self.parts);
        self.fluid.guide(|wall| {
            let number = solids.partition_point(|solid| solid.first <= wall) - 1;
            let (solid, own) = (&solids[number], &state[parts.all[number + 1].state.clone()]);
            let row = wall - solid.first;
            let velocity = solid.interface.carried(row, |b| solid.velocity(own, b));
            let deformation = solid.deformation(own, row);
            Guide { velocity, deformation: Some(deformation) }
        });
    }

    /// Index of the work of the interface of a solid among the works of all, and that of its impulse among
    /// the sources of momentum. Those of contact are the next.
    fn entries(&self, solid: usize) -> [usize; 2] {
        let ledger = |k: usize| self.system(k).description().ledger;
        let works = 1 + (0..=solid + 1).map(|k| ledger(k).mechanisms.len()).sum::<usize>();
        let ways = (0..=solid + 1).map(|k| ledger(k).impulses.len()).sum::<usize>();
        [works, ways].map(|before| before + SHARED.len() * solid)
    }

    /// Turns walls with the solids and finds where surfaces touch, unless that is known for the same places of the solids.
    pub(super) fn follow(&mut self, state: &[f64]) {
        if !self.knows(state) {
            self.guide(state);
            self.meet(state);
        }
    }

    /// Whether walls are turned, and surfaces met, as in a state.
    fn knows(&self, state: &[f64]) -> bool {
        let mut rest = self.known.as_slice();
        let mut is_known = !rest.is_empty() && !self.fluid.moves_walls();
        for places in self.with_parts().map(|it| places_in(state, it)) {
            is_known = is_known && rest[..places.len()] == *places;
            rest = rest.get(places.len()..).unwrap_or(&[]);
        }
        is_known
    }

    /// Finds where surfaces touch in a state, for which walls have been turned.
    pub(super) fn meet(&mut self, state: &[f64]) {
        self.known.clear();
        for places in self.solids.iter().zip(&self.parts.all[1..]).map(|it| places_in(state, it)) {
            self.known.extend_from_slice(places);
        }
        let (solids, fluid, parts) = (&self.solids, &self.fluid, &self.parts);
        fluid.places_of(
            &state[parts.all[0].state.clone()],
            self.contact.walls(),
            &mut self.fixed_at,
        );
        let (domain, spacing, fixed_at) = (fluid.domain(), fluid.spacing(), &self.fixed_at);
        let of = |solid: usize| (&solids[solid], &state[parts.all[solid + 1].state.clone()]);
        let place = |origin: &Origin, offset: &Vector<D>| match *origin {
            Origin::Wall { wall, .. } => fixed_at[wall][0] + offset,
            Origin::Solid { solid, row, .. } => {
                let (solid, own) = of(solid);
                solid.interface.place_at(row, offset, solid.displacements(own, row))
            }
        };
        let normal = |origin: &Origin, rest: &Vector<D>| match *origin {
            Origin::Wall { .. } => *rest,
            Origin::Solid { solid, row, .. } => {
                let (solid, own) = of(solid);
                turned_normal(&solid.deformation(own, row), rest)
            }
        };
        self.contact.update(domain, spacing, place, normal);
    }

    /// Finds what solids do to each other where they touch, and walls to them, at a time in s in the state that
    /// [`Self::meet`] was called with last.
    pub(super) fn touch(&mut self, time: f64, state: &[f64]) {
        let (solids, fluid, parts) = (&self.solids, &self.fluid, &self.parts);
        for (forces, solid) in self.touches.iter_mut().zip(solids) {
            forces.clear();
            forces.resize(solid.mass.len(), Vector::zeros());
        }
        let touches = &mut self.touches;
        let velocity = |origin: &Origin, offset: &Vector<D>| match *origin {
            Origin::Wall { wall, .. } => {
                fluid.surface_velocity(time, (self.contact.walls(), wall), self.fixed_at[wall][1])
            }
            Origin::Solid { solid, row, .. } => {
                let (solid, own) = (&solids[solid], &state[parts.all[solid + 1].state.clone()]);
                solid.interface.carried_at(row, offset, |b| solid.velocity(own, b))
            }
        };
        let bear = |origin: &Origin, offset: &Vector<D>, force: &Vector<D>| {
            if let Origin::Solid { solid, row, .. } = *origin {
                solids[solid].interface.bear_at(row, offset, force, &mut touches[solid]);
            }
        };
        let scale = (fluid.spacing(), fluid.wave_speed());
        self.contact.forces(scale, |solid| solids[solid].law, velocity, bear);
    }

    /// Finds the forces of the fluid on walls, as a state has them.
    pub(super) fn pull(&mut self, state: &[f64]) {
        let fluid = &state[self.parts.all[0].state.clone()];
        self.fluid.forces_on(fluid, &self.guided, &mut self.pulls);
    }

    /// Finds what acts on the particles of the solids in a state at a time in s: the forces of the fluid, which are those
    /// that a step has left to give or those that [`Self::pull`] has found, and those of others where they touch.
    fn find_forces(&mut self, time: f64, state: &[f64]) {
        self.touch(time, state);
        let given = if self.rest.is_empty() { &self.pulls } else { &self.rest };
        for (forces, solid) in self.forces.iter_mut().zip(&self.solids) {
            forces.clear();
            forces.resize(solid.mass.len(), Vector::zeros());
            let walls = solid.first..solid.first + solid.interface.walls().len();
            for (row, force) in given[walls].iter().enumerate() {
                solid.interface.bear(row, force, forces);
            }
        }
    }

    /// Gives a solid the impulse in a duration in s, at a time in s, of `forces` of the fluid on its particles and of others
    /// that it touches: changes its part of a state, and books that in the ledger of all, `tail`.
    fn kick_solid(
        &mut self,
        number: usize,
        [time, duration]: [f64; 2],
        forces: [&[Vector<D>]; 2],
        (own, tail): (&mut [f64], &mut [f64]),
    ) {
        let (works, components) =
            (self.description.ledger.mechanisms.len(), momentum_components(D).len());
        let [mechanism, way] = self.entries(number);
        let solid = &self.solids[number];
        for (shared, forces) in forces.into_iter().enumerate() {
            if shared > 0 && forces.iter().all(|force| *force == Vector::<D>::zeros()) {
                continue;
            }
            let column = &mut own[solid.velocities.clone()];
            let column: &mut [Vector<D>] = bytemuck::cast_slice_mut(column);
            self.before.clear();
            self.before.extend_from_slice(column);
            for ((velocity, force), mass) in column.iter_mut().zip(forces).zip(&solid.mass) {
                *velocity += force * (duration / mass);
            }
            // What moves as prescribed takes nothing from outside: its support does, and some solids book that.
            let ledger = solid.scheme.ledger_start();
            self.booked.clear();
            self.booked.extend_from_slice(&own[ledger..]);
            solid.scheme.constrain(time, own);
            own[ledger..].copy_from_slice(&self.booked);
            let (before, own) = (&self.before, &*own);
            let [work, impulse] = parallel::sums(before.len(), |a, sums| {
                let [[work, ..], impulse]: &mut [[f64; MOST_COMPONENTS]; 2] = sums;
                let (after, place) = (solid.velocity(own, a), solid.place(own, a));
                let change = (after - before[a]) * solid.mass[a];
                *work += 0.5 * change.dot(&(after + before[a]));
                add_moments(&place, &change, impulse);
            });
            tail[mechanism + shared] += work[0];
            let sums = tail[works + (way + shared) * components..].iter_mut();
            sums.zip(&impulse[..components]).for_each(|(sum, part)| *sum += part);
        }
    }

    /// The same to its part of the state of all, with `forces` and `touches` by solid.
    fn kick_in(
        &mut self,
        number: usize,
        push: [f64; 2],
        [forces, touches]: [&[Vec<Vector<D>>]; 2],
        state: &mut [f64],
    ) {
        let (states, tail) = state.split_at_mut(self.ledger_at());
        let own = &mut states[self.parts.all[number + 1].state.clone()];
        self.kick_solid(number, push, [&forces[number], &touches[number]], (own, tail));
    }
}

/// Displacements or positions of a solid in a state.
fn places_in<'a, const D: usize>(state: &'a [f64], (solid, part): (&Solid<D>, &Part)) -> &'a [f64] {
    &state[part.state.clone()][solid.places.clone()]
}

impl<const D: usize> CoupledScheme for World<D> {
    fn solid_count(&self) -> usize {
        self.solids.len()
    }

    #[inline(never)]
    fn solid(&mut self, number: usize) -> (&mut dyn Scheme, Range<usize>) {
        (self.solids[number].scheme.as_mut(), self.parts.all[number + 1].state.clone())
    }

    #[inline(never)]
    fn fluid_steps(&self, step: f64) -> u64 {
        let cfl = self.cfl.filter(|_| self.solids.iter().all(|solid| solid.cfl.is_some()));
        cfl.map_or(1, |cfl| steps_within(step, shortest(&self.limits, cfl), most_steps(cfl)))
    }

    #[inline(never)]
    fn solid_steps(&self, number: usize, step: f64) -> u64 {
        let Solid { cfl, limits, .. } = &self.solids[number];
        cfl.map_or(1, |cfl| steps_within(step, shortest(limits, cfl), MOST_STEPS))
    }

    #[inline(never)]
    fn push(&mut self, [time, step]: [f64; 2], counts: &[u64], state: &mut [f64]) {
        self.rest.clear();
        self.follow(state);
        self.pull(state);
        self.find_forces(time, state);
        std::mem::swap(&mut self.forces, &mut self.held[0]);
        for (held, touches) in self.held[1].iter_mut().zip(&self.touches) {
            held.clone_from(touches);
        }
        let held = std::mem::take(&mut self.held);
        for (number, &count) in counts[1..].iter().enumerate() {
            let duration = 0.5 * step / count as f64;
            self.kick_in(number, [time, duration], [&held[0], &held[1]], state);
        }
        self.held = held;
    }

    #[inline(never)]
    fn push_on(&mut self, number: usize, push: [f64; 2], own: &mut [f64], state: &mut [f64]) {
        let held = std::mem::take(&mut self.held);
        let tail = &mut state[self.ledger_at()..];
        self.kick_solid(number, push, [&held[0][number], &held[1][number]], (own, tail));
        self.held = held;
        if let Some(solid) = self.solids[number].settling() {
            solid.settle_between(push[0], own);
        }
    }

    #[inline(never)]
    fn repay(&mut self, [time, step]: [f64; 2], counts: &[u64], state: &mut [f64]) {
        // Its last step has turned the walls.
        self.meet(state);
        let time = time + step;
        self.find_forces(time, state);
        let (mut forces, mut touches) =
            (std::mem::take(&mut self.forces), std::mem::take(&mut self.touches));
        for (number, &count) in counts[1..].iter().enumerate() {
            // Of the forces at the start it has had more than for half of the step.
            let excess = 1.0 - 1.0 / count as f64;
            if excess > 0.0 {
                for (now, held) in [&mut forces, &mut touches].into_iter().zip(&self.held) {
                    let pairs = now[number].iter_mut().zip(&held[number]);
                    pairs.for_each(|(now, held)| *now -= held * excess);
                }
            }
            self.kick_in(number, [time, 0.5 * step], [&forces, &touches], state);
        }
        (self.forces, self.touches) = (forces, touches);
        self.carry_walls(state);
        let power = |((way, force), [_, velocity]): ((&Way<D>, &Vector<D>), &[Vector<D>; 2])| {
            force.dot(&if way.is_held { way.mean_velocity() } else { *velocity })
        };
        let walls = self.ways.iter().zip(&self.pulls).zip(&self.carried);
        let power = walls.map(power).sum::<f64>();
        let entry = self.interface_at();
        state[entry] -= 0.5 * step / counts[0] as f64 * power;
    }

    #[inline(never)]
    fn settle(&mut self, time: f64, state: &mut [f64]) {
        for (solid, part) in self.solids.iter_mut().zip(&self.parts.all[1..]) {
            if let Some(solid) = solid.settling() {
                solid.settle(time, &mut state[part.state.clone()]);
            }
        }
    }

    #[inline(never)]
    fn flow(&mut self, [time, step]: [f64; 2], counts: &[u64], old: &[f64], new: &mut [f64]) {
        // Walls turn on the way.
        self.known.clear();
        self.find_ways(step, counts, [old, new]);
        self.flow_along(time, step, counts[0], new);
    }

    #[inline(never)]
    fn add_up(&mut self, counts: &[u64], state: &mut [f64]) {
        let behind = self.counts_at();
        for (kept, &count) in state[behind..].chunks_exact_mut(2).zip(counts) {
            kept[0] = count as f64;
            kept[1] += count as f64;
        }
        let (states, tail) = state.split_at_mut(self.ledger_at());
        let (works, impulses) = tail.split_at_mut(self.description.ledger.mechanisms.len());
        let components = momentum_components(D).len();
        let [mut work, mut impulse] = [0; 2];
        for (k, part) in self.parts.all.iter().enumerate() {
            let ledger = Ledger::of(self.system(k), &states[part.state.clone()]);
            works[work..][..ledger.work.len()].copy_from_slice(ledger.work);
            if k == 0 {
                works[self.walls] -= works[ledger.work.len()];
            }
            impulses[impulse..][..ledger.impulses.len()].copy_from_slice(ledger.impulses);
            // Behind those of a solid stands what others do to it, behind those of the fluid the work of solids.
            let [own, shared] = if k > 0 { [SHARED.len(); 2] } else { [1, 0] };
            work += ledger.work.len() + own;
            impulse += ledger.impulses.len() + shared * components;
        }
    }

    #[inline(never)]
    fn forget(&mut self) {
        self.known.clear();
        self.fixed_at.clear();
    }

    #[inline(never)]
    fn refresh(&mut self, time: f64, state: &mut [f64]) {
        for (solid, part) in self.solids.iter_mut().zip(&self.parts.all[1..]) {
            if let Some(solid) = solid.scheme.split() {
                solid.accelerate(time, &mut state[part.state.clone()]);
            }
        }
        self.carry_walls(state);
        self.guide(state);
        self.forget();
        self.fluid.accelerate(time, &mut state[self.parts.all[0].state.clone()]);
    }
}
