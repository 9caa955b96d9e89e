//! Particles that go through open boundaries.

use super::{Common, KEPT, Kept, WeaklyCompressible};
use crate::parallel::Reduce as _;
use crate::schemes::ledger::Total;
use crate::schemes::momentum::add_moments;
use crate::{Vector, parallel};

/// How far beyond a plane, in spacings, a particle may be before it changes sides. All that are beyond it
/// then do, so that neighbour lists are made anew no more often than they are anyway.
const OVERSHOOT: f64 = 0.25;

/// What happens to a particle in an exchange, with the number of the boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    ComeIn(usize),
    GoOut(usize),
    Leave,
}

impl<const D: usize> WeaklyCompressible<D> {
    /// Sets the velocities of buffers at a time in s, and lets particles change sides that have gone through
    /// a plane: fluid goes into a buffer with the velocity that it has, and a particle of a buffer becomes
    /// fluid and is followed by another one at the buffer's end. What has come to the end of a buffer is taken out.
    ///
    /// The energy and the momentum that enter are those of particles that become fluid.
    pub(in super::super) fn exchange(
        &mut self,
        common: &mut Common<D>,
        time: f64,
        state: &mut [f64],
    ) -> Total {
        self.follow_roles(common, state);
        self.prescribe(common, time, state);
        let spacing = common.particles.spacing[0];
        let [overshoot] = common.team().largest([self.overshoot(common, state)]);
        if overshoot < OVERSHOOT * spacing {
            return Total::default();
        }
        let total = self.on_whole(common, state, Self::change_sides);
        self.follow_roles(common, state);
        self.prescribe(common, time, state);
        total
    }

    /// Lets particles of a state of all ranks change sides, and keeps buffers as full as they were.
    fn change_sides(&mut self, common: &Common<D>, whole: &mut [f64]) -> Total {
        let mut total = Total::default();
        let mut changes = std::mem::take(&mut self.open.changes);
        self.find_changes(common, whole, &mut changes);
        let mut free = self.vacant(common, whole);
        // Those that leave make room for those that come in.
        for &(number, _) in changes.iter().filter(|(_, change)| *change == Change::Leave) {
            self.take_out(common, number, whole);
            free.push(number as u32);
        }
        free.sort_unstable_by(|a, b| b.cmp(a));
        for &(number, change) in &changes {
            match change {
                Change::Leave => {}
                Change::GoOut(role) => {
                    let carried = self.carry_over(common, number, -1.0, whole);
                    total.add(&carried);
                    let (own, _) = common.all_parts(whole);
                    (own.deviation[number], own.kick[number]) = (Vector::zeros(), Vector::zeros());
                    let (stored, mut kept) = Kept::of_all(common, whole);
                    stored.opening[number] = (role + 1) as f64;
                    kept.each[KEPT * role + 2] += common.mass[number];
                    kept.carry(role, &carried);
                }
                Change::ComeIn(role) => {
                    let Some(next) = free.pop() else {
                        Kept::of_all(common, whole).1.counts[1] += 1.0;
                        continue;
                    };
                    let carried = self.carry_over(common, number, 1.0, whole);
                    total.add(&carried);
                    let boundary = &self.open.boundaries.all[role];
                    let (own, _) = common.all_parts(whole);
                    let end = own.position[number] - boundary.normal * boundary.length;
                    self.let_in(common, number, next as usize, (role, end), whole);
                    let (stored, mut kept) = Kept::of_all(common, whole);
                    stored.opening[number] = 0.0;
                    kept.each[KEPT * role + 1] += common.mass[number];
                    kept.carry(role, &carried);
                }
            }
        }
        self.even_out(common, whole, &mut free);
        (self.open.free, self.open.changes) = (free, changes);
        total
    }

    /// The particles that wait, the last numbers first.
    pub(super) fn vacant(&mut self, common: &Common<D>, whole: &[f64]) -> Vec<u32> {
        let mut free = std::mem::take(&mut self.open.free);
        free.clear();
        let density = common.all_columns(whole).density.iter().enumerate().rev();
        let vacant = density.filter(|(_, rho)| Common::<D>::is_removed(**rho));
        free.extend(vacant.map(|(number, _)| number as u32));
        free
    }

    /// Sets the velocities of buffers to what is prescribed at a time in s.
    fn prescribe(&self, common: &Common<D>, time: f64, state: &mut [f64]) {
        let (own, _) = common.parts(state);
        for &number in &self.open.members {
            let number = number as usize;
            if let Some((_, boundary)) = self.open.boundary_of(number)
                && let Some(row) = common.row(number)
                && let Some(velocity) = boundary.velocity(&own.position[row], time)
            {
                own.velocity[row] = velocity;
            }
        }
    }

    /// How far beyond a plane the furthest particle of this rank is that has not changed sides, in m.
    fn overshoot(&self, common: &Common<D>, state: &[f64]) -> f64 {
        let (open, at) = (&self.open, common.columns(state));
        let (spacing, begin) = (common.particles.spacing[0], common.first());
        parallel::maximum(common.count(), 0.0, |row| {
            let (place, number) = (&at.position[row], begin + row);
            match open.boundary_of(number) {
                Some((_, boundary)) => {
                    let depth = boundary.plane - place.dot(&boundary.normal);
                    (-depth).max(depth - boundary.length)
                }
                None if common.is_wall[number] => 0.0,
                None => {
                    let entered =
                        open.boundaries.all.iter().filter_map(|it| it.entered(place, spacing));
                    entered.fold(0.0, f64::max)
                }
            }
        })
    }

    /// What changes in an exchange, in the order of numbers.
    fn find_changes(&self, common: &Common<D>, whole: &[f64], changes: &mut Vec<(usize, Change)>) {
        let (open, at) = (&self.open, common.all_columns(whole));
        let spacing = common.particles.spacing[0];
        let change = |number: usize| {
            let place = &at.position[number];
            match open.boundary_of(number) {
                Some((role, boundary)) => {
                    let depth = boundary.plane - place.dot(&boundary.normal);
                    match depth {
                        _ if depth < 0.0 => Some(Change::ComeIn(role)),
                        _ if depth > boundary.length => Some(Change::Leave),
                        _ => None,
                    }
                }
                None if common.is_wall[number] => None,
                None => {
                    let all = &open.boundaries.all;
                    let role = all.iter().position(|it| it.entered(place, spacing).is_some());
                    role.map(Change::GoOut)
                }
            }
        };
        changes.clear();
        let all = 0..open.roles.len();
        changes.extend(all.filter_map(|number| Some((number, change(number)?))));
    }

    /// The energy and the momentum that a particle brings into the fluid, or takes out of it.
    pub(super) fn carry_over(
        &self,
        common: &Common<D>,
        number: usize,
        sign: f64,
        whole: &[f64],
    ) -> Total {
        let (at, mass) = (common.all_columns(whole), sign * common.mass[number]);
        let (velocity, pressure) = (&at.velocity[number], at.pressure[number]);
        let mut total = Total::of(
            0.5 * mass * (velocity.norm_squared() + self.compliance() * pressure * pressure),
        );
        add_moments(&at.position[number], &(velocity * mass), &mut total.force);
        total
    }

    /// Takes a particle of a buffer out: it waits.
    pub(super) fn take_out(&self, common: &Common<D>, number: usize, whole: &mut [f64]) {
        let (own, _) = common.all_parts(whole);
        (own.velocity[number], own.kick[number]) = (Vector::zeros(), Vector::zeros());
        (own.pressure[number], own.density[number]) = (0.0, 0.0);
        let (stored, kept) = Kept::of_all(common, whole);
        stored.opening[number] = 0.0;
        kept.counts[0] += 1.0;
    }

    /// Lets the particle `next` into the buffer of a boundary at a place, as another one is.
    pub(super) fn let_in(
        &self,
        common: &Common<D>,
        like: usize,
        next: usize,
        (role, place): (usize, Vector<D>),
        whole: &mut [f64],
    ) {
        let (own, _) = common.all_parts(whole);
        own.position[next] = place;
        own.velocity[next] = own.velocity[like];
        (own.deviation[next], own.kick[next]) = (Vector::zeros(), Vector::zeros());
        (own.density[next], own.pressure[next]) = (own.density[like], own.pressure[like]);
        let (stored, kept) = Kept::of_all(common, whole);
        kept.counts[0] -= 1.0;
        kept.counts[2] += 1.0;
        stored.opening[next] = (role + 1) as f64;
        stored.birth[next] = kept.counts[2];
    }
}
