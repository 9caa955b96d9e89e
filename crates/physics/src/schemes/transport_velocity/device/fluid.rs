//! A fluid on a device.

use piola_device::{
    Among, DeviceError, Dialect, Gather, Machine, Order, Pass, Space, Traced, Use, flat as record,
    local, own, spread, through,
};
use piola_formulas::pairs::corrected::{
    CorrectedForces, CorrectedRateSum, CorrectedRates, CorrectedWall, CorrectedWallForces,
    GradientSide, GradientSum, Gradients, VelocityGradient, WallMoment,
};
use piola_formulas::pairs::fluid::{
    FULL, ForceConstants, ForceSum, Forces, NONE, RateConstants, RateSum, RateSums, Rates, STRESS,
    Side, Wall, WallForces,
};
use piola_formulas::pairs::sums::Density;
use piola_formulas::pairs::wall::{Extrapolation, Surroundings};
use piola_formulas::pairs::{Components, One, Record};
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
    /// nu_v of theory (111) in m^2/s, where gradients are corrected.
    corrected: Option<f64>,
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
        if matter.is_open() {
            return refuse("an open boundary", "run it on the processor");
        }
        if matter.is_damped() {
            return refuse("damping", "run it on the processor");
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
            corrected: matter.velocity_diffusivity(common),
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
        scratch.extend(self.of_gradients().map(|of| (of.column, of.width * count)));
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
        all.extend(self.corrected.map(|_| self.gradients(dialect, space)));
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
            Stage::Own(Ends::Gradients) => &["gradients"],
            Stage::Own(Ends::Forces) => self.plan.passes_of(Stage::<Ends>::Forces),
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
        let is_read = match (self.plan.sums_densities, self.plan.by_law) {
            (true, _) => Some(own("summed", 1)),
            // Not from the side, which may be in single precision.
            (false, Some(_)) => Some(through("numbers", "density", 1)),
            (false, None) => None,
        };
        reads.extend(is_read);
        let writes = [own("side", side_width(D)), spread("terms", 1)];
        local(dialect, "state", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let before: Side<Traced, D> = side(&mut x);
            let density = if is_read.is_some() { one(&mut x) } else { before.density };
            let Fluid { density: at_rest, wave_speed, .. } = self.fluid;
            let pressure = match self.plan.by_law {
                Some(_) => fluid::pressure(density, at_rest, wave_speed),
                None => before.pressure,
            };
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

    /// The column of corrections and velocity gradients, where gradients are corrected.
    fn of_gradients(&self) -> Option<Use> {
        self.corrected.map(|_| own("gradients", GradientSide::<D>::NUMBERS))
    }

    /// What forces of walls read of a particle.
    fn of_walls(&self) -> Vec<Use> {
        let sides = [own("side", side_width(D)), own("shear", D)];
        [&sides, self.of_gradients().as_slice()].concat()
    }

    /// Corrections of gradients, and gradients of velocities.
    fn gradients(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let columns = [own("side", side_width(D))];
        let gather = Gather::<GradientSum<D>, _>::new(
            dialect,
            "gradients",
            space,
            Among::Active,
            Order::Lanes,
        )
        .term(&VelocityGradient::<D>, &columns, Among::Active);
        let gather = match self.plan.normals {
            0 => gather,
            _ => gather.term(&WallMoment::<D>, &columns, Among::Passive),
        };
        gather.close(&[], &[], self.of_gradients().as_slice(), |sums, _| {
            record::<GradientSide<D>>(&sums.gradients())
        })
    }

    /// Rates of the pressure.
    fn rates(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let constants = self.rate_constants;
        let (corrects, moves, falls) = self.rate_kind;
        let columns = [own("side", side_width(D)), own("half_force", D)];
        if self.corrected.is_some() {
            return self.corrected_rates(dialect, space, &columns);
        }
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
        gather.close(&[], &[], &[own("rate", 3)], |sums, _| rates(sums))
    }

    /// The same with corrected gradients.
    fn corrected_rates(&self, dialect: Dialect, space: &Space<D>, columns: &[Use]) -> Pass {
        let (among, order) = (Among::Active, Order::Lanes);
        let gather = Gather::<CorrectedRateSum<D>, _>::new(dialect, "rates", space, among, order);
        let gather = match self.rate_kind.2 {
            true => {
                let law = CorrectedRates::<D, true>(self.rate_constants);
                gather.term(&law, columns, Among::All)
            }
            false => {
                let law = CorrectedRates::<D, false>(self.rate_constants);
                gather.term(&law, columns, Among::All)
            }
        };
        let (side, written) = ([own("side", side_width(D))], [own("rate", 3)]);
        gather.close(&[], &side, &written, |sums, mut x| {
            rates(&sums.rates(&self::side::<D>(&mut x).deviation))
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
            let (powers, evolved) = match self.plan.by_law {
                Some(_) => ([zero; 4], pressure),
                None => {
                    let power = |rate| step * mass * self.compliance * mean * rate;
                    (pressure_rates.map(power), pressure + step * pressure_rate)
                }
            };
            let terms = self.plan.drift_terms(powers, [&velocity, &deviation], [step, mass]);
            let density_after = match (self.follows, self.plan.by_law) {
                (true, None) => fluid::density(evolved, at_rest, wave_speed),
                (true, Some(_)) => density + step * pressure_rate / stiffness,
                (false, _) => density,
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
        let gradients = self.of_gradients();
        let columns = [&[own("side", side_width(D))], gradients.as_slice()].concat();
        let of_walls = self.of_walls();
        let gather =
            Gather::<ForceSum<D>, _>::new(dialect, "forces", space, Among::Active, Order::Lanes);
        macro_rules! with {
            ($law:expr, $walls:ident) => {{
                let law = $law;
                let gather = gather.term(&law, &columns, Among::Active);
                match self.plan.normals {
                    0 => gather,
                    _ => gather.term(&$walls(law), &of_walls, Among::Passive),
                }
            }};
        }
        macro_rules! of {
            ($kind:expr, $artificial:literal, $crowding:literal) => {{
                let plain = Forces::<D, { $kind }, $artificial, $crowding>(constants);
                with!(plain, WallForces)
            }};
        }
        macro_rules! corrected {
            ($diffusivity:expr, $artificial:literal, $crowding:literal) => {{
                let plain = Forces::<D, FULL, $artificial, $crowding>(constants);
                with!(CorrectedForces(plain, $diffusivity), CorrectedWallForces)
            }};
        }
        let (corrects, artificial, crowding) = self.force_kind;
        let gather = match (self.corrected, corrects, artificial, crowding) {
            (Some(nu), _, false, false) => corrected!(nu, false, false),
            (Some(nu), _, false, true) => corrected!(nu, false, true),
            (Some(nu), _, true, false) => corrected!(nu, true, false),
            (Some(nu), _, true, true) => corrected!(nu, true, true),
            (None, NONE, false, false) => of!(NONE, false, false),
            (None, NONE, false, true) => of!(NONE, false, true),
            (None, NONE, true, false) => of!(NONE, true, false),
            (None, NONE, true, true) => of!(NONE, true, true),
            (None, FULL, false, false) => of!(FULL, false, false),
            (None, FULL, false, true) => of!(FULL, false, true),
            (None, FULL, true, false) => of!(FULL, true, false),
            (None, FULL, true, true) => of!(FULL, true, true),
            (None, _, false, false) => of!(STRESS, false, false),
            (None, _, false, true) => of!(STRESS, false, true),
            (None, _, true, false) => of!(STRESS, true, false),
            (None, _, true, true) => of!(STRESS, true, true),
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

    /// By how much summation densities are above densities, where no free surface is within the support; with corrected
    /// gradients near them, too, but not below.
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
            // As theory (113) has it.
            let near = match self.corrected {
                Some(_) => Traced::select(excess.above(0.0), excess, zero),
                None => zero,
            };
            vec![if_fluid(wall, Traced::select(is_within, excess, near), zero)]
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
        gather.close(&[], &plan.of_ghosts(), &self.of_walls(), |around, mut x| {
            let ghost = plan.ghost(around, &mut x);
            let shear = pick(ghost.slips, &ghost.of_fluid.velocity, &ghost.of_fluid.dragged);
            let shear = pick(ghost.is_wet, &shear, &ghost.surface);
            let velocities = [ghost.of_fluid.velocity, ghost.of_fluid.deviation];
            let side = plan.ghost_side(&ghost, velocities, &mut x);
            // Gradients of walls are not corrected.
            let unit = self.corrected.map(|_| record::<GradientSide<D>>(&Gradients::none()));
            let unit = unit.unwrap_or_default();
            side.into_iter().chain(shear.iter().copied()).chain(unit).collect()
        })
    }

    /// What the fluid does to wall particles.
    fn reactions(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let constants = self.force_constants;
        let (law, columns) = (Wall::<D>::of(&constants), self.of_walls());
        let (among, order) = (Among::Passive, Order::Lanes);
        let gather = Gather::<Components<D>, _>::new(dialect, "reactions", space, among, order);
        let gather = match self.corrected {
            None => gather.term(&law, &columns, Among::Active),
            Some(_) => gather.term(&CorrectedWall(law), &columns, Among::Active),
        };
        gather.close(&[], &[], &[own("force", FORCES * D)], |walls, _| {
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

/// The numbers of rates.
fn rates<const D: usize>(rates: &RateSums<Traced, D>) -> Vec<Traced> {
    vec![rates.divergence, rates.pressure_transport, rates.pressure_diffusion]
}
