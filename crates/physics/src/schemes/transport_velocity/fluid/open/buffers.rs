//! What particles of the buffers of open boundaries are to the fluid, and what they do to it.

use piola_formulas::fluid;
use piola_formulas::kernels::Needs;
use piola_formulas::pairs::corrected::CorrectedWall;
use piola_formulas::pairs::fluid::Wall;
use piola_formulas::pairs::{MovingPair, Of};

use super::{
    Common, Flow, Fluid, KEPT, Kept, LATE_PRESSURE, Open, OpenBoundary, Seen, Side,
    WeaklyCompressible,
};
use crate::operators::{Among, NeighborBlock, visit};
use crate::schemes::ledger::Total;
use crate::schemes::transport_velocity::Continuum as _;
use crate::{Vector, parallel};

/// Lag of the mean pressure that buffers take from the fluid, in `h/c`, theory (88): long waves on a lattice are
/// reflected least with it.
const LAG: f64 = 0.5;

impl<const D: usize> WeaklyCompressible<D> {
    /// Completes the sides of buffers from those of the fluid around them, at a time in s, theory (86) to (88).
    pub(in super::super) fn fill_buffers(&mut self, common: &mut Common<D>, time: f64) {
        let Open { boundaries, roles, members, seen, terms, means, .. } = &mut self.open;
        let shear = &mut self.shear;
        let begin = common.first();
        seen.clear();
        seen.resize(members.len(), Seen { pressure: None, inwards: 0.0, entering: None });
        let all = &boundaries.all;
        let boundary_of = |number: u32| &all[roles[number as usize] as usize - 1];
        let places = common.support.list().places();
        let place_of = |number: u32| places[number as usize - begin] as usize;
        parallel::for_each_chunk(seen, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let number = members[first + offset];
                let place = place_of(number);
                *row = look_in(common, boundary_of(number), (number, place), time, &mut block);
            }
        });
        let Fluid { density, wave_speed, .. } = self.fluid;
        let (impedance, relaxes) = (density * wave_speed, common.settings.relaxes());
        let positions = common.support.list().positions();
        terms.clear();
        terms.extend(members.iter().zip(&*seen).filter_map(|(&number, seen)| {
            let reference = boundary_of(number).reference(&positions[place_of(number)], time);
            Some([f64::from(roles[number as usize]), seen.pressure? - reference, seen.inwards])
        }));
        // In the order of numbers, whoever has them.
        *terms = common.team().rows_of_all(std::mem::take(terms));
        for (role, mean) in (1_u32..).zip(means.iter_mut()) {
            let (mut sum, mut inwards, mut count) = (0.0, 0.0, 0.0);
            for [_, above, velocity] in terms.iter().filter(|term| term[0] == f64::from(role)) {
                sum += above;
                inwards += velocity;
                count += 1.0;
            }
            mean.inwards = if count > 0.0 { inwards / count } else { mean.stream };
            // Without fluid in reach there is no sound: a state has the slow part alone.
            mean.above = if count > 0.0 { sum / count } else { mean.slow };
            // At the start there is no past.
            if mean.slow.is_nan() {
                mean.above = if count > 0.0 { mean.above } else { 0.0 };
                (mean.slow, mean.late) = (mean.above, mean.above);
                mean.inwards = if count > 0.0 { mean.inwards } else { 0.0 };
                mean.stream = mean.inwards;
            }
        }
        for (&number, seen) in members.iter().zip(seen) {
            let place = place_of(number);
            let (boundary, mean) =
                (boundary_of(number), &means[roles[number as usize] as usize - 1]);
            let pressure = match (&boundary.flow, seen.pressure) {
                (Flow::Velocity(_), Some(pressure)) => pressure - mean.lead(),
                (Flow::Velocity(_), None) => mean.late,
                (Flow::Pressure(_), Some(pressure)) => pressure - mean.lead() - mean.slow,
                (Flow::Pressure(_), None) => {
                    boundary.reference(&positions[place], time) + mean.late - mean.slow
                }
            };
            let side: &mut Side<D> = &mut common.sides[place];
            if matches!(boundary.flow, Flow::Pressure(_)) && seen.inwards > 0.0 {
                let along = seen.inwards - mean.inwards + mean.stream;
                seen.entering = Some(boundary.normal * along);
            }
            let sound = boundary.normal * (mean.sound() / impedance);
            side.velocity = seen.entering.unwrap_or(side.velocity) - sound;
            side.deviation = Vector::zeros();
            let mass = common.mass[number as usize];
            let at_rest = density;
            let density = fluid::density(pressure, density, wave_speed);
            // They stand as far apart as they came in, under any pressure.
            let mass = if relaxes { mass * density / at_rest } else { mass };
            side.set(mass, density, pressure);
            shear[place] = side.velocity;
        }
        common.show_sides();
        self.show_walls(common);
    }

    /// Moves buffers along their normals for a `step` in s with the velocities half way, and lets the slow pressures
    /// follow.
    pub(in super::super) fn move_buffers(
        &self,
        common: &Common<D>,
        step: f64,
        middle: f64,
        state: &mut [f64],
    ) {
        let open = &self.open;
        if open.is_empty() {
            return;
        }
        self.move_followers(common, step, state);
        let impedance = self.fluid.density * self.fluid.wave_speed;
        let (own, _) = common.parts(state);
        for (&number, seen) in open.members.iter().zip(&open.seen) {
            let number = number as usize;
            let Some((role, boundary)) = open.boundary_of(number) else { continue };
            let Some(row) = common.row(number) else { continue };
            let mean = &open.means[role];
            let velocity = boundary.velocity(&own.position[row], middle);
            let velocity = velocity.or(seen.entering).unwrap_or(own.velocity[row]);
            let along = velocity.dot(&boundary.normal) - mean.sound() / impedance;
            own.position[row] += boundary.normal * (step * along);
            if matches!(boundary.flow, Flow::Pressure(_)) {
                let share = follows(step, boundary.relaxation);
                own.velocity[row] += boundary.normal * (mean.gain() * share);
            }
        }
        let lag = LAG * common.support.smoothing_length() / self.fluid.wave_speed;
        let (_, kept) = Kept::of(common, state);
        for ((mean, boundary), kept) in
            open.means.iter().zip(&open.boundaries.all).zip(kept.each.chunks_exact_mut(KEPT))
        {
            let share = follows(step, boundary.relaxation);
            kept[0] = mean.slow + mean.sound() * share;
            kept[3] = mean.stream + mean.gain() * share;
            // What grows evenly is late by `lag`, whatever the step is up to that.
            kept[LATE_PRESSURE] = mean.late + mean.lead() * (step / lag).min(1.0);
        }
    }

    /// Finds what the buffers do to the fluid, of the forces of walls that have been found, and the pressure of those that
    /// follow other levels, of the forces among the fluid.
    pub(in super::super) fn part_forces(&mut self, common: &Common<D>) {
        let mut forces = std::mem::take(&mut self.open.forces);
        let mut pulls = std::mem::take(&mut self.open.pulls);
        let (list, roles) = (common.support.list(), &self.open.roles);
        let (constants, _) = self.force_law(common);
        let law = Wall::<D>::of(&constants);
        let number = |place: usize| list.numbers()[place];
        let (all, reach) = (&self.open.boundaries.all, list.support());
        // Most of the fluid is far from all planes, and need not look at its neighbours.
        let near_opening = |at: &Vector<D>| {
            all.iter().any(|it| (it.plane - at.dot(&it.normal)).abs() < reach + it.length)
        };
        let of_buffers =
            |other: usize| (roles[number(other) as usize] > 0).then(|| self.shear[other]);
        let (gradients, corrected) = (&self.gradients, common.settings.corrects_gradients());
        let act = |law: Wall<D>| {
            move |[me, other]: [usize; 2], jump: &_, pair: &_, sum: &mut _| {
                let sides = [me, other].map(|place| &common.sides[place]);
                match corrected {
                    true => {
                        let [own, foreign] = [me, other].map(|place| &gradients[place]);
                        let both = [(sides[0], own), (sides[1], foreign)];
                        CorrectedWall(law).act(both, jump, pair, sum);
                    }
                    false => law.act(sides, jump, pair, sum),
                }
            }
        };
        part(common, act(law), Among::Passive, near_opening, of_buffers, &mut forces);
        let near_level = |at: &Vector<D>| self.meets_followers(at, reach);
        let of_followers =
            |other: usize| self.is_follower(number(other)).then(|| common.sides[other].velocity);
        let law = Wall { viscosity: 0.0, ..law };
        part(common, act(law), Among::Active, near_level, of_followers, &mut pulls);
        (self.open.forces, self.open.pulls) = (forces, pulls);
    }

    /// The power of the buffers and their force, and those of what follows other levels; and what those that fluid enters
    /// through keep of its velocity.
    pub(in super::super) fn store_open(&self, common: &Common<D>, state: &mut [f64]) -> [Total; 2] {
        let open = &self.open;
        if open.is_empty() {
            return [Total::default(); 2];
        }
        self.keep_followers(common, state);
        let (own, _) = common.parts(state);
        for (&number, seen) in open.members.iter().zip(&open.seen) {
            if let (Some(velocity), Some(row)) = (seen.entering, common.row(number as usize)) {
                own.velocity[row] = velocity;
            }
        }
        let at = common.columns(state);
        let (places, begin) = (common.support.list().places(), common.first());
        [&open.forces, &open.pulls].map(|forces| {
            if forces.is_empty() {
                return Total::default();
            }
            common.team().sums(forces.len(), |row, sum: &mut Total| {
                let place = places[row] as usize;
                let (force, mass) = (forces[place], common.mass[begin + row]);
                if force != Vector::<D>::zeros() {
                    sum.push(&at.position[row], &at.velocity[row], &(force * mass));
                    sum.growth += mass * force.dot(&common.forces[place].total());
                }
            })
        })
    }
}

/// Fills `forces` by place with those of some neighbours on fluid in some places: `theirs` is the velocity that
/// viscous forces see of a neighbour that counts.
fn part<const D: usize>(
    common: &Common<D>,
    law: impl Fn([usize; 2], &Vector<D>, &Of<MovingPair<D>, f64>, &mut Vector<D>) + Sync,
    among: Among,
    is_near: impl Fn(&Vector<D>) -> bool + Sync,
    theirs: impl Fn(usize) -> Option<Vector<D>> + Sync,
    forces: &mut [Vector<D>],
) {
    let list = common.support.list();
    let kind = usize::from(among == Among::Passive);
    parallel::for_each_chunk(forces, |first, rows| {
        let mut block = NeighborBlock::default();
        for (offset, row) in rows.iter_mut().enumerate() {
            let place = first + offset;
            *row = Vector::zeros();
            if list.is_passive(place)
                || common.is_wall[list.numbers()[place] as usize]
                || !is_near(&list.positions()[place])
            {
                continue;
            }
            let neighbors = common.support.places_of(place)[kind];
            if !neighbors.iter().any(|&other| theirs(other as usize).is_some()) {
                continue;
            }
            visit(&common.support, place, among, Needs::Slope, &mut block, |other, pair| {
                if let Some(velocity) = theirs(other) {
                    let jump = common.sides[place].velocity - velocity;
                    law([place, other], &jump, pair, row);
                }
            });
        }
    });
}

/// What share of their change means that follow in a time in s do within a step in s.
fn follows(step: f64, time: f64) -> f64 {
    -(-step / time).exp_m1()
}

/// What the particle of a buffer takes from the fluid around it.
fn look_in<const D: usize>(
    common: &Common<D>,
    boundary: &OpenBoundary<D>,
    (number, place): (u32, usize),
    time: f64,
    block: &mut NeighborBlock<D>,
) -> Seen<D> {
    let around = common.surroundings(place, block);
    if !(around.weight > 0.0) {
        return Seen { pressure: None, inwards: 0.0, entering: None };
    }
    let gravity = common.body_force_at(number as usize, place, time);
    let pressure = (around.pressure + gravity.dot(&around.arm)) / around.weight;
    let inwards = around.velocity.dot(&boundary.normal) / around.weight;
    Seen { pressure: Some(pressure), inwards, entering: None }
}
