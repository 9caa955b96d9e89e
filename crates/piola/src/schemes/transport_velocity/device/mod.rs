//! Steps of a fluid on a device.
//!
//! The passes are those of the processor, from the same pair laws: what a stage does there between
//! gathers is written once more in `passes.rs`, as laws of one particle. The columns of the state are
//! on the device by number, sides and what is gathered by slot. The ledger stays here: of each pass over particles
//! its sums come back, chunk by chunk, and are booked as those of the processor.

mod passes;
mod surface;
mod walls;

use piola_device::lists::Lists;
use piola_device::{Column, Device, DeviceError, Indices, Machine};
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::fluid::{ForceConstants, RateConstants};

use self::passes::{FIGURES, FORCES, drift_terms, kick_terms, side_width};
use super::inspect::step_limits;
use super::ledger::{Drift, Kick};
use super::shifting::Speed;
use super::stages::{Instant, Pass};
use super::{
    ACCELERATING, AtSurface, DRIFTING, DensityRule, Fluid, LEDGER, Shifting, Slip,
    TransportVelocity,
};
use crate::boundaries::BodyForce;
use crate::operators::MovingSupport;
use crate::parallel::{CHUNK, Sums};
use crate::schemes::device::{DeviceRefusal, DeviceSteps};
use crate::schemes::ledger::Totals;
use crate::schemes::look::Most;
use crate::schemes::momentum::momentum_components;
use crate::schemes::stages::{Phase, Stages};
use crate::schemes::{Health, Scheme, StepLimit};
use crate::{Vector, fields};

/// What the passes depend on.
struct Plan<const D: usize> {
    kernel: Kernel,
    smoothing_length: f64,
    periods: [Option<[f64; 2]>; D],
    fluid: Fluid,
    /// Whether densities are sums over masses, and whether they evolve.
    sums_densities: bool,
    evolves: bool,
    /// Whether the deviation carries density and pressure.
    carries: [bool; 2],
    rate_constants: RateConstants,
    rate_kind: (bool, bool, bool),
    force_constants: ForceConstants,
    force_kind: (u8, bool, bool),
    /// Whether SPST sets deviations.
    shifts: bool,
    /// Whether free surfaces are looked for, and particles are shifted along them.
    seeks_surfaces: bool,
    along_surfaces: bool,
    /// Less than half of it is few neighbours.
    even_count: f64,
    /// Whether there are body forces.
    falls: bool,
    /// Most normals of a wall particle; 0 without walls.
    normals: usize,
    spacing: f64,
    /// Least and largest coordinates in m of particles that have not escaped, if anybody asks.
    bounds: Option<[[f64; D]; 2]>,
    compliance: f64,
}

/// A fluid on a device.
struct OnDevice<const D: usize> {
    plan: Plan<D>,
    machine: Machine,
    lists: Lists,
    drift: Stages<Pass>,
    accelerate: Stages<Pass>,
    /// Number of particles.
    count: usize,
    /// Where each column begins in a state, with its name and that of its copy.
    columns: Vec<(usize, Named)>,
    /// The end of the state, and what it was before the last step.
    tail: Vec<f64>,
    tail_before: Vec<f64>,
    /// Whether neighbours are those of the positions.
    is_picked: bool,
    is_listed: bool,
    /// Largest speed that the last pass over densities has seen, in m/s.
    fastest: f64,
    speed: Speed,
    body_forces: Vec<BodyForce<D>>,
    /// Body of each particle.
    bodies: Vec<u32>,
    /// Whether the column of body forces is that of all times.
    is_falling: bool,
    /// What lists reach beyond the support in m.
    skin: f64,
}

/// A column of the state, its name on the device, that of its copy, and numbers a particle.
type Named = (&'static str, &'static str, usize);

/// Rows of neighbours, and which particle is where.
struct Rows<'a>(&'a Lists);

impl Indices for Rows<'_> {
    fn indices(&self, name: &str) -> Option<&Column<u32>> {
        Some(match name {
            "numbers" => self.0.numbers(),
            "slots" => self.0.slots(),
            "first" => self.0.first(),
            "active" => self.0.active(),
            "passive_first" => self.0.passive_first(),
            "passive_count" => self.0.passive_count(),
            "entries" => self.0.entries(),
            _ => return None,
        })
    }
}

fn gibibytes(bytes: usize) -> String {
    format!("{:.2} GiB", bytes as f64 / f64::from(1 << 30))
}

impl<const D: usize> Plan<D> {
    /// Columns beside those of the state, with their numbers a particle.
    fn scratch(&self) -> Vec<(&'static str, usize)> {
        let mut all = vec![
            ("place", D),
            ("made_at", D),
            ("side", side_width(D)),
            ("rate", 4),
            ("force", FORCES * D),
            ("escaped", 1),
            ("terms", kick_terms(D).max(drift_terms(D)).max(FIGURES)),
            // Read by the pass of rates, and of walls.
            ("half_force", D),
            ("gravity", D),
        ];
        if self.sums_densities {
            all.push(("summed", 1));
        }
        if self.normals > 0 {
            all.extend([
                ("shear", D),
                ("hold", 2 * D + 1),
                ("motion", D),
                ("wall_acceleration", D),
            ]);
        }
        if self.seeks_surfaces {
            let marks = ["mark", "near", "alone", "surface", "close_by", "reach"];
            all.extend(marks.map(|name| (name, 1)));
            all.extend(["sharp", "normal", "crowd"].map(|name| (name, D)));
        }
        all
    }
}

/// What of a settled case has no body for devices.
fn refusal(pass: Pass) -> Option<DeviceRefusal> {
    let instead = match pass {
        Pass::Iterate | Pass::Push => "use `scheme.shifting = \"spst\"` or \"none\"",
        Pass::Prescribe | Pass::Correct | Pass::Tension | Pass::Hold => "use a fluid",
        _ => return None,
    };
    let what = format!("the stage `{}`", pass.name());
    Some(DeviceRefusal::Stage { what, instead })
}

impl<const D: usize> TransportVelocity<D> {
    /// The steps of the fluid on a device.
    pub(super) fn to_device(&self, device: Device) -> Result<Box<dyn DeviceSteps>, DeviceRefusal> {
        let (drift, accelerate) = (self.drift.passes(), self.accelerate.passes());
        if self.solids.is_some() {
            return Err(DeviceRefusal::Solids);
        }
        if let Some(refusal) = drift.iter().chain(accelerate).find_map(|pass| refusal(*pass)) {
            return Err(refusal);
        }
        let refuse = |what: &str, instead| Err(DeviceRefusal::Stage { what: what.into(), instead });
        if self.settings.is_algebraic() {
            let instead = "use `scheme.pressure = \"edac\"`";
            return refuse("a pressure by the law of state", instead);
        }
        if self.motion.iter().next().is_some() {
            return refuse("a wall that moves", "let it slide or rest");
        }
        if !self.sliding.iter().all(|entry| entry.value.is_steady()) {
            return refuse("a wall that slides by a function of time", "let it slide steadily");
        }
        if self.guard.as_ref().is_some_and(|(guard, _)| guard.removes) {
            let instead = "leave out `scheme.escaped = \"remove\"`";
            return refuse("the removal of particles that escape", instead);
        }
        if !self.body_forces.iter().all(BodyForce::is_uniform) {
            let instead = "take one that is the same everywhere";
            return refuse("a body force that depends on places", instead);
        }
        let list = self.support.list();
        let periods = *list.domain().periodic();
        let corrections = self.settings.corrections;
        let evolves = self.settings.density == DensityRule::Continuity;
        let by_crowding = matches!(self.settings.shifting, Shifting::Sun { .. });
        let (rate_constants, rate_kind) = self.rate_law();
        let (force_constants, force_kind) = self.force_law();
        let plan = Plan {
            kernel: self.support.kernel(),
            smoothing_length: self.support.smoothing_length(),
            periods,
            fluid: self.fluid,
            sums_densities: self.settings.density == DensityRule::Summation,
            evolves,
            carries: [corrections.density && evolves, corrections.pressure],
            rate_constants,
            rate_kind,
            force_constants,
            force_kind,
            shifts: by_crowding,
            compliance: self.compliance(),
            seeks_surfaces: by_crowding && self.settings.free_surface,
            along_surfaces: self.settings.at_surface == AtSurface::Along,
            even_count: self.even_count() as f64,
            falls: !self.body_forces.is_empty(),
            normals: self.most_normals(),
            spacing: self.particles.spacing[0],
            bounds: self.bounds(self.start()).map(|(low, high)| [low.into(), high.into()]),
        };
        let count = self.particles.len();
        let (faces, normals) = (walls::faces_width(D, plan.normals), plan.normals);
        let (columns, scratch) = (self.device_columns(), plan.scratch());
        self.fits(&device, &columns, &scratch)?;
        let mut machine = Machine::new(device, |language| plan.passes(language), CHUNK)?;
        let support = list.support();
        let skin = MovingSupport::<D>::SKIN * support;
        let lists = Lists::new(machine.device(), &self.is_wall, support, skin, &periods)?;
        for (_, (name, before, width)) in &columns {
            machine.add_zeros(name, count * width)?;
            machine.add_zeros(before, count * width)?;
        }
        for (name, width) in scratch {
            machine.add_zeros(name, count * width)?;
        }
        machine.add("mass", &self.mass)?;
        let wall: Vec<u32> = self.is_wall.iter().map(|&is_wall| u32::from(is_wall)).collect();
        machine.add("wall", &wall.iter().map(|&wall| f64::from(wall)).collect::<Vec<_>>())?;
        machine.add_indices("passive", &wall)?;
        if normals > 0 {
            machine.add("faces", &self.face_numbers(faces, normals))?;
            machine.add("sliding", &self.sliding_numbers())?;
        }
        let tail = self.start()[count * self.width()..].to_vec();
        Ok(Box::new(OnDevice {
            plan,
            machine,
            lists,
            drift: self.drift.clone(),
            accelerate: self.accelerate.clone(),
            count,
            columns,
            tail_before: tail.clone(),
            tail,
            is_picked: false,
            is_listed: false,
            fastest: 0.0,
            speed: self.shifting_speed(),
            body_forces: self.body_forces.clone(),
            bodies: self.particles.body.clone(),
            is_falling: false,
            skin,
        }))
    }

    /// Refuses a device whose memory does not suffice, with what takes it.
    fn fits(
        &self,
        device: &Device,
        columns: &[(usize, Named)],
        scratch: &[(&'static str, usize)],
    ) -> Result<(), DeviceRefusal> {
        let number = self.particles.len() * size_of::<f64>();
        let state = columns.iter().map(|(_, (name, _, width))| (*name, 2 * width * number));
        let others = scratch.iter().map(|(name, width)| (*name, width * number));
        let lists = ("neighbours", 2 * self.support.list().entries() * size_of::<u32>());
        let mut all: Vec<(&str, usize)> = state.chain(others).chain([lists]).collect();
        let needed: usize = all.iter().map(|(_, bytes)| bytes).sum();
        if needed as u64 <= device.memory() {
            return Ok(());
        }
        all.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
        let largest =
            all.iter().take(5).map(|(name, bytes)| format!("{name} {}", gibibytes(*bytes)));
        Err(DeviceRefusal::Memory {
            needed: gibibytes(needed),
            device: device.found().to_string(),
            largest: largest.collect::<Vec<_>>().join(", "),
        })
    }

    /// Most normals of a wall particle.
    fn most_normals(&self) -> usize {
        let normals = self.walls.iter().map(|wall| wall.faces.normals().len());
        normals.max().map_or(0, |most| most.max(1))
    }

    /// The faces of wall particles as numbers, by number of the particle.
    fn face_numbers(&self, width: usize, most: usize) -> Vec<f64> {
        let mut all = vec![0.0; self.particles.len() * width];
        for wall in &self.walls {
            let (faces, row) = (&wall.faces, &mut all[wall.number as usize * width..][..width]);
            let normals = faces.normals();
            row[0] = normals.len() as f64;
            row[1] = f64::from(u8::from(wall.slip == Slip::Free));
            row[2] = faces.depth();
            row[3..][..D].copy_from_slice(faces.between().as_slice());
            let own = normals.iter().take(most).flat_map(|normal| normal.iter());
            row[3 + D..].iter_mut().zip(own).for_each(|(to, component)| *to = *component);
        }
        all
    }

    /// Velocities with which walls slide, by number of the particle.
    fn sliding_numbers(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.particles.len() * D];
        for entry in self.sliding.iter() {
            let number = self.walls[entry.particle].number as usize;
            all[number * D + entry.component] = entry.value.value(entry.place, 0.0);
        }
        all
    }

    /// Columns of the state by where they begin.
    fn device_columns(&self) -> Vec<(usize, Named)> {
        let copies = [
            ("position", "position_before"),
            ("velocity", "velocity_before"),
            ("deviation", "deviation_before"),
            ("kick", "kick_before"),
            ("pressure", "pressure_before"),
            ("density", "density_before"),
        ];
        let description = self.description();
        let all = copies.iter().map(|&(name, before)| {
            let field = description.fields.iter().find(|field| field.name == name);
            let field = field.expect("these are columns of the formulation");
            let range = fields::column(description.fields, D, self.particle_count(), field);
            (range.start, (name, before, field.kind.components(D)))
        });
        all.collect()
    }
}

impl<const D: usize> OnDevice<D> {
    fn start(&self, pass: &str, scalars: &[(&str, f64)]) -> Result<(), DeviceError> {
        self.machine.start(pass, self.count, scalars, &Rows(&self.lists))
    }

    /// Fills sides, and finds the neighbours where particles have moved.
    fn load(&mut self) -> Result<(), DeviceError> {
        self.start("load", &[])?;
        if self.is_picked {
            return Ok(());
        }
        let [(most, _)] = self.machine.largest(self.count)?;
        // Positions that are no numbers have no neighbours: the look over the state tells.
        if most.is_finite() || !self.is_listed {
            if !self.is_listed || most > 0.25 * self.skin * self.skin {
                self.lists.build(self.machine.column("position"))?;
                self.start("load", &[])?;
                self.machine.copy("place", "made_at")?;
                self.is_listed = true;
            }
            self.lists.pick(self.machine.column("place"))?;
        }
        self.is_picked = true;
        Ok(())
    }

    /// Sets the body force of each particle, where it changes.
    fn fall(&mut self, time: f64) -> Result<(), DeviceError> {
        if self.is_falling {
            return Ok(());
        }
        let forces = &self.body_forces;
        let bodies = self.bodies.iter().max().map_or(0, |most| most + 1);
        let at = |body: u32| BodyForce::sum(forces, body, &Vector::<D>::zeros(), time);
        let each: Vec<Vector<D>> = (0..bodies).map(at).collect();
        let all = self.bodies.iter().flat_map(|&body| each[body as usize].iter().copied());
        let all: Vec<f64> = all.collect();
        self.is_falling = forces.iter().all(BodyForce::is_steady);
        self.machine.write("gravity", &all)
    }

    fn run(
        &mut self,
        pass: Pass,
        Instant { time, step }: Instant,
        totals: &mut Totals,
    ) -> Result<(), DeviceError> {
        match pass {
            Pass::Load => self.load(),
            Pass::State => {
                if self.plan.sums_densities {
                    self.start("densities", &[])?;
                }
                self.start("state", &[])?;
                let [(square, _)] = self.machine.largest(self.count)?;
                self.fastest = square.max(0.0).sqrt();
                Ok(())
            }
            Pass::Walls => {
                self.fall(time)?;
                self.start("walls", &[])
            }
            Pass::Rates => {
                if self.plan.falls {
                    self.fall(time)?;
                    self.start("fall", &[])?;
                }
                self.start("rates", &[])
            }
            Pass::Move => {
                self.start("advance", &[("step", step)])?;
                self.is_picked = false;
                let sums = self.machine.sums(drift_terms(D), self.count)?;
                let mut drift = Drift::ZERO;
                let (powers, impulse) = sums.split_at(DRIFTING.len());
                drift.iter_mut().zip(powers).for_each(|(total, power)| total.power = *power);
                let [_, transport, ..] = &mut drift;
                transport.force[..impulse.len()].copy_from_slice(impulse);
                DRIFTING.iter().zip(&drift).for_each(|(entry, sum)| totals.book(*entry, sum));
                Ok(())
            }
            Pass::Forces => {
                self.fall(time)?;
                self.start("forces", &[])?;
                if self.plan.normals > 0 { self.start("reactions", &[]) } else { Ok(()) }
            }
            Pass::Sharpen => self.start("sharpen", &[]),
            Pass::Surfaces => {
                ["see", "normals", "cover"].iter().try_for_each(|pass| self.start(pass, &[]))
            }
            Pass::Reach => {
                ["see_surfaces", "reach_surfaces"].iter().try_for_each(|pass| self.start(pass, &[]))
            }
            Pass::Shift => {
                if self.plan.seeks_surfaces {
                    self.start("crowd", &[])?;
                }
                let (scale, most) = self.speed.of(self.fastest);
                self.start("shift", &[("scale", scale), ("most", most)])
            }
            Pass::HoldOff => self.start("hold_off", &[]),
            Pass::Bear => ["add_holds", "bear"].iter().try_for_each(|pass| self.start(pass, &[])),
            Pass::Store => {
                self.start("store", &[])?;
                let sums = self.machine.sums(kick_terms(D), self.count)?;
                let (mut kick, mut sums) = (Kick::ZERO, sums.into_iter());
                let components = momentum_components(D).len();
                for (total, entry) in kick.iter_mut().zip(ACCELERATING) {
                    total.power = sums.next().unwrap_or_default();
                    total.growth = sums.next().unwrap_or_default();
                    let entering = total.force.iter_mut().take(components);
                    if entry.way.is_some() {
                        entering.zip(&mut sums).for_each(|(force, sum)| *force = sum);
                    }
                }
                ACCELERATING.iter().zip(&kick).for_each(|(entry, sum)| totals.drive(*entry, sum));
                Ok(())
            }
            // Body forces come with the forces; nothing is removed; all others are refused.
            _ => Ok(()),
        }
    }

    fn kick(&mut self, duration: f64) -> Result<(), DeviceError> {
        self.start("kick_velocities", &[("duration", duration)])?;
        LEDGER.kick(D, duration, &mut self.tail);
        Ok(())
    }

    /// Gives the columns of a state, or their copies, and an end.
    fn give(&self, is_before: bool, tail: &[f64], state: &mut [f64]) -> Result<(), DeviceError> {
        for &(start, (name, before, width)) in &self.columns {
            let column = self.machine.column(if is_before { before } else { name });
            let rows = &mut state[start..][..self.count * width];
            self.machine.device().read(column, rows)?;
        }
        let rest = state.len() - tail.len();
        state[rest..].copy_from_slice(tail);
        Ok(())
    }
}

impl<const D: usize> DeviceSteps for OnDevice<D> {
    fn put(&mut self, state: &[f64]) -> Result<(), DeviceError> {
        for &(start, (name, _, width)) in &self.columns {
            self.machine.write(name, &state[start..][..self.count * width])?;
        }
        let rest = state.len() - self.tail.len();
        self.tail.copy_from_slice(&state[rest..]);
        self.is_picked = false;
        Ok(())
    }

    fn step(&mut self, time: f64, step: f64) -> Result<(), DeviceError> {
        for &(_, (name, before, _)) in &self.columns {
            self.machine.copy(name, before)?;
        }
        self.tail_before.copy_from_slice(&self.tail);
        self.kick(0.5 * step)?;
        let middle = Instant { time: time + 0.5 * step, step };
        let end = Instant { time: time + step, step: 0.0 };
        let mut stages = std::mem::take(&mut self.drift);
        let done = stages.attempt(|pass, totals| self.run(pass, middle, totals));
        self.drift = stages;
        LEDGER.add(D, &done?, &mut self.tail);
        let mut stages = std::mem::take(&mut self.accelerate);
        let done = stages.attempt(|pass, totals| self.run(pass, end, totals));
        self.accelerate = stages;
        LEDGER.keep(D, &done?, &mut self.tail);
        self.kick(0.5 * step)
    }

    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, DeviceError> {
        if self.plan.bounds.is_some() {
            if !self.is_picked {
                self.load()?;
            }
            self.start("escape", &[])?;
        }
        self.start("look", &[])?;
        let all: [(f64, usize); FIGURES] = self.machine.largest(self.count)?;
        let [mut speed, mut acceleration, ratio, broken, escaped] = all;
        for figure in [&mut speed, &mut acceleration] {
            // What rests is that of the first particle.
            *figure = if figure.0 > 0.0 { *figure } else { (0.0, 0) };
        }
        let fluid = &self.plan.fluid;
        let most = |(value, particle): (f64, usize)| Most { value, particle };
        let fastest = Most { value: speed.0.sqrt(), particle: speed.1 };
        let signal = Most { value: fluid.wave_speed + fastest.value, ..fastest };
        let figures = [signal, fastest, most(acceleration)];
        step_limits(self.plan.smoothing_length, fluid.viscosity, figures, limits);
        Ok(Health {
            largest_speed: speed.0.sqrt(),
            largest_speed_particle: speed.1,
            largest_wave_speed: fluid.wave_speed,
            smallest_ratio: -ratio.0,
            smallest_ratio_particle: ratio.1,
            first_not_finite: (broken.0 > 0.0).then_some(broken.1),
            first_escaped: (escaped.0 > 0.0 && !(broken.0 > 0.0)).then_some(escaped.1),
            ..Health::NEUTRAL
        })
    }

    fn fetch(&self, state: &mut [f64]) -> Result<(), DeviceError> {
        self.give(false, &self.tail, state)
    }

    fn fetch_before(&self, state: &mut [f64]) -> Result<(), DeviceError> {
        self.give(true, &self.tail_before, state)
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.drift.phase(), self.accelerate.phase()]
    }
}
