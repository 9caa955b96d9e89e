//! The passes of a step as text.

use piola_device::{
    Among, Dialect, Gather, Order, Pass, Space, Traced, local, own, spread, through,
};
use piola_formulas::pairs::One;
use piola_formulas::pairs::fluid::{
    FULL, ForceSum, Forces, MIXED, NONE, RateSum, Rates, Side, WallForces,
};
use piola_formulas::pairs::sums::Density;
use piola_formulas::{Number, fluid};

use super::super::fluid::{ACCELERATING, DRIFTING};
use super::Plan;
use super::walls::{forces, total};
use crate::schemes::device::{Recorded as Vector, are_finite, one, square, take};
use crate::schemes::momentum::{moments, momentum_components};

/// Numbers of a side.
pub(super) const fn side_width(dimension: usize) -> usize {
    2 * dimension + 4
}

/// Vectors of [`Forces`](super::super::Forces).
pub(super) const FORCES: usize = 8;

/// Numbers that a look over the state takes of a particle.
pub(super) const FIGURES: usize = 5;

/// The sums of a drift: powers of its mechanisms, then the impulse of those that move across their
/// velocity.
pub(super) fn drift_terms(dimension: usize) -> usize {
    DRIFTING.len() + momentum_components(dimension).len()
}

/// The sums of accelerations: power and growth of each mechanism, and its force if that enters.
pub(super) fn kick_terms(dimension: usize) -> usize {
    let components = momentum_components(dimension).len();
    ACCELERATING.iter().map(|entry| 2 + entry.way.map_or(0, |_| components)).sum()
}

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
    /// The space in which its particles move.
    pub(super) fn space(&self) -> Space<D> {
        Space {
            kernel: self.kernel,
            smoothing_length: self.smoothing_length,
            periods: self.periods.map(|bounds| bounds.map(|[lower, upper]| upper - lower)),
            reach: self.reach,
        }
    }

    /// All passes of the plan.
    pub(super) fn passes(&self, dialect: Dialect) -> Vec<Pass> {
        let space = &self.space();
        let mut all = vec![
            self.load(dialect, space),
            self.state(dialect),
            self.rates(dialect, space),
            self.advance(dialect),
            self.forces(dialect, space),
            self.shift(dialect),
            self.store(dialect),
            self.kick(dialect),
            self.look(dialect),
        ];
        if self.sums_densities {
            all.push(self.densities(dialect, space));
        }
        if self.falls {
            all.push(self.fall(dialect));
        }
        all.extend(self.wall_passes(dialect, space));
        all.extend(self.surface_passes(dialect, space));
        all
    }

    /// Half of the body force of each particle.
    fn fall(&self, dialect: Dialect) -> Pass {
        let (reads, writes) = ([through("numbers", "gravity", D)], [own("half_force", D)]);
        local(dialect, "fall", &[], &reads, &writes, |x| {
            x.iter().map(|component| *component * 0.5).collect()
        })
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
            own("made_at", D),
        ];
        let mut writes = vec![own("place", D), own("side", side_width(D)), spread("terms", 1)];
        let is_single = dialect.is_narrow("side");
        writes.extend(is_single.then(|| space.counts(&[]).0));
        local(dialect, "load", &[], &reads, &writes, |mut x| {
            let position: Vector<D> = take(&mut x);
            let counts = if is_single { space.counts(position.as_slice()).1 } else { Vec::new() };
            let (velocity, deviation) = (take(&mut x), take(&mut x));
            let (density, pressure, mass) = (one(&mut x), one(&mut x), one(&mut x));
            let zero = Traced::from(0.0);
            let mut side: Side<Traced, D> =
                Side { velocity, deviation, density, pressure, load: zero, volume: zero };
            side.set(mass, density, pressure);
            let made_at: Vector<D> = take(&mut x);
            let mut way = zero;
            for axis in 0..D {
                let distance = space.shorter_way(axis, position[axis] - made_at[axis]);
                way += distance * distance;
            }
            let place = position.iter().copied();
            place.chain(flat(&side)).chain([way]).chain(counts).collect()
        })
    }

    /// Densities as sums over masses.
    fn densities(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let columns = [own("side", side_width(D))];
        let centre = self.kernel.value(D, 0.0, self.smoothing_length);
        Gather::<One, _>::new(dialect, "densities", space, Among::Active, Order::Single)
            .start(&columns, |mut x| side::<D>(&mut x).mass() * centre)
            .term(&Density::<D>, &columns, Among::All)
            .close(&[], &[], &[own("summed", 1)], |sum, _| vec![*sum])
    }

    /// Densities and pressures that are functions of places or of each other, and squares of speeds.
    fn state(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![through("numbers", "wall", 1), own("side", side_width(D))];
        reads.extend(self.sums_densities.then_some(own("summed", 1)));
        let writes = [own("side", side_width(D)), spread("terms", 1)];
        local(dialect, "state", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let before: Side<Traced, D> = side(&mut x);
            let density = if self.sums_densities { one(&mut x) } else { before.density };
            let pressure = before.pressure;
            let mut after = before;
            after.set(before.mass(), density, pressure);
            let same = |a: Traced, b: Traced| a.at_most(b) & b.at_most(a);
            let is_same = same(density, before.density) & same(pressure, before.pressure);
            let kept = is_same | !wall.below(0.5);
            let pick = |(old, new): (Traced, Traced)| Traced::select(kept, old, new);
            let speed = if_fluid(wall, square(&before.velocity), Traced::from(0.0));
            flat(&before).into_iter().zip(flat(&after)).map(pick).chain([speed]).collect()
        })
    }

    /// Rates of density and pressure.
    fn rates(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let constants = self.rate_constants;
        let (corrects, moves, falls) = self.rate_kind;
        let columns = [own("side", side_width(D)), own("half_force", D)];
        let gather =
            Gather::<RateSum<D>, _>::new(dialect, "rates", space, Among::Active, Order::Lanes);
        macro_rules! of {
            ($corrects:literal, $moves:literal, $falls:literal) => {{
                let law = Rates::<D, $corrects, $moves, $falls>(constants);
                gather.term(&law, &columns, Among::All)
            }};
        }
        let gather = match (corrects, moves, falls) {
            (true, true, true) => of!(true, true, true),
            (true, true, false) => of!(true, true, false),
            (true, false, true) => of!(true, false, true),
            (true, false, false) => of!(true, false, false),
            (false, true, true) => of!(false, true, true),
            (false, true, false) => of!(false, true, false),
            (false, false, true) => of!(false, false, true),
            (false, false, false) => of!(false, false, false),
        };
        let kept = |is_on: bool, sum| if is_on { sum } else { Traced::from(0.0) };
        gather.close(&[], &[], &[own("rate", 4)], |sums, _| {
            vec![
                sums.divergence,
                kept(self.carries[0], sums.density_transport),
                kept(self.carries[1], sums.pressure_transport),
                sums.pressure_diffusion,
            ]
        })
    }

    /// Particles move on with their rates, and what that does to energies and momenta.
    fn advance(&self, dialect: Dialect) -> Pass {
        let reads = [
            own("position", D),
            own("velocity", D),
            own("deviation", D),
            own("density", 1),
            own("pressure", 1),
            own("mass", 1),
            own("wall", 1),
            through("slots", "rate", 4),
            through("slots", "side", side_width(D)),
        ];
        let writes = [
            own("position", D),
            own("density", 1),
            own("pressure", 1),
            spread("terms", drift_terms(D)),
        ];
        local(dialect, "advance", &["step"], &reads, &writes, |mut x| {
            let step = one(&mut x);
            let (position, velocity): (Vector<D>, Vector<D>) = (take(&mut x), take(&mut x));
            let deviation: Vector<D> = take(&mut x);
            let (density, pressure) = (one(&mut x), one(&mut x));
            let (mass, wall) = (one(&mut x), one(&mut x));
            let rates = [one(&mut x), one(&mut x), one(&mut x), one(&mut x)];
            let [divergence, density_transport, pressure_transport, pressure_diffusion] = rates;
            let before: Side<Traced, D> = side(&mut x);
            let zero = Traced::from(0.0);
            let stiffness = self.fluid.wave_speed.powi(2);
            let exchange = pressure_diffusion / Traced::from(stiffness);
            let density_rate = density_transport - before.density * divergence + exchange;
            let compression = -before.density * stiffness * divergence;
            let pressure_rates = [compression, pressure_transport, pressure_diffusion];
            let pressure_rate = compression + pressure_transport + pressure_diffusion;
            let mut terms = vec![zero; drift_terms(D)];
            let mean = pressure + step * 0.5 * pressure_rate;
            for (term, rate) in terms.iter_mut().zip(pressure_rates) {
                *term = step * mass * self.compliance * mean * rate;
            }
            let momentum = velocity * (step * mass);
            let (turned, count) = moments(&deviation, &momentum);
            terms[DRIFTING.len()..][D..count].copy_from_slice(&turned[D..count]);
            let evolved = |is_on: bool, value: Traced, rate: Traced| match is_on {
                true => value + step * rate,
                false => value,
            };
            let next: Vector<D> = position + (velocity + deviation) * step;
            let next = (0..D).map(|axis| (position[axis], self.wrapped(axis, next[axis])));
            let next = next.chain([
                (density, evolved(self.evolves, density, density_rate)),
                (pressure, evolved(true, pressure, pressure_rate)),
            ]);
            let terms = terms.into_iter().map(|term| (zero, term));
            next.chain(terms).map(|(still, moved)| if_fluid(wall, moved, still)).collect()
        })
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

    /// Accelerations between particles, and what shifting needs.
    fn forces(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let constants = self.force_constants;
        let columns = [own("side", side_width(D))];
        let of_walls = [own("side", side_width(D)), own("shear", D)];
        let gather =
            Gather::<ForceSum<D>, _>::new(dialect, "forces", space, Among::Active, Order::Lanes);
        macro_rules! of {
            ($kind:expr, $artificial:literal, $crowding:literal) => {{
                let law = Forces::<D, { $kind }, $artificial, $crowding>(constants);
                let gather = gather.term(&law, &columns, Among::Active);
                match self.normals {
                    0 => gather,
                    _ => gather.term(&WallForces(law), &of_walls, Among::Passive),
                }
            }};
        }
        let (corrects, artificial, crowding) = self.force_kind;
        let gather = match (corrects, artificial, crowding) {
            (NONE, false, false) => of!(NONE, false, false),
            (NONE, false, true) => of!(NONE, false, true),
            (NONE, true, false) => of!(NONE, true, false),
            (NONE, true, true) => of!(NONE, true, true),
            (FULL, false, false) => of!(FULL, false, false),
            (FULL, false, true) => of!(FULL, false, true),
            (FULL, true, false) => of!(FULL, true, false),
            (FULL, true, true) => of!(FULL, true, true),
            (_, false, false) => of!(MIXED, false, false),
            (_, false, true) => of!(MIXED, false, true),
            (_, true, false) => of!(MIXED, true, false),
            (_, true, true) => of!(MIXED, true, true),
        };
        let mut mine = columns.to_vec();
        mine.extend(self.falls.then_some(through("numbers", "gravity", D)));
        gather.close(&[], &mine, &[own("force", FORCES * D)], |sums, mut x| {
            let me: Side<Traced, D> = side(&mut x);
            let body_force = match self.falls {
                true => take(&mut x),
                false => Vector::<D>::repeat(Traced::from(0.0)),
            };
            let transport = me.velocity * sums.stretch + sums.carried;
            let rows = [
                sums.pressure,
                sums.viscosity,
                sums.artificial_viscosity,
                transport,
                sums.walls,
                body_force,
                sums.crowding,
                -sums.volume,
            ];
            rows.iter().flat_map(|row| row.iter().copied()).collect()
        })
    }

    /// Deviations by SPST.
    fn shift(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            through("numbers", "wall", 1),
            own("force", FORCES * D),
            own("side", side_width(D)),
        ];
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
            let shift = match self.seeks_surfaces {
                true => self.at_surface(crowding, x),
                false => crowding,
            };
            let deviation = fluid::shortened(shift * scale, most);
            for axis in 0..D {
                me.deviation[axis] = if_fluid(wall, deviation[axis], me.deviation[axis]);
            }
            flat(&me)
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

    /// What the passes have found goes into the state, with the powers of all accelerations.
    fn store(&self, dialect: Dialect) -> Pass {
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
            spread("terms", kick_terms(D)),
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
            for (force, entry) in forces.iter().zip(ACCELERATING) {
                terms.extend([mass * force.dot(&velocity), mass * force.dot(&total)]);
                if entry.way.is_some() {
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
            [density, if_fluid(wall, pressure, me.pressure)]
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

    /// Squares of speed and acceleration, less the volume ratio, and whether something is not finite.
    fn look(&self, dialect: Dialect) -> Pass {
        let reads = [
            own("position", D),
            own("velocity", D),
            own("deviation", D),
            own("kick", D),
            own("density", 1),
            own("pressure", 1),
            own("wall", 1),
            through("slots", "escaped", 1),
        ];
        let writes = [spread("terms", FIGURES)];
        local(dialect, "look", &[], &reads, &writes, |mut x| {
            let is_finite = are_finite(&x[..4 * D + 2]);
            let _: Vector<D> = take(&mut x);
            let velocity: Vector<D> = take(&mut x);
            let _: Vector<D> = take(&mut x);
            let kick: Vector<D> = take(&mut x);
            let density = one(&mut x);
            let _ = one(&mut x);
            let wall = one(&mut x);
            let least = Traced::from(f64::NEG_INFINITY);
            let known = |value: Traced| Traced::select(is_finite, value, least);
            let ratio = Traced::from(self.fluid.density) / density;
            vec![
                known(square(&velocity)),
                known(if_fluid(wall, square(&kick), least)),
                known(if_fluid(wall, -ratio, least)),
                Traced::select(is_finite, least, Traced::from(1.0)),
                if_fluid(wall, one(&mut x), Traced::from(0.0)),
            ]
        })
    }
}
