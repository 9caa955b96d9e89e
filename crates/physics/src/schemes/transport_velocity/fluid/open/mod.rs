//! Open boundaries, through which fluid enters and leaves, theory (86) to (89).

mod buffers;
mod even;
mod exchange;
mod nested;
mod whole;

use std::sync::Arc;

use exchange::Change;
use nested::FOLLOWS;
pub use nested::{Nesting, Refined};

use super::{Columns, Common, Fluid, LEDGER, Stored, StoredMut, WeaklyCompressible};
use crate::boundaries::{SpaceTime, padded};
use crate::geometry::Shape;
use crate::schemes::Passage;
use crate::schemes::ledger::Total;
use crate::schemes::momentum::MOST_COMPONENTS;
use crate::schemes::transport_velocity::Side;
use crate::{Vector, parallel};

/// What is prescribed of the fluid at an open boundary.
#[derive(Clone)]
pub enum Flow<const D: usize> {
    /// Its velocity in m/s where it is; the pressure is that of the fluid inside.
    Velocity([Arc<dyn SpaceTime>; D]),
    /// Its pressure in Pa where it is; the velocity is that with which it leaves, or enters along the
    /// normal.
    Pressure(Arc<dyn SpaceTime>),
}

/// A plane through which fluid enters and leaves, with a buffer of particles behind it.
#[derive(Clone)]
pub struct OpenBoundary<const D: usize> {
    /// Its name.
    pub name: String,
    /// The number of the body that particles count as while they are in the buffer.
    pub body: u32,
    /// The buffer.
    pub shape: Shape<D>,
    /// Unit normal of the plane, into the fluid.
    pub normal: Vector<D>,
    /// Where the plane is along the normal, in m.
    pub plane: f64,
    /// How far the buffer reaches behind it, in m.
    pub length: f64,
    /// What is prescribed.
    pub flow: Flow<D>,
    /// The time in s within which the mean pressure follows; faster changes are sound, which passes.
    pub relaxation: f64,
}

impl<const D: usize> OpenBoundary<D> {
    /// How far behind the plane a place is in m, if it is in front of or behind the opening and not beside it: by less than
    /// half a spacing in m.
    pub fn depth(&self, place: &Vector<D>, spacing: f64) -> Option<f64> {
        let depth = self.plane - place.dot(&self.normal);
        let middle = place + self.normal * (depth - 0.5 * self.length);
        (self.shape.depth(&middle) > -0.5 * spacing).then_some(depth)
    }

    /// How far a particle of the fluid is in its buffer, in m; not at all in front of the plane.
    fn entered(&self, place: &Vector<D>, spacing: f64) -> Option<f64> {
        let depth = self.plane - place.dot(&self.normal);
        if !(0.0..self.length).contains(&depth) {
            return None;
        }
        self.depth(place, spacing)
    }

    /// The velocity in m/s that is prescribed at a place and a time in s.
    pub fn velocity(&self, place: &Vector<D>, time: f64) -> Option<Vector<D>> {
        match &self.flow {
            Flow::Velocity(velocity) => {
                let place = padded(place);
                Some(Vector::from_fn(|axis, _| velocity[axis].value(place, time)))
            }
            Flow::Pressure(_) => None,
        }
    }

    /// The pressure in Pa that pressures are told from: the prescribed one, or none.
    fn reference(&self, place: &Vector<D>, time: f64) -> f64 {
        match &self.flow {
            Flow::Velocity(_) => 0.0,
            Flow::Pressure(pressure) => pressure.value(padded(place), time),
        }
    }
}

/// The open boundaries of a fluid with the particles that they begin with.
#[derive(Clone, Default)]
pub struct OpenBoundaries<const D: usize> {
    /// All of them.
    pub all: Vec<OpenBoundary<D>>,
    /// In whose buffer each particle is at the start, counted from 1; 0 for others.
    pub buffers: Vec<u32>,
    /// How many particles, the last ones, are not there at the start: they enter when they are needed.
    pub reserve: usize,
    /// How the fluid is nested among others of another resolution, if there are some.
    pub nesting: Option<Nesting<D>>,
}

impl<const D: usize> OpenBoundaries<D> {
    /// Whether no particle ever enters.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty() && self.nesting.is_none()
    }
}

/// What a buffer takes from the fluid in front of it.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    /// By how much the fluid's pressure is above the reference in the mean, in Pa.
    above: f64,
    /// The same, as it has been in the mean of the relaxation time.
    slow: f64,
    /// The same, as late as what buffers take from the fluid is early, theory (88).
    late: f64,
    /// The fluid's velocity along the normal in the mean, in m/s.
    inwards: f64,
    /// The same, as it has been in the mean of the relaxation time.
    stream: f64,
}

impl Mean {
    /// What of the pressure is sound, in Pa.
    fn sound(&self) -> f64 {
        self.above - self.slow
    }

    /// By how much the pressure is ahead of that in the buffer, in Pa.
    fn lead(&self) -> f64 {
        self.above - self.late
    }

    /// By how much the stream has grown faster than it is followed, in m/s.
    fn gain(&self) -> f64 {
        self.inwards - self.stream
    }
}

/// What a particle of a buffer takes from the fluid around it.
#[derive(Clone, Copy, Debug)]
struct Seen<const D: usize> {
    /// Pressure of the fluid there in Pa; nothing without fluid in reach.
    pressure: Option<f64>,
    /// Its velocity along the normal in m/s, with it.
    inwards: f64,
    /// Velocity in m/s with which fluid enters, where the pressure is prescribed and it does.
    entering: Option<Vector<D>>,
}

/// Numbers that a state keeps of all open boundaries: how many particles wait in the reserve, how many could
/// not be born, and how many ever were.
const COUNTS: usize = 3;
/// Numbers that it keeps of each: the slow pressure, the mass in kg that has entered and left, the slow velocity
/// along the normal in m/s, the energy in J and the momentum that particles have brought in, less what they took out, and
/// the late pressure.
const KEPT: usize = 6 + MOST_COMPONENTS;
/// Where the late pressure is.
const LATE_PRESSURE: usize = KEPT - 1;

/// The open boundaries while a run goes.
pub(super) struct Open<const D: usize> {
    boundaries: OpenBoundaries<D>,
    /// In whose buffer particles are, by number, as they were loaded.
    roles: Vec<u32>,
    /// Where the particles of each buffer are at the start.
    sites: Vec<Vec<Vector<D>>>,
    /// The particles of this rank in buffers, by number.
    members: Vec<u32>,
    seen: Vec<Seen<D>>,
    /// Of those of all ranks that see fluid, the boundary, by how much the pressure is above the reference in Pa, and the
    /// velocity along the normal in m/s.
    terms: Vec<[f64; 3]>,
    means: Vec<Mean>,
    /// What the buffers do to the fluid in m/s^2, by place, and the pressure of those that follow other levels.
    forces: Vec<Vector<D>>,
    pulls: Vec<Vector<D>>,
    /// Which part particles have among levels, by number, as they were loaded, and who follows.
    nested: Vec<f64>,
    followers: Vec<u32>,
    /// Who is passive, by number.
    passive: Vec<bool>,
    /// Particles that wait.
    free: Vec<u32>,
    /// What changes in an exchange.
    changes: Vec<(usize, Change)>,
}

impl<const D: usize> Open<D> {
    pub fn none() -> Self {
        Self::new(OpenBoundaries::default(), &[])
    }

    /// Those of particles that are at `places` at the start.
    pub fn new(boundaries: OpenBoundaries<D>, places: &[Vector<D>]) -> Self {
        let all = boundaries.all.len();
        let count = if boundaries.is_empty() { 0 } else { places.len() };
        let pulls = if boundaries.nesting.is_some() { count } else { 0 };
        let in_buffer = |role: usize| {
            let both = boundaries.buffers.iter().zip(places);
            both.filter(move |(buffer, _)| **buffer as usize == role + 1).map(|(_, place)| *place)
        };
        Self {
            sites: (0..all).map(|role| in_buffer(role).collect()).collect(),
            boundaries,
            roles: vec![0; count],
            members: Vec::with_capacity(count),
            seen: Vec::with_capacity(count),
            terms: Vec::with_capacity(count),
            means: vec![Mean::default(); all],
            forces: vec![Vector::zeros(); count],
            pulls: vec![Vector::zeros(); pulls],
            nested: vec![0.0; count],
            followers: Vec::with_capacity(pulls),
            passive: Vec::with_capacity(count),
            free: Vec::with_capacity(count),
            changes: Vec::new(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.boundaries.is_empty()
    }

    /// Those of a rank with these particles. Which are in buffers, and which are not there, it knows of all.
    pub fn part(&self, common: &Common<D>) -> Self {
        let own = |number: &u32| common.row(*number as usize).is_some();
        Self {
            sites: self.sites.clone(),
            boundaries: self.boundaries.clone(),
            roles: self.roles.clone(),
            members: self.members.iter().copied().filter(own).collect(),
            seen: Vec::new(),
            terms: Vec::new(),
            means: self.means.clone(),
            forces: vec![Vector::zeros(); if self.is_empty() { 0 } else { common.count() }],
            pulls: Vec::new(),
            nested: self.nested.clone(),
            followers: Vec::new(),
            passive: self.passive.clone(),
            free: Vec::new(),
            changes: Vec::new(),
        }
    }

    /// Numbers that a state keeps behind those of all matter.
    pub fn kept(&self) -> usize {
        if self.is_empty() { 0 } else { COUNTS + KEPT * self.boundaries.all.len() }
    }

    /// Whether a particle with a part among levels is another level's.
    pub fn hides(&self, nesting: f64) -> bool {
        nesting == FOLLOWS
    }

    /// The body of a particle with a role, if it is in a buffer.
    pub fn body(&self, role: f64) -> Option<u32> {
        let boundary = self.boundaries.all.get((role as usize).checked_sub(1)?)?;
        Some(boundary.body)
    }

    /// The boundary in whose buffer a particle (number) was when it was loaded.
    fn boundary_of(&self, number: usize) -> Option<(usize, &OpenBoundary<D>)> {
        let role = (*self.roles.get(number)? as usize).checked_sub(1)?;
        Some((role, &self.boundaries.all[role]))
    }
}

/// The numbers of open boundaries in a state.
pub(super) struct Kept<'a> {
    counts: &'a mut [f64],
    each: &'a mut [f64],
}

impl<'a> Kept<'a> {
    fn of<const D: usize>(common: &Common<D>, state: &'a mut [f64]) -> (StoredMut<'a, D>, Self) {
        Self::behind(common.parts(state).1, common.count())
    }

    /// Those of a state of the particles of all ranks.
    fn of_all<const D: usize>(
        common: &Common<D>,
        whole: &'a mut [f64],
    ) -> (StoredMut<'a, D>, Self) {
        Self::behind(common.all_parts(whole).1, common.particles.len())
    }

    /// Those behind the columns of all matter.
    fn behind<const D: usize>(rest: &'a mut [f64], count: usize) -> (StoredMut<'a, D>, Self) {
        let (stored, tail) = StoredMut::of(rest, count);
        let (counts, each) = LEDGER.behind_mut(D, tail)[1..].split_at_mut(COUNTS);
        (stored, Self { counts, each })
    }

    /// Adds what a particle has brought in through one of them.
    fn carry(&mut self, role: usize, carried: &Total) {
        let [energy, momentum @ ..] = &mut self.each[KEPT * role + 4..][..1 + MOST_COMPONENTS]
        else {
            return;
        };
        *energy += carried.power;
        momentum.iter_mut().zip(carried.force).for_each(|(own, more)| *own += more);
    }
}

impl<const D: usize> WeaklyCompressible<D> {
    /// Gives it open boundaries.
    pub(super) fn open_up(&mut self, boundaries: OpenBoundaries<D>, common: &mut Common<D>) {
        let count = common.count();
        self.open = Open::new(boundaries, &common.particles.position);
        common.removed = vec![false; count];
        self.shear = vec![Vector::zeros(); count];
        // Where the density does not relax to that of the places, walls are as heavy as the fluid.
        if !common.settings.relaxes() {
            common.fills.fill(false);
        }
        // Those that are not there yet have to be as heavy as those that they follow.
        for number in 0..common.mass.len() {
            if !common.fills(number) {
                common.mass[number] = self.fluid.density * common.particles.volume[number];
            }
        }
    }

    /// Puts particles of a state of the start into buffers and into the reserve.
    pub(super) fn begin_open(&self, common: &Common<D>, state: &mut [f64]) {
        let open = &self.open;
        if open.is_empty() {
            return;
        }
        let (count, reserve) = (common.count(), open.boundaries.reserve);
        let (own, _) = common.parts(state);
        for number in count - reserve..count {
            (own.density[number], own.pressure[number]) = (0.0, 0.0);
            own.velocity[number] = Vector::zeros();
        }
        let (stored, kept) = Kept::of(common, state);
        kept.counts[0] = reserve as f64;
        for kept in kept.each.chunks_exact_mut(KEPT) {
            (kept[0], kept[3], kept[LATE_PRESSURE]) = (f64::NAN, f64::NAN, f64::NAN);
        }
        for (role, buffer) in stored.opening.iter_mut().zip(&open.boundaries.buffers) {
            *role = f64::from(*buffer);
        }
        if let Some(nesting) = &open.boundaries.nesting {
            let (places, fluid) = (&common.particles.position, 0..count - reserve);
            for number in fluid.filter(|&number| !common.is_wall[number]) {
                stored.nesting[number] = nesting.start(&places[number]);
            }
        }
    }

    /// Takes from a state which particles are in buffers, and which are not there.
    pub(super) fn follow_roles(&mut self, common: &mut Common<D>, state: &[f64]) {
        let open = &mut self.open;
        if open.is_empty() {
            return;
        }
        let (at, count) = (common.columns(state), common.count());
        let (team, begin) = (common.team().clone(), common.first());
        let stored = Stored::<D>::of(at.tail, count);
        let each = LEDGER.behind(D, stored.tail)[1 + COUNTS..].chunks_exact(KEPT);
        let both = open.means.iter_mut().zip(each);
        for (mean, kept) in both {
            (mean.slow, mean.stream, mean.late) = (kept[0], kept[3], kept[LATE_PRESSURE]);
        }
        let (roles, nested, removed) = (&open.roles, &open.nested, &common.removed);
        let now = |row: usize| {
            let is_removed = Common::<D>::is_removed(at.density[row]);
            [stored.opening[row], stored.nesting[row], f64::from(u8::from(is_removed))]
        };
        let differs = parallel::maximum(count, 0.0, |row| {
            let number = begin + row;
            let was_removed = f64::from(u8::from(removed[number]));
            let was = [f64::from(roles[number]), nested[number], was_removed];
            f64::from(u8::from(now(row) != was))
        });
        if team.largest([differs]) == [0.0] {
            return;
        }
        // Every rank knows of all particles.
        let told = match team.is_alone() {
            true => Vec::new(),
            false => team.rows_of_all((0..count).map(now).collect()),
        };
        open.members.clear();
        open.followers.clear();
        let mut is_relisted = open.passive.is_empty();
        open.passive.clear();
        for number in 0..open.roles.len() {
            let row = team.own(number, count);
            let known = told.get(number).copied().or_else(|| row.map(now));
            let [role, nesting, is_removed] = known.unwrap_or_default();
            let is_removed = is_removed > 0.0;
            let was_removed = common.removed[number];
            let takes_no_part = open.roles[number] > 0 || open.nested[number] == FOLLOWS;
            let was_wall = common.is_wall[number] && !takes_no_part && !was_removed;
            let is_passive = was_wall || is_removed || role > 0.0;
            is_relisted |= was_removed != is_removed || (open.roles[number] > 0) != (role > 0.0);
            let follows = nesting == FOLLOWS;
            (open.roles[number], common.removed[number]) = (role as u32, is_removed);
            open.nested[number] = nesting;
            common.is_wall[number] = is_passive || follows;
            open.passive.push(is_passive);
            if role > 0.0 && row.is_some() {
                open.members.push(number as u32);
            }
            if follows && row.is_some() {
                open.followers.push(number as u32);
            }
        }
        if is_relisted {
            common.support.exclude(&open.passive, &common.removed);
        }
    }

    /// Keeps the slow pressures of the start.
    pub(super) fn keep_means(&self, common: &Common<D>, state: &mut [f64]) {
        if self.open.is_empty() {
            return;
        }
        let (_, kept) = Kept::of(common, state);
        for (kept, mean) in kept.each.chunks_exact_mut(KEPT).zip(&self.open.means) {
            if kept[0].is_nan() {
                (kept[0], kept[3], kept[LATE_PRESSURE]) = (mean.slow, mean.stream, mean.late);
            }
        }
    }

    /// How many of the particles that are not there in a state have not escaped: they wait.
    pub(super) fn waiting(&self, common: &Common<D>, state: &[f64]) -> f64 {
        self.counts(common, state).map_or(0.0, |counts| counts[0])
    }

    fn counts<'a>(&self, common: &Common<D>, state: &'a [f64]) -> Option<&'a [f64]> {
        let at: Columns<'a, D> = common.columns(state);
        let stored = Stored::<D>::of(at.tail, common.count());
        (!self.open.is_empty()).then(|| &LEDGER.behind(D, stored.tail)[1..])
    }

    /// The mass in kg that has entered and left through all open boundaries up to a state.
    pub(super) fn exchanged(&self, common: &Common<D>, state: &[f64]) -> [f64; 2] {
        let each = self.counts(common, state).map_or(&[][..], |counts| &counts[COUNTS..]);
        let sum = |which: usize| each.iter().skip(which).step_by(KEPT).sum();
        [sum(1), sum(2)]
    }

    /// What has gone through the one that has the number of a body.
    pub(super) fn passed_through(
        &self,
        common: &Common<D>,
        state: &[f64],
        body: u32,
    ) -> Option<Passage> {
        let role = self.open.boundaries.all.iter().position(|it| it.body == body)?;
        let each = &self.counts(common, state)?[COUNTS + KEPT * role..][..KEPT];
        let momentum = std::array::from_fn(|component| each[5 + component]);
        Some(Passage { entered: each[1], left: each[2], energy: each[4], momentum })
    }

    /// How many particles could not be born on the way to a state, as none was left in reserve.
    pub(super) fn missing(&self, common: &Common<D>, state: &[f64]) -> u64 {
        self.counts(common, state).map_or(0, |counts| counts[1] as u64)
    }

    /// Takes note that as many `more` particles wait in a state.
    pub(super) fn add_waiting(&self, common: &Common<D>, more: usize, state: &mut [f64]) {
        if !self.open.is_empty() {
            let counts = Kept::of(common, state).1.counts;
            counts[0] += more as f64;
            counts[1] = 0.0;
        }
    }
}
