//! The passes of hypoelastic solids alone.

use piola_device::{
    Among, Dialect, Gather, Order, Pass, Space, Traced, Use, local, own, spread, through,
};
use piola_formulas::Number;
use piola_formulas::pairs::fluid::Side;
use piola_formulas::pairs::solid::{
    ALONE, ANY, ELASTIC, ForceSum, Forces, MATTER, Moments, ONE, PUSH, RateSum, Rates, SPRINGS,
    SolidTension, Tension, Wall, WallForces, correction,
};
use piola_formulas::pairs::wall::{StressExtrapolation, Surroundings};
use piola_formulas::pairs::{Components, Many, PairLaw as _, Record as _, Square};

use super::super::super::solids::{Moved, Step, cauchy_stress, mirrored};
use super::super::super::{Rates as CommonRates, Solid, SolidRates};
use super::super::passes::{FORCES, drift_terms, flat, if_fluid, side, side_width};
use super::super::walls::{forces, pick, total};
use super::{FIGURES, MATERIAL, SolidPlan};
use crate::schemes::device::{
    Recorded as Vector, are_finite, by_kind, entries, one, square, take, tensor,
};

/// A tensor of numbers that are recorded.
type Matrix<const D: usize> = nalgebra::SMatrix<Traced, D, D>;

/// Numbers of rates: the common ones, the gradient, what is carried, heat.
pub(super) const fn rate_width(dimension: usize) -> usize {
    4 + dimension * dimension + MATTER + 1
}

/// Numbers of the stress that forces gather, with its weight and share.
pub(super) const fn tension_width(dimension: usize) -> usize {
    dimension * dimension + 2
}

/// Takes the material state from the front of some numbers.
fn matter(x: &mut &[Traced]) -> [Traced; MATTER] {
    std::array::from_fn(|_| one(x))
}

/// What forces gather of a particle, of its bulk wave speed and modulus.
fn waves<const D: usize>(x: &mut &[Traced]) -> Tension<Traced, D> {
    let mut tension = SolidTension::<D>::zero();
    (tension.wave_speed, tension.stiffness) = (one(x), one(x));
    tension
}

/// The same with its stress.
fn stressed<const D: usize>(x: &mut &[Traced]) -> Tension<Traced, D> {
    let (tensor, weight, share) = (tensor(x), one(x), one(x));
    Tension { tensor, weight, share, ..waves(x) }
}

impl<const D: usize> SolidPlan<D> {
    /// What is read to tell materials apart.
    fn of_material(&self) -> Option<Use> {
        (self.materials.len() > 1).then_some(through("numbers", "material", 1))
    }

    /// What the material of a particle makes of something.
    fn by_material<const K: usize>(
        &self,
        x: &mut &[Traced],
        of: impl Fn(&Solid) -> [Traced; K],
    ) -> [Traced; K] {
        let material = self.of_material().map(|_| one(x));
        by_kind(self.materials.len(), material, |number| of(&self.materials[number]))
    }

    /// Corrections of gradients.
    pub(super) fn correct(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let columns = [&[own("side", side_width(D))], &*self.plan.of_continua()].concat();
        let writes = [own("correction", D * D)];
        Gather::<Square<D>, _>::new(dialect, "correct", space, Among::Active, Order::Lanes)
            .fold(&columns, &columns, Among::All, |meeting, sums| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let sides = [&mut me, &mut other].map(side::<D>);
                let own = self.plan.owned(space, &mut me, &mut other);
                let [me, other] = sides.map(|side| (side, own));
                Moments::<D>.add(&me, &other, &meeting.pair, sums);
            })
            .close(&[], &[], &writes, |sums, _| entries(&correction(sums)))
    }

    /// Pressures that follow from densities, and squares of speeds.
    pub(super) fn state(&self, dialect: Dialect) -> Pass {
        let of = |name, width| through("numbers", name, width);
        let mut reads = vec![of("wall", 1), own("side", side_width(D)), own("matter", MATTER)];
        // Not from the side, which may be in single precision.
        let exact = [of("density", 1), of("internal_energy", 1), of("pressure", 1)];
        let mut writes = vec![spread("terms", 1)];
        if self.is_algebraic {
            reads.extend(exact);
            writes.extend([own("side", side_width(D)), of("pressure", 1)]);
        }
        reads.extend(self.of_material());
        local(dialect, "state", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let (before, matter): (Side<Traced, D>, _) = (side(&mut x), matter(&mut x));
            let exact = self.is_algebraic.then(|| [one(&mut x), one(&mut x), one(&mut x)]);
            let [speed, pressure] = self.by_material(&mut x, |solid| {
                let mut side = before;
                if let Some([density, energy, _]) = exact {
                    let pressure = solid.state.pressure(density, energy);
                    side.set(side.mass(), side.density, pressure);
                }
                [solid.speed_squared(&side, &matter), side.pressure]
            });
            let mut all = vec![if_fluid(wall, speed, Traced::from(0.0))];
            if let Some([_, _, kept]) = exact {
                let mut after = before;
                after.set(after.mass(), after.density, pressure);
                let both = flat(&after).into_iter().zip(flat(&before));
                all.extend(both.map(|(new, old)| if_fluid(wall, new, old)));
                all.push(if_fluid(wall, pressure, kept));
            }
            all
        })
    }

    /// Sides and stresses of wall particles from the solids around them.
    pub(super) fn walls(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        type Sums<const D: usize> = (Surroundings<D>, Many<6>);
        let (plan, around) = (&self.plan, [own("side", side_width(D)), own("matter", MATTER)]);
        let columns = [&*plan.of_ghosts(), &[own("matter", MATTER)]].concat();
        let (passive, order) = (Among::Passive, Order::Single);
        Gather::<Sums<D>, _>::new(dialect, "walls", space, passive, order)
            .term(&StressExtrapolation::<D>, &around, Among::Active)
            .close(&[], &columns, &around, |(around, stress), mut x| {
                let ghost = plan.ghost(around, &mut x);
                let of_solid = &ghost.of_fluid;
                // What is clamped does not slide in its gradients either.
                let velocity = pick(ghost.slips, &of_solid.velocity, &of_solid.dragged);
                let deviation = pick(ghost.slips, &of_solid.deviation, &-of_solid.carried);
                let side = plan.ghost_side(&ghost, [velocity, deviation], &mut x);
                let mean = stress.map(|stress| stress / around.weight);
                let image = mirrored(&mean, &ghost.normal);
                let mut matter = matter(&mut x);
                for (k, kept) in matter[..6].iter_mut().enumerate() {
                    let seen = Traced::select(ghost.slips, image[k], mean[k]);
                    *kept = Traced::select(ghost.is_wet, seen, stress[k]);
                }
                side.into_iter().chain(matter).collect()
            })
    }

    /// Velocity gradients, and what the deviation carries.
    pub(super) fn rates(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        match self.rate_kind {
            (ALONE, false) => self.rates_of::<ALONE, false>(dialect, space),
            (ALONE, true) => self.rates_of::<ALONE, true>(dialect, space),
            (ELASTIC, false) => self.rates_of::<ELASTIC, false>(dialect, space),
            (ELASTIC, true) => self.rates_of::<ELASTIC, true>(dialect, space),
            (_, false) => self.rates_of::<ANY, false>(dialect, space),
            (_, true) => self.rates_of::<ANY, true>(dialect, space),
        }
    }

    fn rates_of<const KIND: u8, const CARRIES: bool>(
        &self,
        dialect: Dialect,
        space: &Space<D>,
    ) -> Pass {
        let law = Rates::<D, KIND, CARRIES>(self.rate_constants);
        let mut columns = vec![own("side", side_width(D)), own("waves", 2)];
        columns.extend(CARRIES.then_some(own("matter", MATTER)));
        columns.extend(self.plan.of_continua());
        let corrections: Vec<Use> =
            self.corrects.then_some(own("correction", D * D)).into_iter().collect();
        let writes = [own("rate", rate_width(D))];
        Gather::<RateSum<D>, _>::new(dialect, "rates", space, Among::Active, Order::Lanes)
            .fold(&columns, &columns, Among::All, |meeting, sums| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let both = [&mut me, &mut other].map(|x| {
                    let sides = (side::<D>(x), waves::<D>(x));
                    let nothing = [Traced::from(0.0); MATTER];
                    (sides, if CARRIES { matter(x) } else { nothing })
                });
                let own = self.plan.owned(space, &mut me, &mut other);
                let [me, other] = both.map(|(sides, matter)| (sides, (matter, own)));
                law.add(&me, &other, &meeting.pair, sums);
            })
            .close(&[], &corrections, &writes, |sums, mut x| {
                let correction = self.corrects.then(|| tensor::<D>(&mut x));
                let rates =
                    SolidRates::of::<KIND, CARRIES>(sums, correction.as_ref(), &self.counted);
                let common = rates.common;
                let common = [
                    common.divergence,
                    rates.density_transport,
                    common.pressure_transport,
                    common.pressure_diffusion,
                ];
                let rest = entries(&rates.gradient).into_iter().chain(rates.transport);
                common.into_iter().chain(rest).chain([rates.heating]).collect()
            })
    }

    /// Particles move on with their rates, and what that does to energies and momenta.
    pub(super) fn advance(&self, dialect: Dialect) -> Pass {
        let mut reads =
            vec![own("position", D), own("velocity", D), own("deviation", D), own("density", 1)];
        let material = MATERIAL.map(|(name, width)| own(name, width));
        reads.push(own("pressure", 1));
        reads.extend(material);
        reads.extend([
            own("mass", 1),
            own("wall", 1),
            through("slots", "rate", rate_width(D)),
            through("slots", "side", side_width(D)),
        ]);
        reads.extend((self.materials.len() > 1).then_some(own("material", 1)));
        reads.extend(self.plan.of_motion());
        let mut writes = vec![own("position", D), own("density", 1), own("pressure", 1)];
        writes.extend(material);
        writes.push(spread("terms", drift_terms(D)));
        local(dialect, "advance", &["step"], &reads, &writes, |mut x| {
            let step = one(&mut x);
            let (position, velocity): (Vector<D>, Vector<D>) = (take(&mut x), take(&mut x));
            let deviation: Vector<D> = take(&mut x);
            let (density, pressure) = (one(&mut x), one(&mut x));
            let (matter, mass, wall) = (matter(&mut x), one(&mut x), one(&mut x));
            let (divergence, density_transport) = (one(&mut x), one(&mut x));
            let common = CommonRates {
                divergence,
                pressure_transport: one(&mut x),
                pressure_diffusion: one(&mut x),
            };
            let (gradient, transport) = (tensor::<D>(&mut x), self::matter(&mut x));
            let rates =
                SolidRates { common, gradient, density_transport, transport, heating: one(&mut x) };
            let side: Side<Traced, D> = side(&mut x);
            let span = Step { duration: step, mass, evolves: !self.is_algebraic };
            // Density, pressure, material state, and the two works.
            let [after @ .., gained, work] = self.by_material::<{ MATTER + 4 }>(&mut x, |solid| {
                let mut moved = Moved { density, pressure, matter };
                let works = solid.drift(&rates, &side, &span, &mut moved);
                let mut all = [Traced::from(0.0); MATTER + 4];
                [all[0], all[1]] = [moved.density, moved.pressure];
                all[2..][..MATTER].copy_from_slice(&moved.matter);
                all[2 + MATTER..].copy_from_slice(&works);
                all
            });
            let after: [Traced; MATTER + 2] = after;
            let zero = Traced::from(0.0);
            let powers = [gained, zero, -work, zero];
            let terms = self.plan.drift_terms(powers, [&velocity, &deviation], [step, mass]);
            let next = self.plan.moved(&position, &(velocity + deviation), step);
            let before = [density, pressure].into_iter().chain(matter);
            let still = self.plan.carried(&position, step, &mut x);
            let moved = still.iter().copied().zip(next.iter().copied());
            let moved =
                moved.chain(before.zip(after)).chain(terms.into_iter().map(|it| (zero, it)));
            moved.map(|(still, moved)| if_fluid(wall, moved, still)).collect()
        })
    }

    /// Stresses that forces gather.
    pub(super) fn tension(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![own("side", side_width(D)), own("matter", MATTER)];
        if self.corrects {
            reads.extend([through("numbers", "wall", 1), own("correction", D * D)]);
        }
        let writes = [own("tension", tension_width(D))];
        local(dialect, "tension", &[], &reads, &writes, |mut x| {
            let (side, matter): (Side<Traced, D>, _) = (side(&mut x), matter(&mut x));
            // Gradients of walls are not corrected.
            let correction = self.corrects.then(|| {
                let (wall, correction) = (one(&mut x), tensor::<D>(&mut x));
                correction.zip_map(&Matrix::<D>::identity(), |own, unit| if_fluid(wall, own, unit))
            });
            let mut tension = SolidTension::<D>::zero();
            tension.set(&cauchy_stress(side.pressure, &matter), &side, correction.as_ref());
            entries(&tension.tensor).into_iter().chain([tension.weight, tension.share]).collect()
        })
    }

    /// Accelerations between particles, and what shifting needs.
    pub(super) fn forces(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        match self.force_kind {
            (true, ONE) => self.forces_of::<true, ONE>(dialect, space),
            (true, PUSH) => self.forces_of::<true, PUSH>(dialect, space),
            (true, _) => self.forces_of::<true, SPRINGS>(dialect, space),
            (false, ONE) => self.forces_of::<false, ONE>(dialect, space),
            (false, PUSH) => self.forces_of::<false, PUSH>(dialect, space),
            (false, _) => self.forces_of::<false, SPRINGS>(dialect, space),
        }
    }

    fn forces_of<const PLAIN: bool, const CONTACT: u8>(
        &self,
        dialect: Dialect,
        space: &Space<D>,
    ) -> Pass {
        let law = Forces::<D, PLAIN, CONTACT>(self.force_constants);
        let columns =
            [own("side", side_width(D)), own("tension", tension_width(D)), own("waves", 2)];
        let of_bodies = match CONTACT {
            ONE => columns.to_vec(),
            _ => [&columns, &*self.plan.of_continua()].concat(),
        };
        let both = |x: &mut &[Traced]| (side::<D>(x), stressed::<D>(x));
        let gather =
            Gather::<ForceSum<D>, _>::new(dialect, "forces", space, Among::Active, Order::Lanes)
                .fold(&of_bodies, &of_bodies, Among::Active, |meeting, sums| {
                    let (mut me, mut other) = (meeting.me, meeting.other);
                    let sides = [&mut me, &mut other].map(both);
                    let own = match CONTACT {
                        ONE => Traced::from(1.0),
                        _ => self.plan.owned(space, &mut me, &mut other),
                    };
                    let [me, other] = sides.map(|sides| (sides, own));
                    law.add(&me, &other, &meeting.pair, sums);
                });
        let gather = match self.plan.normals {
            0 => gather,
            _ => gather.fold(&columns, &columns, Among::Passive, |meeting, sums| {
                let [me, other] =
                    [meeting.me, meeting.other].map(|mut x| (both(&mut x), Traced::from(1.0)));
                WallForces(law).add(&me, &other, &meeting.pair, sums);
            }),
        };
        let mut mine = vec![own("side", side_width(D)), own("tension", tension_width(D))];
        mine.extend(self.plan.falls.then_some(through("numbers", "gravity", D)));
        gather.close(&[], &mine, &[own("force", FORCES * D)], |sums, mut x| {
            let me: Side<Traced, D> = side(&mut x);
            let (_, _, share) = (tensor::<D>(&mut x), one(&mut x), one(&mut x));
            let nothing = Vector::<D>::repeat(Traced::from(0.0));
            let body_force = if self.plan.falls { take(&mut x) } else { nothing };
            let [stress, walls] = sums.accelerations(share, me.mass(), &self.force_constants);
            let rows = [
                stress,
                nothing,
                sums.artificial,
                nothing,
                walls,
                body_force,
                sums.crowding,
                -sums.volume,
            ];
            rows.iter().flat_map(|row| row.iter().copied()).collect()
        })
    }

    /// What solids do to wall particles.
    pub(super) fn reactions(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let columns =
            [own("side", side_width(D)), own("tension", tension_width(D)), own("waves", 2)];
        let tension = [own("tension", tension_width(D))];
        let writes = [own("force", FORCES * D)];
        Gather::<Components<D>, _>::new(dialect, "reactions", space, Among::Passive, Order::Lanes)
            .fold(&columns, &columns, Among::Active, |meeting, sums| {
                let [me, other] = [meeting.me, meeting.other]
                    .map(|mut x| (side::<D>(&mut x), stressed::<D>(&mut x)));
                Wall::<D>.add(&me, &other, &meeting.pair, sums);
            })
            .close(&[], &tension, &writes, |pull, mut x| {
                let (_, _, share) = (tensor::<D>(&mut x), one(&mut x), one(&mut x));
                let mut all = vec![Traced::from(0.0); FORCES * D];
                all[4 * D..5 * D].copy_from_slice((pull * share).as_slice());
                all
            })
    }

    /// Takes from the accelerations what prescribed velocities do not follow.
    pub(super) fn hold(&self, dialect: Dialect) -> Pass {
        let (reads, writes) =
            ([through("numbers", "held", D), own("force", FORCES * D)], [own("force", FORCES * D)]);
        local(dialect, "hold", &[], &reads, &writes, |mut x| {
            let held: Vector<D> = take(&mut x);
            let mut all = x.to_vec();
            let total = total(&forces::<D>(&mut x));
            for axis in 0..D {
                let walls = &mut all[4 * D + axis];
                *walls = Traced::select(held[axis].above(0.5), *walls - total[axis], *walls);
            }
            all
        })
    }

    /// Squares of speed and acceleration, speeds of waves and signals, less the volume ratio, and whether something is not
    /// finite.
    pub(super) fn look(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![
            own("position", D),
            own("velocity", D),
            own("deviation", D),
            own("kick", D),
            own("density", 1),
            own("pressure", 1),
        ];
        reads.extend(MATERIAL.map(|(name, width)| own(name, width)));
        reads.extend([own("wall", 1), through("slots", "escaped", 1)]);
        reads.extend(self.plan.at_rest.is_none().then_some(own("at_rest", 2)));
        reads.extend((self.materials.len() > 1).then_some(own("material", 1)));
        let writes = [spread("terms", FIGURES)];
        local(dialect, "look", &[], &reads, &writes, |mut x| {
            let is_finite = are_finite(&x[..4 * D + 2 + MATTER]);
            let _: Vector<D> = take(&mut x);
            let velocity: Vector<D> = take(&mut x);
            let _: Vector<D> = take(&mut x);
            let kick: Vector<D> = take(&mut x);
            let (density, _) = (one(&mut x), one(&mut x));
            let [.., energy] = matter(&mut x);
            let (wall, escaped) = (one(&mut x), one(&mut x));
            let [at_rest, _] = self.plan.rest(&mut x);
            let [waves] =
                self.by_material(&mut x, |solid| [solid.longitudinal_speed(density, energy)]);
            let (zero, least) = (Traced::from(0.0), Traced::from(f64::NEG_INFINITY));
            // What is not a number is not seen.
            let seen =
                |value: Traced| Traced::select(is_finite & value.at_most(value), value, least);
            let of_solid = |value: Traced| if_fluid(wall, value, zero);
            let speed = square(&velocity);
            let figures = [
                speed,
                of_solid(waves),
                if_fluid(wall, -(at_rest / density), least),
                zero,
                of_solid(waves + speed.sqrt()),
                of_solid(square(&kick)),
            ];
            let broken = Traced::select(is_finite, least, Traced::from(1.0));
            [broken].into_iter().chain(figures.map(seen)).chain([of_solid(escaped)]).collect()
        })
    }
}
