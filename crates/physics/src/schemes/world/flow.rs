//! The steps of the fluid in a step of all: where its walls are, and what the solids get for it.

use nalgebra::ArrayStorage;

use super::{Solid, World};
use crate::schemes::transport_velocity::Guide;
use crate::schemes::{Scheme, SplitScheme, StepLimit};
use crate::{Tensor, Vector, parallel};

/// Most steps of the fluid in one of all. At a CFL number of 0.25 what moves with a tenth of the wave speed goes
/// 0.4 of a smoothing length in this many: the look at the state after a step sees it before it is through
/// a layer of particles, and the look before it sees surfaces that will touch.
pub const MOST_FLUID_STEPS: u64 = 16;

/// The same at another CFL number: as far in all.
pub(super) fn most_steps(cfl: f64) -> u64 {
    (0.25 / cfl * MOST_FLUID_STEPS as f64).clamp(1.0, MOST_FLUID_STEPS as f64) as u64
}

/// What a step may be longer than the stable ones in it together, for round-off of times that are met.
const ROUND_OFF: f64 = 1e-8;

/// How a wall particle goes through a step: on a parabola that begins with the velocity of the solid, theory (82).
#[derive(Clone, Copy, Debug)]
pub(super) struct Way<const D: usize> {
    pub number: u32,
    places: [Vector<D>; 2],
    velocities: [Vector<D>; 2],
    /// Deformation gradients; the first one is that at the end, too, where nothing needs those in between.
    gradients: [Tensor<D>; 2],
    /// The step in s.
    step: f64,
    /// Whether the solid takes several own steps in it, with the forces at the start held.
    pub is_held: bool,
}

impl<const D: usize> Way<D> {
    /// That of no wall particle.
    const NOWHERE: Self = Self {
        number: 0,
        places: [Vector::<D>::from_array_storage(ArrayStorage([[0.0; D]])); 2],
        velocities: [Vector::<D>::from_array_storage(ArrayStorage([[0.0; D]])); 2],
        gradients: [Tensor::<D>::from_array_storage(ArrayStorage([[0.0; D]; D])); 2],
        step: 0.0,
        is_held: false,
    };

    /// That of the wall particle in a `row` of the interface of a solid, from one of its states to another, a step in s later,
    /// in which the fluid and the solid take `counts` of their own.
    fn of(
        solid: &Solid<D>,
        row: usize,
        states: [&[f64]; 2],
        (step, [count, own]): (f64, [u64; 2]),
    ) -> Self {
        let [[from, begin], [to, end]] = states.map(|own| solid.wall(own, row));
        // Positions may have been wrapped into the box on the way.
        let to = if solid.is_displaced { to } else { from + solid.domain.separation(&from, &to) };
        let gradients = match count {
            1 => [solid.deformation(states[1], row); 2],
            _ => states.map(|own| solid.deformation(own, row)),
        };
        // The velocity at the end of the step is not known before the solid has the rest of the impulse.
        let end = if count > 1 { (to - from) * (2.0 / step) - begin } else { end };
        let number = solid.interface.walls()[row];
        let is_held = own > 1;
        Self { number, places: [from, to], velocities: [begin, end], gradients, step, is_held }
    }

    /// Its mean velocity in the step.
    pub fn mean_velocity(&self) -> Vector<D> {
        (self.places[1] - self.places[0]) / self.step
    }

    /// Where it is after `k` of `count` parts of the step.
    fn place(&self, k: u64, count: u64) -> Vector<D> {
        let [from, to] = self.places;
        let share = k as f64 / count as f64;
        match k {
            0 => from,
            _ if k == count => to,
            _ => {
                from + self.velocities[0] * (self.step * share * (1.0 - share))
                    + (to - from) * (share * share)
            }
        }
    }

    /// Its velocity then.
    fn velocity(&self, k: u64, count: u64) -> Vector<D> {
        let [from, to] = self.velocities;
        match k {
            0 => from,
            _ if k == count => to,
            _ => from + (to - from) * (k as f64 / count as f64),
        }
    }

    /// How it goes on then to the next place.
    fn guide_on(&self, k: u64, count: u64) -> Guide<D> {
        let way = self.place(k + 1, count) - self.place(k, count);
        Guide { velocity: way * (count as f64 / self.step), deformation: None }
    }

    /// How it moves then.
    fn guide(&self, k: u64, count: u64) -> Guide<D> {
        let [from, to] = self.gradients;
        let part = (to - from) * (k as f64 / count as f64);
        let deformation = if k == count { to } else { from + part };
        Guide { velocity: self.velocity(k, count), deformation: Some(deformation) }
    }
}

impl<const D: usize> World<D> {
    /// How many steps of the fluid, as they are for its `limits`, may be one of all: as many as fit into what the
    /// solids may take by themselves, and into the time in which the waves of the fluid stop a layer of
    /// particles of a solid, `rho_s dx / (rho c)`, theory (82). One where that of a solid is not known, where solids
    /// touch something, as contact is as stiff as a step of the fluid allows, and where steps are fixed.
    pub(super) fn fluid_steps_of(&self, limits: &[StepLimit]) -> u64 {
        let Some(cfl) = self.cfl else { return 1 };
        let of_solids = self.solids.iter().map(|solid| solid.stable_step().min(solid.layer));
        let longest = of_solids.fold(f64::INFINITY, f64::min);
        let count = (longest / shortest(limits, cfl)).floor();
        if !(longest < f64::INFINITY && count >= 2.0) {
            return 1;
        }
        let (domain, spacing) = (self.fluid.domain(), self.fluid.spacing());
        if self.contact.is_near(domain, spacing) { 1 } else { (count as u64).min(most_steps(cfl)) }
    }

    /// Finds how walls go through a step in which systems take `counts` of their own, the fluid first, from one state to
    /// another.
    pub(super) fn find_ways(&mut self, step: f64, counts: &[u64], [old, new]: [&[f64]; 2]) {
        let all = self.solids.iter().map(|solid| solid.interface.walls().len()).sum();
        self.ways.resize(all, Way::NOWHERE);
        let mut rest = self.ways.as_mut_slice();
        let solids = self.solids.iter().zip(&self.parts.all[1..]).zip(&counts[1..]);
        for ((solid, part), &own_steps) in solids {
            let states = [old, new].map(|state| &state[part.state.clone()]);
            let (own, others) = rest.split_at_mut(solid.interface.walls().len());
            parallel::for_each_chunk(own, |first, ways| {
                for (row, way) in (first..).zip(ways) {
                    *way = Way::of(solid, row, states, (step, [counts[0], own_steps]));
                }
            });
            rest = others;
        }
    }

    /// Takes the fluid in `state`, for which walls have been turned, through a step in `count` parts, and finds with which
    /// forces the solids would get in half of the step what is left of the impulse.
    pub(super) fn flow_along(&mut self, time: f64, step: f64, count: u64, state: &mut [f64]) {
        let (fluid, own) = (self.parts.all[0].state.clone(), step / count as f64);
        self.rest.clear();
        if count > 1 {
            self.rest.extend(self.pulls.iter().map(|force| -force));
        }
        let entry = self.interface_at();
        for k in 0..count {
            let begin = time + k as f64 * own;
            // What the end of the step has of the work follows when the solids have the rest of the impulse.
            let weight = if k > 0 { own } else { 0.5 * own };
            state[entry] -= weight * self.power_of_walls(k, count);
            self.bear_part(own / step);
            // The drift sees walls where they were, turned as they were, as it sees the fluid.
            self.fluid.guide(|wall| self.ways[wall].guide_on(k, count));
            let part = &mut state[fluid.clone()];
            self.fluid.kick(0.5 * own, part);
            self.fluid.drift(begin, own, part);
            for way in &self.ways {
                let place = way.place(k + 1, count);
                self.fluid.place_wall(part, way.number, &place, &way.velocity(k + 1, count));
            }
            self.fluid.guide(|wall| self.ways[wall].guide(k + 1, count));
            self.fluid.constrain(begin + own, part);
            self.fluid.accelerate(begin + own, part);
            self.fluid.kick(0.5 * own, part);
            self.pull(state);
            self.bear_part(own / step);
        }
    }

    /// The power in W of the fluid on walls after `k` of `count` parts of the step; that of forces that are held is what
    /// they do on the way of the wall, whose velocity at both ends says little of faster vibrations.
    fn power_of_walls(&self, k: u64, count: u64) -> f64 {
        let power = |(way, force): (&Way<D>, &Vector<D>)| {
            force.dot(&if way.is_held { way.mean_velocity() } else { way.velocity(k, count) })
        };
        self.ways.iter().zip(&self.pulls).map(power).sum()
    }

    /// Adds the forces of the fluid on walls for half of one of its steps, a `share` of the whole.
    fn bear_part(&mut self, share: f64) {
        for (rest, force) in self.rest.iter_mut().zip(&self.pulls) {
            *rest += force * share;
        }
    }
}

/// The least number of steps that makes stable ones, of at most `stable` s, of a `step` in s, up to `most`.
pub(super) fn steps_within(step: f64, stable: f64, most: u64) -> u64 {
    let count = (step / stable * (1.0 - ROUND_OFF)).ceil();
    // What has broken down is found by the look at the state that this step leads to.
    if count >= 1.0 { (count as u64).min(most) } else { 1 }
}

/// The step of some limits with a CFL number in s.
pub(super) fn shortest(limits: &[StepLimit], cfl: f64) -> f64 {
    let own = |limit: &StepLimit| limit.step * if limit.scaled { cfl } else { 1.0 };
    limits.iter().map(own).fold(f64::INFINITY, f64::min)
}
