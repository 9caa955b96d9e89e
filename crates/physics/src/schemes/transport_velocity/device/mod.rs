//! Steps of a fluid on a device.
//!
//! The passes are those of the processor, from the same pair laws: most of what a stage does there between
//! gathers is written once more here, as laws of one particle. The columns of the state are
//! on the device by number, sides and what is gathered by slot. The ledger stays here: of each pass over particles
//! its sums come back, chunk by chunk, and are booked as those of the processor.

mod build;
mod passes;
mod removal;
mod stages;
mod surface;
mod walls;

use piola_device::{DeviceError, Machine};
use piola_formulas::kernels::Kernel;
use piola_formulas::pairs::fluid::{ForceConstants, RateConstants};

use self::passes::{FIGURES, drift_terms, kick_terms};
use self::removal::Removal;
use super::escape::Room;
use super::fluid::{ACCELERATING, DRIFTING, Ends, LEDGER};
use super::inspect::step_limits;
use super::ledger::{Drift, Kick};
use super::shifting::Speed;
use super::stages::{Instant, Pass};
use super::{Continuum as _, Fluid, WeaklyCompressible};
use crate::Vector;
use crate::boundaries::BodyForce;
use crate::parallel::Reduce as _;
use crate::schemes::device::{DeviceSteps, Gravity, StateColumns};
use crate::schemes::ledger::Totals;
use crate::schemes::look::Most;
use crate::schemes::momentum::momentum_components;
use crate::schemes::stages::{Phase, Stages};
use crate::schemes::{Health, StepLimit, StepsError};

/// What the passes depend on.
struct Plan<const D: usize> {
    kernel: Kernel,
    smoothing_length: f64,
    periods: [Option<[f64; 2]>; D],
    /// What lists reach, in m.
    reach: f64,
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
    /// Where particles may be, if anybody asks, and whether those that are elsewhere are taken out.
    room: Option<Room<D>>,
    removes: bool,
    compliance: f64,
}

/// A fluid on a device.
struct OnDevice<const D: usize> {
    plan: Plan<D>,
    machine: Machine,
    drift: Stages<Pass<Ends>>,
    accelerate: Stages<Pass<Ends>>,
    /// Number of particles.
    count: usize,
    state: StateColumns,
    /// Whether neighbours are those of the positions.
    is_picked: bool,
    is_listed: bool,
    /// Largest speed that the last pass over densities has seen, in m/s.
    fastest: f64,
    speed: Speed,
    body_forces: Vec<BodyForce<D>>,
    /// Body of each particle.
    bodies: Vec<u32>,
    gravity: Gravity,
    /// What is known of particles that may be taken out, if that is done.
    removal: Option<Removal>,
    /// What lists reach beyond the support in m.
    skin: f64,
}

impl<const D: usize> OnDevice<D> {
    fn start(&self, pass: &str, scalars: &[(&str, f64)]) -> Result<(), DeviceError> {
        self.machine.start(pass, self.count, scalars)
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
                self.machine.build("position")?;
                self.start("load", &[])?;
                self.is_listed = true;
            }
            self.machine.pick("place")?;
        }
        self.is_picked = true;
        Ok(())
    }

    /// Sets the body force of each particle, where it changes.
    fn fall(&mut self, time: f64) -> Result<(), DeviceError> {
        let (forces, bodies) = (&self.body_forces, &self.bodies);
        // Forces are uniform.
        let most = bodies.iter().max().map_or(0, |most| most + 1);
        let at = |body: u32| BodyForce::sum(forces, body, &Vector::<D>::zeros(), time);
        let each: Vec<Vector<D>> = (0..most).map(at).collect();
        let each = |a: usize| each[bodies[a] as usize];
        self.gravity.write(&mut self.machine, (time, forces), bodies.len(), each)
    }

    fn run(
        &mut self,
        pass: Pass<Ends>,
        Instant { time, step }: Instant,
        totals: &mut Totals,
    ) -> Result<(), DeviceError> {
        match pass {
            Pass::Remove => {
                totals.book(WeaklyCompressible::<D>::REMOVED, &self.remove_escaped()?);
                Ok(())
            }
            Pass::Load => self.load(),
            Pass::State => {
                self.launch(pass, &[])?;
                let [(square, _)] = self.machine.largest(self.count)?;
                self.fastest = square.max(0.0).sqrt();
                Ok(())
            }
            Pass::Walls => {
                self.fall(time)?;
                self.launch(pass, &[])
            }
            Pass::Rates => {
                if self.plan.falls {
                    self.fall(time)?;
                }
                self.launch(pass, &[])
            }
            Pass::Move => {
                self.launch(pass, &[("step", step)])?;
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
                self.launch(pass, &[])
            }
            Pass::Shift => {
                let (scale, most) = self.speed.of(self.fastest);
                self.launch(pass, &[("scale", scale), ("most", most)])
            }
            Pass::Store => {
                self.launch(pass, &[])?;
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
            _ => self.launch(pass, &[]),
        }
    }

    fn kick(&mut self, duration: f64) -> Result<(), DeviceError> {
        self.start("kick_velocities", &[("duration", duration)])?;
        LEDGER.kick(D, duration, &mut self.state.tail);
        Ok(())
    }
}

impl<const D: usize> DeviceSteps for OnDevice<D> {
    #[inline(never)]
    fn put(&mut self, state: &[f64]) -> Result<(), StepsError> {
        Ok(self.take_over(state)?)
    }

    #[inline(never)]
    fn step(&mut self, time: f64, step: f64) -> Result<(), StepsError> {
        self.state.mark(&mut self.machine)?;
        self.kick(0.5 * step)?;
        let middle = Instant { time: time + 0.5 * step, step };
        let end = Instant { time: time + step, step: 0.0 };
        let mut stages = std::mem::take(&mut self.drift);
        let done = stages.attempt(|pass, totals| self.run(pass, middle, totals));
        self.drift = stages;
        LEDGER.add(D, &done?, &mut self.state.tail);
        let mut stages = std::mem::take(&mut self.accelerate);
        let done = stages.attempt(|pass, totals| self.run(pass, end, totals));
        self.accelerate = stages;
        LEDGER.keep(D, &done?, &mut self.state.tail);
        Ok(self.kick(0.5 * step)?)
    }

    #[inline(never)]
    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError> {
        let asks = self.plan.room.is_some() && !self.plan.removes;
        if asks && !self.is_picked {
            self.load()?;
        }
        self.launch_look()?;
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
        let viscosity = fluid.viscosity * self.plan.force_constants.viscous.along();
        step_limits(self.plan.smoothing_length, viscosity, figures, limits);
        Ok(Health {
            largest_speed: speed.0.sqrt(),
            largest_speed_particle: speed.1,
            largest_wave_speed: fluid.wave_speed,
            smallest_ratio: -ratio.0,
            smallest_ratio_particle: ratio.1,
            first_not_finite: (broken.0 > 0.0).then_some(broken.1),
            first_escaped: (asks && escaped.0 > 0.0 && !(broken.0 > 0.0)).then_some(escaped.1),
            ..Health::NEUTRAL
        })
    }

    fn fetch(&self, state: &mut [f64]) -> Result<(), StepsError> {
        Ok(self.state.give(&self.machine, state)?)
    }

    fn fetch_before(&self, state: &mut [f64]) -> Result<(), StepsError> {
        Ok(self.state.give_before(&self.machine, state)?)
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.drift.phase(), self.accelerate.phase()]
    }
}
