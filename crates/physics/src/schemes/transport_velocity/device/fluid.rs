//! A fluid on a device.

use piola_device::{
    Among, DeviceError, Dialect, Gather, Machine, Order, Pass, Space, Traced, local, own, spread,
    through,
};
use piola_formulas::pairs::fluid::{
    FULL, ForceConstants, ForceSum, Forces, NONE, RateConstants, RateSum, Rates, STRESS, Side,
    Wall, WallForces,
};
use piola_formulas::pairs::sums::Density;
use piola_formulas::pairs::wall::{Extrapolation, Surroundings};
use piola_formulas::pairs::{Components, One};
use piola_formulas::{Number, fluid};

use super::super::fluid::Ends;
use super::super::inspect::step_limits;
use super::super::stages::Pass as Stage;
use super::super::{Continuum as _, DensityRule, Fluid, TransportVelocity, WeaklyCompressible};
use super::passes::{FORCES, Plan, drift_terms, flat, if_fluid, side, side_width};
use super::walls::pick;
use super::{OfMatter, STATE};
use crate::schemes::device::{Recorded as Vector, Room, are_finite, one, square, take};
use crate::schemes::look::Most;
use crate::schemes::{DeviceRefusal, Health, StepLimit};

/// Numbers that a look over the state takes of a particle.
const FIGURES: usize = 5;

/// What the passes of a fluid depend on.
pub(in super::super) struct FluidPlan<const D: usize> {
    plan: Plan<D>,
    fluid: Fluid,
    /// Whether densities follow from pressures.
    follows: bool,
    rate_constants: RateConstants,
    rate_kind: (bool, bool, bool),
    force_constants: ForceConstants,
    force_kind: (u8, bool, bool),
    compliance: f64,
    /// The rate in m^2/s^3 at which pressures relax, if they do, and one over what the kernel sums to over a lattice.
    relaxation: Option<[f64; 2]>,
}

impl<const D: usize> OfMatter<D> for FluidPlan<D> {
    type Kind = WeaklyCompressible<D>;

    const STATE: &'static [[&'static str; 2]] = &{
        let [a, b, c, d, e, f] = STATE;
        [a, b, c, d, e, f, ["excess", "excess_before"]]
    };
    const FIGURES: usize = FIGURES;

    fn of(system: &TransportVelocity<D>) -> Result<Self, DeviceRefusal> {
        let (common, matter) = (&system.common, &system.matter);
        let refuse = |what: &str, instead| Err(DeviceRefusal::Stage { what: what.into(), instead });
        if common.settings.is_algebraic() {
            let instead = "use `scheme.pressure = \"edac\"`";
            return refuse("a pressure by the law of state", instead);
        }
        if matter.is_open() {
            return refuse("an open boundary", "run it on the processor");
        }
        if matter.is_damped() {
            return refuse("damping", "run it on the processor");
        }
        if common.settings.corrects_gradients() {
            return refuse("corrected gradients of a fluid", "run it on the processor");
        }
        let follows = common.settings.density == DensityRule::Continuity;
        let (rate_constants, rate_kind) = matter.rate_law(common);
        let (force_constants, force_kind) = matter.force_law(common);
        Ok(Self {
            plan: system.device_plan()?,
            fluid: *matter.fluid(),
            follows,
            rate_constants,
            rate_kind,
            force_constants,
            force_kind,
            compliance: matter.compliance(),
            relaxation: (common.settings.relaxes())
                .then(|| [matter.relaxation(common), matter.lattice_sum().recip()]),
        })
    }

    fn plan(&self) -> &Plan<D> {
        &self.plan
    }

    fn room(&self, system: &TransportVelocity<D>) -> Room {
        let count = system.common.particles.len();
        // What falls is read by the pass of rates.
        let mut scratch = vec![("rate", 3 * count), ("half_force", D * count)];
        scratch.extend(self.relaxation.map(|_| ("filling", count)));
        scratch.extend(self.plan.sums_densities.then_some(("summed", count)));
        scratch.extend((self.plan.normals > 0).then_some(("shear", D * count)));
        Room { scratch, filled: Vec::new() }
    }

    fn passes(&self, dialect: Dialect) -> Vec<Pass> {
        let plan = &self.plan;
        let space = &plan.space();
        let mut all = plan.passes::<Self::Kind>(dialect, space);
        all.extend([
            self.state(dialect),
            self.rates(dialect, space),
            self.advance(dialect),
            self.forces(dialect, space),
            self.look(dialect),
        ]);
        if plan.sums_densities {
            all.push(self.densities(dialect, space));
        }
        all.extend(self.relaxation.map(|[_, scale]| self.excess(dialect, scale)));
        if plan.falls {
            all.push(self.fall(dialect));
        }
        if plan.normals > 0 {
            all.extend([self.walls(dialect, space), self.reactions(dialect, space)]);
        }
        all
    }

    fn passes_of(&self, stage: Stage<Ends>) -> &'static [&'static str] {
        match stage {
            Stage::State if self.plan.sums_densities => &["densities", "state"],
            Stage::Rates if self.plan.falls => &["fall", "rates"],
            Stage::Own(Ends::Excess) => &["excess"],
            // Those of open boundaries and of damping are refused.
            _ => self.plan.passes_of(stage),
        }
    }

    fn judge(
        &self,
        machine: &mut Machine,
        count: usize,
        limits: &mut Vec<StepLimit>,
    ) -> Result<Health, DeviceError> {
        let all: [(f64, usize); FIGURES] = machine.largest(count)?;
        let [mut speed, mut acceleration, ratio, broken, escaped] = all;
        for figure in [&mut speed, &mut acceleration] {
            // What rests is that of the first particle.
            *figure = if figure.0 > 0.0 { *figure } else { (0.0, 0) };
        }
        let fluid = &self.fluid;
        let most = |(value, particle): (f64, usize)| Most { value, particle };
        let fastest = Most { value: speed.0.sqrt(), particle: speed.1 };
        let signal = Most { value: fluid.wave_speed + fastest.value, ..fastest };
        let figures = [signal, fastest, most(acceleration)];
        let viscosity = fluid.viscosity * self.force_constants.viscous.along();
        step_limits(self.plan.smoothing_length, viscosity, figures, limits);
        Ok(Health {
            largest_speed: speed.0.sqrt(),
            largest_speed_particle: speed.1,
            largest_wave_speed: fluid.wave_speed,
            smallest_ratio: -ratio.0,
            smallest_ratio_particle: ratio.1,
            first_not_finite: (broken.0 > 0.0).then_some(broken.1),
            first_escaped: (escaped.0 > 0.0).then_some(escaped.1),
            ..Health::NEUTRAL
        })
    }
}

impl<const D: usize> FluidPlan<D> {
    /// Half of the body force of each particle.
    fn fall(&self, dialect: Dialect) -> Pass {
        let (reads, writes) = ([through("numbers", "gravity", D)], [own("half_force", D)]);
        local(dialect, "fall", &[], &reads, &writes, |x| {
            x.iter().map(|component| *component * 0.5).collect()
        })
    }

    /// Densities as sums over masses.
    fn densities(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let columns = [own("side", side_width(D))];
        let centre = self.plan.kernel.value(D, 0.0, self.plan.smoothing_length);
        Gather::<One, _>::new(dialect, "densities", space, Among::Active, Order::Single)
            .start(&columns, |mut x| side::<D>(&mut x).mass() * centre)
            .term(&Density::<D>, &columns, Among::All)
            .close(&[], &[], &[own("summed", 1)], |sum, _| vec![*sum])
    }

    /// Densities and pressures that are functions of places or of each other, and squares of speeds.
    fn state(&self, dialect: Dialect) -> Pass {
        let mut reads = vec![through("numbers", "wall", 1), own("side", side_width(D))];
        reads.extend(self.plan.sums_densities.then_some(own("summed", 1)));
        let writes = [own("side", side_width(D)), spread("terms", 1)];
        local(dialect, "state", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let before: Side<Traced, D> = side(&mut x);
            let density = if self.plan.sums_densities { one(&mut x) } else { before.density };
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

    /// Rates of the pressure.
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
        gather.close(&[], &[], &[own("rate", 3)], |sums, _| {
            vec![sums.divergence, sums.pressure_transport, sums.pressure_diffusion]
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
            through("slots", "rate", 3),
            through("slots", "side", side_width(D)),
        ];
        let relaxing = self.relaxation.map(|_| own("excess", 1));
        let reads = [&reads, relaxing.as_slice(), &*self.plan.of_motion()].concat();
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
            let rates = [one(&mut x), one(&mut x), one(&mut x)];
            let [divergence, pressure_transport, pressure_diffusion] = rates;
            let before: Side<Traced, D> = side(&mut x);
            let relaxing = self.relaxation.map(|[rate, _]| one(&mut x) * rate);
            let zero = Traced::from(0.0);
            let Fluid { density: at_rest, wave_speed, .. } = self.fluid;
            let stiffness = wave_speed.powi(2);
            let compression = -before.density * stiffness * divergence;
            let relaxing = relaxing.unwrap_or(zero);
            let pressure_rates = [compression, pressure_transport, pressure_diffusion, relaxing];
            let pressure_rate = pressure_rates.into_iter().reduce(|a, b| a + b).unwrap_or(zero);
            let mean = pressure + step * 0.5 * pressure_rate;
            let powers = pressure_rates.map(|rate| step * mass * self.compliance * mean * rate);
            let terms = self.plan.drift_terms(powers, [&velocity, &deviation], [step, mass]);
            let evolved = pressure + step * pressure_rate;
            let density_after = match self.follows {
                true => fluid::density(evolved, at_rest, wave_speed),
                false => density,
            };
            let next = self.plan.moved(&position, &(velocity + deviation), step);
            let still = self.plan.carried(&position, step, &mut x);
            let next = still
                .into_iter()
                .copied()
                .zip(next.into_iter().copied())
                .chain([(density, density_after), (pressure, evolved)]);
            let terms = terms.into_iter().map(|term| (zero, term));
            next.chain(terms).map(|(still, moved)| if_fluid(wall, moved, still)).collect()
        })
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
                match self.plan.normals {
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
            (_, false, false) => of!(STRESS, false, false),
            (_, false, true) => of!(STRESS, false, true),
            (_, true, false) => of!(STRESS, true, false),
            (_, true, true) => of!(STRESS, true, true),
        };
        let gravity = self.plan.falls.then_some(through("numbers", "gravity", D));
        let filling = self.relaxation.map(|_| own("filling", 1));
        let writes = [&[own("force", FORCES * D)], filling.as_slice()].concat();
        gather.close(&[], gravity.as_slice(), &writes, |sums, mut x| {
            let body_force = match self.plan.falls {
                true => take(&mut x),
                false => Vector::<D>::repeat(Traced::from(0.0)),
            };
            let rows = [
                sums.pressure,
                sums.viscosity,
                sums.artificial_viscosity,
                sums.carried,
                sums.walls,
                body_force,
                sums.crowding,
                -sums.volume,
            ];
            let filling = filling.map(|_| sums.filling);
            rows.iter().flat_map(|row| row.iter().copied()).chain(filling).collect()
        })
    }

    /// By how much summation densities are above densities, where no free surface is within the support.
    fn excess(&self, dialect: Dialect, scale: f64) -> Pass {
        let reads = [
            own("wall", 1),
            through("slots", "side", side_width(D)),
            through("slots", "filling", 1),
            through("slots", "reach", 1),
        ];
        let centre = self.plan.kernel.value(D, 0.0, self.plan.smoothing_length);
        local(dialect, "excess", &[], &reads, &[own("excess", 1)], |mut x| {
            let wall = one(&mut x);
            let me: Side<Traced, D> = side(&mut x);
            let (filling, reach) = (one(&mut x), one(&mut x));
            let summed = me.mass() * centre + filling;
            let (excess, zero) = (summed * scale - me.density, Traced::from(0.0));
            let is_within = Traced::from(self.plan.smoothing_length).at_most(reach);
            vec![if_fluid(wall, Traced::select(is_within, excess, zero), zero)]
        })
    }

    /// Sides of wall particles from the fluid around them.
    fn walls(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let (plan, sides) = (&self.plan, [own("side", side_width(D))]);
        let gather = Gather::<Surroundings<D>, _>::new(
            dialect,
            "walls",
            space,
            Among::Passive,
            Order::Single,
        )
        .term(&Extrapolation::<D>, &sides, Among::Active);
        let writes = [own("side", side_width(D)), own("shear", D)];
        gather.close(&[], &plan.of_ghosts(), &writes, |around, mut x| {
            let ghost = plan.ghost(around, &mut x);
            let shear = pick(ghost.slips, &ghost.of_fluid.velocity, &ghost.of_fluid.dragged);
            let shear = pick(ghost.is_wet, &shear, &ghost.surface);
            let velocities = [ghost.of_fluid.velocity, ghost.of_fluid.deviation];
            let side = plan.ghost_side(&ghost, velocities, &mut x);
            side.into_iter().chain(shear.iter().copied()).collect()
        })
    }

    /// What the fluid does to wall particles.
    fn reactions(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let constants = self.force_constants;
        let law = Wall::<D>::of(&constants);
        let columns = [own("side", side_width(D)), own("shear", D)];
        let writes = [own("force", FORCES * D)];
        Gather::<Components<D>, _>::new(dialect, "reactions", space, Among::Passive, Order::Lanes)
            .term(&law, &columns, Among::Active)
            .close(&[], &[], &writes, |walls, _| {
                let mut all = vec![Traced::from(0.0); FORCES * D];
                all[4 * D..5 * D].copy_from_slice(walls.as_slice());
                all
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
