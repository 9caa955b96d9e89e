//! Levels of resolution: which particles of one follow those of another, theory (95), (96).

use super::{Common, Kept, Stored, WeaklyCompressible};
use crate::geometry::Shape;
use crate::parallel::Reduce as _;
use crate::schemes::ledger::Total;
use crate::{Vector, parallel};

/// Values of the column `nesting`: finer particles stand for the particle, too, though it has its own values,
pub(super) const BESIDE: f64 = 1.0;
/// or it follows those of another level, and is not counted.
pub(super) const FOLLOWS: f64 = 2.0;
/// What it would be if it stayed, but it is taken out.
const GONE: f64 = 3.0;

/// How far beyond where it changes its part, in spacings, a particle may be. All that are beyond then do.
const OVERSHOOT: f64 = 0.25;

/// By how much less a band is filled than it is wide, in spacings of the finer level: coarse particles stand for a cube of
/// two spacings, and are split when they are half a spacing beyond the end of the band.
const LATE: f64 = 1.5;

/// Where a level of resolution is finer than the one before.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined<const D: usize> {
    /// The region in which the particles of the finer level are counted.
    pub shape: Shape<D>,
    /// How far outside of it in m particles of the coarser level are split, and how far those of the finer one go.
    pub reach: [f64; 2],
}

/// How a level of resolution is nested among the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nesting<const D: usize> {
    /// Where it is finer than the one before; nothing of the coarsest.
    pub own: Option<Refined<D>>,
    /// Where the next one is finer; nothing of the finest.
    pub finer: Option<Refined<D>>,
}

impl<const D: usize> Nesting<D> {
    /// Whether a particle that starts at a place is counted.
    pub fn counts(&self, place: &Vector<D>) -> bool {
        self.start(place) != FOLLOWS
    }

    /// The value of `nesting` at the start.
    pub(super) fn start(&self, place: &Vector<D>) -> f64 {
        let (next, _) = self.next(0.0, place);
        if next == GONE { FOLLOWS } else { next }
    }

    /// Whether a place is so near to where levels meet that a particle there has neighbours which follow.
    fn is_near(&self, place: &Vector<D>, support: f64) -> bool {
        // Some follow a little longer than they should.
        let support = 1.2 * support;
        let meets = |it: &Refined<D>, sign: f64| sign * it.shape.depth(place) < support;
        self.own.as_ref().is_some_and(|it| meets(it, 1.0))
            || self.finer.as_ref().is_some_and(|it| meets(it, -1.0))
    }

    /// What becomes of a particle at a place, and how far it is beyond where that changes, in m.
    fn next(&self, now: f64, place: &Vector<D>) -> (f64, f64) {
        let was = |part: f64, beyond: f64| if now == part { 0.0 } else { beyond };
        let mut entered = None;
        if let Some(Refined { shape, reach: [_, end] }) = &self.own {
            let depth = shape.depth(place);
            if depth < -end {
                return (GONE, -depth - end);
            }
            if depth <= 0.0 {
                return (FOLLOWS, was(FOLLOWS, -depth));
            }
            entered = Some(depth);
        }
        let left = |beyond: f64| if now == FOLLOWS { entered.unwrap_or(beyond) } else { 0.0 };
        let Some(Refined { shape, reach: [begin, end] }) = &self.finer else {
            return (0.0, left(0.0));
        };
        match shape.depth(place) {
            depth if depth > 0.0 => (FOLLOWS, was(FOLLOWS, depth)),
            depth if now == FOLLOWS && depth > -end => (BESIDE, -depth),
            depth if depth > -begin => (BESIDE, was(BESIDE, depth + begin)),
            depth if depth > -end => (now, 0.0),
            depth if now == BESIDE => (0.0, -depth - end),
            depth => (0.0, left(-depth)),
        }
    }

    /// Whether finer particles stand for one at a place, too.
    fn is_beside(&self, place: &Vector<D>) -> bool {
        self.finer.as_ref().is_some_and(|it| it.shape.depth(place) > -it.reach[0])
    }
}

/// A particle in whose place finer ones are born.
#[derive(Clone, Copy, Debug)]
pub(in crate::schemes::transport_velocity) struct Parent<const D: usize> {
    position: Vector<D>,
    velocity: Vector<D>,
    density: f64,
    pressure: f64,
}

impl<const D: usize> WeaklyCompressible<D> {
    /// The numbers of the particles that follow those of other levels, as they were loaded.
    pub(in crate::schemes::transport_velocity) fn followers(&self) -> &[u32] {
        &self.open.followers
    }

    /// How levels are nested, if there are several.
    pub(in crate::schemes::transport_velocity) fn nesting(&self) -> Option<&Nesting<D>> {
        self.open.boundaries.nesting.as_ref()
    }

    /// Lets particles change their part that have moved from one level to another: those that begin to follow leave the
    /// fluid, those that end to do so come into it, and those too far out are taken out. Returns what has left and
    /// come in, and the particles in whose place finer ones are to be born.
    pub(in crate::schemes::transport_velocity) fn regroup(
        &mut self,
        common: &mut Common<D>,
        state: &mut [f64],
    ) -> (Total, Vec<Parent<D>>) {
        let (mut total, mut parents) = (Total::default(), Vec::new());
        self.follow_roles(common, state);
        let Some(nesting) = self.open.boundaries.nesting.take() else { return (total, parents) };
        let count = common.count();
        let at = common.columns(state);
        let stored = Stored::<D>::of(at.tail, count);
        let next = |number: usize| {
            let now = stored.nesting[number];
            let is_fixed = common.is_wall[number] && now != FOLLOWS;
            (!is_fixed).then(|| nesting.next(now, &at.position[number]))
        };
        let beyond = parallel::maximum(count, 0.0, |number| next(number).map_or(0.0, |it| it.1));
        if beyond >= OVERSHOOT * common.particles.spacing[0] {
            let changes = (0..count).filter_map(|number| Some((number, next(number)?.0)));
            let changes: Vec<_> =
                changes.filter(|(number, next)| stored.nesting[*number] != *next).collect();
            for (number, next) in changes {
                let now = Kept::of(common, state).0.nesting[number];
                if now != FOLLOWS && next >= FOLLOWS {
                    total.add(&self.carry_over(common, number, -1.0, state));
                }
                let (own, _) = common.parts(state);
                if now == 0.0 && nesting.is_beside(&own.position[number]) {
                    parents.push(Parent {
                        position: own.position[number],
                        velocity: own.velocity[number],
                        density: own.density[number],
                        pressure: own.pressure[number],
                    });
                }
                if now == FOLLOWS && next < FOLLOWS {
                    total.add(&self.carry_over(common, number, 1.0, state));
                }
                Kept::of(common, state).0.nesting[number] = if next == GONE { 0.0 } else { next };
                if next == GONE {
                    self.take_out(common, number, state);
                }
            }
        }
        self.open.boundaries.nesting = Some(nesting);
        (total, parents)
    }

    /// Lets the particles that stand for coarser ones be born: 2^D each, a quarter of the coarse spacing from its middle along
    /// each axis.
    pub(in crate::schemes::transport_velocity) fn bear_finer(
        &mut self,
        common: &mut Common<D>,
        parents: &[Parent<D>],
        state: &mut [f64],
    ) {
        if !parents.is_empty() {
            let mut free = self.vacant(common, state);
            let reach = 0.5 * common.particles.spacing[0];
            let domain = *common.support.list().domain();
            for parent in parents {
                for corner in 0..1_usize << D {
                    let side = |axis: usize| if corner >> axis & 1 == 0 { -reach } else { reach };
                    let Some(next) = free.pop().map(|next| next as usize) else {
                        Kept::of(common, state).1.counts[1] += 1.0;
                        continue;
                    };
                    let (own, _) = common.parts(state);
                    let place = parent.position + Vector::from_fn(|axis, _| side(axis));
                    own.position[next] = domain.wrap(&place);
                    own.velocity[next] = parent.velocity;
                    (own.deviation[next], own.kick[next]) = (Vector::zeros(), Vector::zeros());
                    (own.density[next], own.pressure[next]) = (parent.density, parent.pressure);
                    let (stored, kept) = Kept::of(common, state);
                    kept.counts[0] -= 1.0;
                    kept.counts[2] += 1.0;
                    (stored.nesting[next], stored.birth[next]) = (FOLLOWS, kept.counts[2]);
                }
            }
            self.open.free = free;
        }
        self.follow_roles(common, state);
    }

    /// The mass in kg of the fluid that is counted in a state, and how many particles it is.
    pub(in crate::schemes::transport_velocity) fn counted(
        &self,
        common: &Common<D>,
        state: &[f64],
    ) -> [f64; 2] {
        let at = common.columns(state);
        let Stored { nesting, opening, .. } = Stored::<D>::of(at.tail, common.count());
        let counted = (0..common.count() as u32).filter(|&number| {
            let a = number as usize;
            let is_there = nesting[a] != FOLLOWS
                && opening[a] == 0.0
                && !Common::<D>::is_removed(at.density[a]);
            is_there && common.wall_of(number).is_none()
        });
        counted.fold([0.0; 2], |[mass, count], a| [mass + common.mass[a as usize], count + 1.0])
    }

    /// Moves the particles that follow others for a `step` in s.
    pub(super) fn move_followers(&self, common: &Common<D>, step: f64, state: &mut [f64]) {
        let (own, _) = common.parts(state);
        for &number in &self.open.followers {
            let number = number as usize;
            let velocity = own.velocity[number] + own.deviation[number];
            common.advect(step, &mut own.position[number], velocity);
        }
    }

    /// Keeps the deviations of the particles that follow others, but for those that have no neighbours further out.
    pub(super) fn keep_followers(&self, common: &Common<D>, state: &mut [f64]) {
        let Some(nesting) = self.nesting() else { return };
        let list = common.support.list();
        // What is split a little late leaves out a part of the outermost layer.
        let needed = list.support() + LATE * common.particles.spacing[0];
        let (own, _) = common.parts(state);
        for &number in &self.open.followers {
            let number = number as usize;
            let is_outer = nesting
                .own
                .as_ref()
                .is_some_and(|it| it.shape.depth(&own.position[number]) < needed - it.reach[0]);
            own.deviation[number] = match is_outer {
                true => Vector::zeros(),
                false => common.sides[list.places()[number] as usize].deviation,
            };
        }
    }

    /// Whether the particle at a place has neighbours that follow others.
    pub(super) fn meets_followers(&self, position: &Vector<D>, support: f64) -> bool {
        self.nesting().is_some_and(|nesting| nesting.is_near(position, support))
    }

    /// Whether a particle (number) follows others.
    pub(in crate::schemes::transport_velocity) fn is_follower(&self, number: u32) -> bool {
        self.open.nested.get(number as usize).is_some_and(|nested| *nested == FOLLOWS)
    }
}
