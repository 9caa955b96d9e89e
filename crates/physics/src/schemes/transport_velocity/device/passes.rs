//! The passes that all kinds of matter share, as text.

use piola_device::{
    Among, Dialect, Gather, Order, Pass, Precision, Space, Traced, Use, difference, local, own,
    spread, through,
};
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::fluid::Side;
use piola_formulas::pairs::sums::Background;
use piola_formulas::pairs::{Components, PairLaw};
use piola_formulas::{Number, fluid};

use super::super::escape::Room;
use super::super::ledger::DRIFTING;
use super::super::{AtRest, Continuum};
use super::walls::{forces, total};
use crate::schemes::device::{Recorded as Vector, one, square, take};
use crate::schemes::ledger::Entry;
use crate::schemes::momentum::{moments, momentum_components};

/// What the passes of all matter depend on.
pub(in super::super) struct Plan<const D: usize> {
    pub kernel: Kernel,
    pub smoothing_length: f64,
    pub periods: [Option<[f64; 2]>; D],
    /// What lists reach, in m.
    pub reach: f64,
    /// The matter at rest, if it is the same of all bodies; otherwise it is a column.
    pub at_rest: Option<AtRest>,
    /// Whether densities are sums over masses.
    pub sums_densities: bool,
    /// What the pressures of a fluid follow from with its densities, where they do.
    pub by_law: Option<AtRest>,
    /// The largest background pressure over `rho_0 c^2`, if such pressures set deviations.
    pub background: Option<f64>,
    /// Whether SPST sets deviations.
    pub shifts: bool,
    /// Whether some particles have no deviations.
    pub spares: bool,
    /// `1 / W(dx)` in m^D.
    pub crowding: f64,
    /// Whether free surfaces are looked for, and particles are shifted along them.
    pub seeks_surfaces: bool,
    pub along_surfaces: bool,
    /// Less than half of it is few neighbours.
    pub even_count: f64,
    /// Whether there are body forces.
    pub falls: bool,
    /// Most normals of a wall particle; 0 without walls.
    pub normals: usize,
    /// Whether walls move.
    pub moves: bool,
    pub spacing: f64,
    /// Where particles may be, if anybody asks, and whether those that are elsewhere are taken out.
    pub room: Option<Room<D>>,
    pub removes: bool,
    /// Whether there are several continua, and how far apart in m particles of one may have begun, if that matters.
    pub are_several: bool,
    pub farthest: Option<f64>,
    /// Columns by number of which neighbours see copies, and the columns of these by slot.
    pub copied: Vec<Use>,
    pub copies: Vec<Use>,
}

/// Numbers of a side.
pub(super) const fn side_width(dimension: usize) -> usize {
    2 * dimension + 4
}

/// Vectors of [`Forces`](super::super::Forces).
pub(super) const FORCES: usize = 8;

/// The sums of a drift: powers of its mechanisms, then the impulse of those that move across their
/// velocity.
pub(super) fn drift_terms(dimension: usize) -> usize {
    DRIFTING + momentum_components(dimension).len()
}

/// The sums of accelerations: power and growth of each mechanism, and its force if that enters.
fn kick_terms<const D: usize, M: Continuum<D>>() -> usize {
    let components = momentum_components(D).len();
    let enters = |entry: &Option<Entry>| entry.is_some_and(|entry| entry.way.is_some());
    M::ACCELERATING.iter().map(|entry| 2 + if enters(entry) { components } else { 0 }).sum()
}

/// The continuum of walls, by which all have them.
pub(super) const WALL: f64 = -1.0;

/// Takes a side from the front.
pub(super) fn side<const D: usize>(numbers: &mut &[Traced]) -> Side<Traced, D> {
    Side {
        velocity: take(numbers),
        deviation: take(numbers),
        density: one(numbers),
        volume: one(numbers),
        load: one(numbers),
        pressure: one(numbers),
    }
}

/// The numbers of a side.
pub(super) fn flat<const D: usize>(side: &Side<Traced, D>) -> Vec<Traced> {
    let scalars = [side.density, side.volume, side.load, side.pressure];
    side.velocity.iter().chain(&side.deviation).copied().chain(scalars).collect()
}

/// `yes` for particles of the fluid, `no` for those that are passive.
pub(super) fn if_fluid(wall: Traced, yes: Traced, no: Traced) -> Traced {
    Traced::select(wall.below(0.5), yes, no)
}

impl<const D: usize> Plan<D> {
    /// The space in which particles move.
    pub(super) fn space(&self) -> Space<D> {
        Space {
            kernel: self.kernel,
            smoothing_length: self.smoothing_length,
            periods: self.periods.map(|bounds| bounds.map(|[lower, upper]| upper - lower)),
            reach: self.reach,
        }
    }

    /// The passes that all matter has, of the kind `M`.
    pub(super) fn passes<M: Continuum<D>>(&self, dialect: Dialect, space: &Space<D>) -> Vec<Pass> {
        let mut all = vec![
            self.load(dialect, space),
            self.shift(dialect),
            self.store::<M>(dialect),
            self.kick(dialect),
        ];
        all.extend(self.wall_passes(dialect, space));
        if self.moves {
            all.extend([self.drive(dialect), self.impose(dialect)]);
        }
        all.extend(self.surface_passes(dialect, space));
        if let Some(most) = self.background {
            all.extend([self.push(dialect, space, most), self.push_sides(dialect)]);
            all.push(self.push_on(dialect));
        }
        all
    }

    /// Density in kg/m^3 and wave speed in m/s at rest, as a column.
    pub(super) fn of_rest(&self) -> Option<Use> {
        self.at_rest.is_none().then_some(through("numbers", "at_rest", 2))
    }

    /// Takes them from the front of the numbers of that column.
    pub(super) fn rest(&self, x: &mut &[Traced]) -> [Traced; 2] {
        match self.at_rest {
            Some(AtRest { density, wave_speed }) => [density, wave_speed].map(Traced::from),
            None => [one(x), one(x)],
        }
    }

    /// What tells of which continuum a particle is, as columns.
    pub(super) fn of_continua(&self) -> Vec<Use> {
        let start = self.farthest.map(|_| difference("start", D));
        self.are_several.then_some(own("continuum", 1)).into_iter().chain(start).collect()
    }

    /// Takes from the front of the numbers of these columns of a particle and of its neighbour 1 where that is of the
    /// continuum of the particle, or of a wall, and 0 otherwise, as [`Continua::is_own`](super::super::Continua::is_own).
    pub(super) fn owned(
        &self,
        space: &Space<D>,
        me: &mut &[Traced],
        other: &mut &[Traced],
    ) -> Traced {
        let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
        if !self.are_several {
            return yes;
        }
        let [mine, its] = [one(me), one(other)];
        let mut is_same = mine.at_most(its) & its.at_most(mine);
        if let Some(farthest) = self.farthest {
            let [here, there]: [Vector<D>; 2] = [take(me), take(other)];
            let way =
                Vector::<D>::from_fn(|axis, _| space.shorter_way(axis, there[axis] - here[axis]));
            is_same = is_same & square(&way).at_most(Traced::from(farthest * farthest));
        }
        Traced::select(its.below(WALL + 0.5) | is_same, yes, no)
    }

    /// Sides and places by slot, and how far particles are from where the list was made.
    fn load(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let of = |column, width| through("numbers", column, width);
        let reads = [
            of("position", D),
            of("velocity", D),
            of("deviation", D),
            of("density", 1),
            of("pressure", 1),
            of("mass", 1),
            of("wall", 1),
            own("made_at", D),
        ];
        let reads = [&reads, &*self.copied].concat();
        let is_single = dialect.of_pairs() == Precision::Single;
        let counts = is_single.then(|| space.counts());
        let writes = [own("place", D), own("side", side_width(D)), spread("terms", 1)];
        let writes = [&writes, counts.as_slice(), &*self.copies].concat();
        local(dialect, "load", &[], &reads, &writes, |mut x| {
            let position: Vector<D> = take(&mut x);
            let counts = match is_single {
                true => space.counted(position.as_slice()),
                false => Vec::new(),
            };
            let (velocity, deviation) = (take(&mut x), take(&mut x));
            let (density, pressure) = (one(&mut x), one(&mut x));
            let (amount, wall) = (one(&mut x), one(&mut x));
            let zero = Traced::from(0.0);
            let mut side: Side<Traced, D> =
                Side { velocity, deviation, density, pressure, load: zero, volume: zero };
            side.set(if_fluid(wall, amount, amount * density), density, pressure);
            let made_at: Vector<D> = take(&mut x);
            let mut way = zero;
            for axis in 0..D {
                let distance = space.shorter_way(axis, position[axis] - made_at[axis]);
                way += distance * distance;
            }
            position
                .iter()
                .copied()
                .chain(flat(&side))
                .chain([way])
                .chain(counts)
                .chain(x.iter().copied())
                .collect()
        })
    }

    /// Terms of a drift of `step` s with the powers of its mechanisms in J: what moves across its velocity turns, as
    /// [`Common::add_turning`](super::super::Common::add_turning).
    pub(super) fn drift_terms(
        &self,
        powers: [Traced; DRIFTING],
        [velocity, deviation]: [&Vector<D>; 2],
        [step, mass]: [Traced; 2],
    ) -> Vec<Traced> {
        let mut terms = vec![Traced::from(0.0); drift_terms(D)];
        terms[..DRIFTING].copy_from_slice(&powers);
        let (turned, count) = moments(deviation, &(velocity * (step * mass)));
        terms[DRIFTING..][D..count].copy_from_slice(&turned[D..count]);
        terms
    }

    /// Where a particle is after a `step` in s.
    pub(super) fn moved(
        &self,
        position: &Vector<D>,
        velocity: &Vector<D>,
        step: Traced,
    ) -> Vector<D> {
        let next = position + velocity * step;
        Vector::from_fn(|axis, _| self.wrapped(axis, next[axis]))
    }

    /// A coordinate inside the bounds of its axis, of a particle that moves by less than a period.
    fn wrapped(&self, axis: usize, x: Traced) -> Traced {
        let Some([lower, upper]) = self.periods[axis] else { return x };
        let (way, period) = (x - lower, Traced::from(upper - lower));
        let below = way.below(0.0);
        let inside = Traced::select(below, way + period, way - period) + lower;
        let inside = Traced::select(inside.below(upper), inside, Traced::from(lower));
        let is_inside = Traced::from(lower).at_most(x) & x.below(upper);
        Traced::select(is_inside, x, inside)
    }

    /// Deviations by SPST.
    fn shift(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            through("numbers", "wall", 1),
            own("force", FORCES * D),
            own("side", side_width(D)),
        ];
        reads.extend(self.spares.then_some(through("numbers", "unshifted", 1)));
        if self.seeks_surfaces {
            let of_surfaces =
                [own("reach", 1), own("surface", 1), own("normal", D), own("crowd", D)];
            reads.extend(of_surfaces);
        }
        let writes = [own("side", side_width(D))];
        local(dialect, "shift", &["scale", "most"], &reads, &writes, |mut x| {
            let (scale, most, wall) = (one(&mut x), one(&mut x), one(&mut x));
            let crowding = forces::<D>(&mut x)[6];
            let mut me: Side<Traced, D> = side(&mut x);
            let is_spared = self.spares.then(|| one(&mut x).above(0.5));
            let shift = match self.seeks_surfaces {
                true => self.at_surface(crowding, x),
                false => crowding,
            };
            let mut deviation = fluid::shortened(shift * scale, most);
            if let Some(is_spared) = is_spared {
                deviation =
                    deviation.map(|part| Traced::select(is_spared, Traced::from(0.0), part));
            }
            for axis in 0..D {
                me.deviation[axis] = if_fluid(wall, deviation[axis], me.deviation[axis]);
            }
            flat(&me)
        })
    }

    /// Deviations by background pressures, as [`Common::push_apart`](super::super::Common::push_apart).
    fn push(&self, dialect: Dialect, space: &Space<D>, most: f64) -> Pass {
        let columns = [&[own("side", side_width(D))], &*self.of_continua()].concat();
        let spared = self.spares.then_some(through("numbers", "unshifted", 1));
        let rest = self.of_rest().into_iter();
        let read: Vec<Use> = [columns[0]].into_iter().chain(rest).chain(spared).collect();
        let law = Background::<D>::of(self.kernel, self.smoothing_length);
        let (among, order) = (Among::Active, Order::Single);
        Gather::<Components<D>, _>::new(dialect, "push", space, among, order)
            .fold(&columns, &columns, Among::All, |meeting, sum| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let sides = [&mut me, &mut other].map(side::<D>);
                let own = self.owned(space, &mut me, &mut other);
                let [me, other] = sides.map(|side| (side, own));
                law.add(&me, &other, &meeting.pair, sum);
            })
            .close(&["step"], &read, &[own("push", D)], |sum, mut x| {
                let step = one(&mut x);
                let me: Side<Traced, D> = side(&mut x);
                let scale = Background::scale(&me, most, self.rest(&mut x));
                let zero = Traced::from(0.0);
                let spared = if self.spares { one(&mut x) } else { zero };
                let is_pushed = me.pressure.abs().above(0.0) & spared.below(0.5);
                let pushed = |part: &Traced| *part * scale * (step * 0.5);
                sum.iter().map(|part| Traced::select(is_pushed, pushed(part), zero)).collect()
            })
    }

    /// These deviations go into the sides.
    fn push_sides(&self, dialect: Dialect) -> Pass {
        let reads = [through("numbers", "wall", 1), own("side", side_width(D)), own("push", D)];
        let writes = [own("side", side_width(D))];
        local(dialect, "push_sides", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let mut me: Side<Traced, D> = side(&mut x);
            me.deviation = take::<D>(&mut x).map(|part| if_fluid(wall, part, Traced::from(0.0)));
            flat(&me)
        })
    }

    /// And into the state.
    fn push_on(&self, dialect: Dialect) -> Pass {
        let reads = [own("wall", 1), through("slots", "push", D)];
        local(dialect, "push_on", &[], &reads, &[own("deviation", D)], |mut x| {
            let wall = one(&mut x);
            x.iter().map(|part| if_fluid(wall, *part, Traced::from(0.0))).collect()
        })
    }

    /// The shift of a particle that may be at a free surface.
    fn at_surface(&self, crowding: Vector<D>, mut x: &[Traced]) -> Vector<D> {
        let (reach, surface) = (one(&mut x), one(&mut x));
        let normal: Vector<D> = take(&mut x);
        let within: Vector<D> = take(&mut x);
        let is_close = reach.below(self.smoothing_length);
        let along = |shift: Vector<D>| shift - normal * shift.dot(&normal);
        let (shift, is_still) = match self.along_surfaces {
            true => (along(crowding), reach.below(f64::NEG_INFINITY)),
            false => (along(within), surface.above(0.5)),
        };
        Vector::from_fn(|axis, _| {
            let shift = Traced::select(is_close, shift[axis], crowding[axis]);
            Traced::select(is_still, Traced::from(0.0), shift)
        })
    }

    /// Sums of accelerations, and energies of compression before and after pressures that follow from densities change.
    pub(super) fn stored_terms<M: Continuum<D>>(&self) -> usize {
        kick_terms::<D, M>() + if self.by_law.is_some() { 2 } else { 0 }
    }

    /// What the passes have found goes into the state, with the powers of all accelerations.
    fn store<M: Continuum<D>>(&self, dialect: Dialect) -> Pass {
        let reads = [
            own("position", D),
            own("velocity", D),
            own("deviation", D),
            own("density", 1),
            own("pressure", 1),
            own("mass", 1),
            own("wall", 1),
            through("slots", "force", FORCES * D),
            through("slots", "side", side_width(D)),
        ];
        let writes = [
            own("density", 1),
            own("pressure", 1),
            own("kick", D),
            own("deviation", D),
            spread("terms", self.stored_terms::<M>()),
        ];
        local(dialect, "store", &[], &reads, &writes, |mut x| {
            let (position, velocity): (Vector<D>, Vector<D>) = (take(&mut x), take(&mut x));
            let deviation: Vector<D> = take(&mut x);
            let (density, pressure) = (one(&mut x), one(&mut x));
            let (mass, wall) = (one(&mut x), one(&mut x));
            let forces = forces::<D>(&mut x);
            let me: Side<Traced, D> = side(&mut x);
            let zero = Traced::from(0.0);
            let total = total(&forces);
            let mut terms = Vec::new();
            for (force, entry) in forces.iter().zip(M::ACCELERATING) {
                terms.extend([mass * force.dot(&velocity), mass * force.dot(&total)]);
                if entry.is_some_and(|entry| entry.way.is_some()) {
                    let (all, count) = moments(&position, &(force * mass));
                    terms.extend_from_slice(&all[..count]);
                }
            }
            let kept = |axis: usize| match self.shifts {
                true => if_fluid(wall, me.deviation[axis], deviation[axis]),
                false => deviation[axis],
            };
            // Sides may be in single precision: what has not changed since they were filled is kept.
            let density = match self.sums_densities {
                true => me.density,
                false => if_fluid(wall, density, me.density),
            };
            let pressure = match self.by_law {
                None => if_fluid(wall, pressure, me.pressure),
                // Not that of the side, which may be in single precision.
                Some(rest) => {
                    let now = fluid::pressure(density, rest.density, rest.wave_speed);
                    let now = if_fluid(wall, now, me.pressure);
                    let energy = |p: Traced| mass * 0.5 * rest.compliance() * p * p;
                    terms.extend([energy(pressure), energy(now)]);
                    now
                }
            };
            [density, pressure]
                .into_iter()
                .chain(total.iter().copied())
                .chain((0..D).map(kept))
                .chain(terms.into_iter().map(|term| if_fluid(wall, term, zero)))
                .collect()
        })
    }

    /// Velocities change by accelerations.
    fn kick(&self, dialect: Dialect) -> Pass {
        let reads = [own("velocity", D), own("kick", D), own("wall", 1)];
        let writes = [own("velocity", D)];
        local(dialect, "kick_velocities", &["duration"], &reads, &writes, |mut x| {
            let duration = one(&mut x);
            let (velocity, kick): (Vector<D>, Vector<D>) = (take(&mut x), take(&mut x));
            let wall = one(&mut x);
            let next = |axis: usize| velocity[axis] + kick[axis] * duration;
            (0..D).map(|axis| if_fluid(wall, next(axis), velocity[axis])).collect()
        })
    }
}
