//! Steps of fluids and of hypoelastic solids on a device.
//!
//! The passes are those of the processor, from the same pair laws: most of what a stage does there between
//! gathers is written once more here, as laws of one particle. The columns of the state are
//! on the device by number, sides and what is gathered by slot. The ledger stays here: of each pass over particles
//! its sums come back, chunk by chunk, and are booked as those of the processor.

mod build;
mod fluid;
mod moving;
mod passes;
mod removal;
mod solids;
mod stages;
mod surface;
mod walls;

use piola_device::{DeviceError, Dialect, Machine};

pub(super) use self::build::steps;
pub(super) use self::fluid::FluidPlan;
pub(super) use self::solids::SolidPlan;
pub(super) use self::stages::stages;

use self::moving::Moving;
use self::passes::{Plan, drift_terms};
use self::removal::Removal;
use super::ledger::{DRIFTING, Drift, Kick};
use super::shifting::Speed;
use super::stages::{Instant, Pass};
use super::{Continuum, TransportVelocity};
use crate::Vector;
use crate::boundaries::BodyForce;
use crate::parallel::Reduce as _;
use crate::schemes::device::{DeviceSteps, Gravity, Room, StateColumns};
use crate::schemes::ledger::{Total, Totals};
use crate::schemes::momentum::momentum_components;
use crate::schemes::stages::{Phase, Stages};
use crate::schemes::{Accounts, DeviceRefusal, Health, StepLimit, StepsError};

/// Columns of the state that all matter has, with the names of their copies.
const STATE: [[&str; 2]; 6] = [
    ["position", "position_before"],
    ["velocity", "velocity_before"],
    ["deviation", "deviation_before"],
    ["kick", "kick_before"],
    ["pressure", "pressure_before"],
    ["density", "density_before"],
];

/// What a kind of matter brings to the passes that all kinds share.
pub(super) trait OfMatter<const D: usize>: Sized + Send + 'static {
    /// The kind.
    type Kind: Continuum<D>;

    /// The columns of its state with the names of their copies.
    const STATE: &'static [[&'static str; 2]];
    /// Numbers that a look over the state takes of a particle.
    const FIGURES: usize;

    /// That of a settled case.
    ///
    /// # Errors
    /// What of the case has no steps on devices.
    fn of(system: &TransportVelocity<D, Self::Kind>) -> Result<Self, DeviceRefusal>;

    /// What the passes of all matter depend on.
    fn plan(&self) -> &Plan<D>;

    /// Its columns beside those of the state and of all matter.
    fn room(&self, system: &TransportVelocity<D, Self::Kind>) -> Room;

    /// Its columns of indices.
    fn indices(&self) -> Option<(&'static str, &[u32])> {
        None
    }

    /// All passes.
    fn passes(&self, dialect: Dialect) -> Vec<piola_device::Pass>;

    /// Names of the passes of a stage, in their order.
    fn passes_of(&self, stage: Pass<Own<D, Self>>) -> &'static [&'static str];

    /// Sets what is prescribed of its particles at a time in s, if anything is; the work and the impulse are of walls.
    fn prescribe(
        &mut self,
        _machine: &mut Machine,
        _time: f64,
    ) -> Result<Option<Total>, DeviceError> {
        Ok(None)
    }

    /// What a look over this many particles has found, with the bounds on the step.
    fn judge(
        &self,
        machine: &mut Machine,
        count: usize,
        limits: &mut Vec<StepLimit>,
    ) -> Result<Health, DeviceError>;
}

/// Passes of a kind of matter alone.
type Own<const D: usize, P> = <<P as OfMatter<D>>::Kind as Continuum<D>>::Own;

/// A system on a device.
struct OnDevice<const D: usize, P: OfMatter<D>> {
    matter: P,
    machine: Machine,
    drift: Stages<Pass<Own<D, P>>>,
    accelerate: Stages<Pass<Own<D, P>>>,
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
    /// Walls that move.
    moving: Option<Moving<D>>,
}

impl<const D: usize, P: OfMatter<D>> OnDevice<D, P> {
    const LEDGER: Accounts = P::Kind::DESCRIPTION.ledger;

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
        let each = |a: usize| BodyForce::sum(forces, bodies[a], &Vector::<D>::zeros(), time);
        self.gravity.write(&mut self.machine, (time, forces), bodies.len(), each)
    }

    fn run(
        &mut self,
        pass: Pass<Own<D, P>>,
        Instant { time, step }: Instant,
        totals: &mut Totals,
    ) -> Result<(), DeviceError> {
        match pass {
            Pass::Remove => {
                totals.book(P::Kind::REMOVED, &self.remove_escaped()?);
                Ok(())
            }
            Pass::Prescribe => {
                let held = self.matter.prescribe(&mut self.machine, time)?;
                held.iter().for_each(|total| totals.book(P::Kind::WALLS, total));
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
                if let Some(moving) = &mut self.moving {
                    moving.write(&mut self.machine, time)?;
                }
                self.start("walls", &[])
            }
            Pass::Rates => {
                if self.matter.plan().falls {
                    self.fall(time)?;
                }
                self.launch(pass, &[])
            }
            Pass::Move => {
                self.start("advance", &[("step", step)])?;
                self.is_picked = false;
                self.moving.iter_mut().for_each(|moving| moving.drift(step, time));
                let sums = self.machine.sums(drift_terms(D), self.count)?;
                let mut drift = Drift::ZERO;
                let (powers, impulse) = sums.split_at(DRIFTING);
                drift.iter_mut().zip(powers).for_each(|(total, power)| total.power = *power);
                let [_, transport, ..] = &mut drift;
                transport.force[..impulse.len()].copy_from_slice(impulse);
                let entries = P::Kind::DRIFTING;
                for (entry, sum) in entries.iter().zip(&drift) {
                    entry.iter().for_each(|entry| totals.book(*entry, sum));
                }
                Ok(())
            }
            Pass::Push => self.launch(pass, &[("step", step)]),
            // Fluids with corrected gradients have forces of their own. Body forces are set once an instant.
            Pass::Forces | Pass::Own(_) => {
                self.fall(time)?;
                self.launch(pass, &[])
            }
            Pass::Shift => {
                let (scale, most) = self.speed.of(self.fastest);
                self.launch(pass, &[("scale", scale), ("most", most)])
            }
            Pass::Store => {
                self.launch(pass, &[])?;
                let stored = self.matter.plan().stored_terms::<P::Kind>();
                let sums = self.machine.sums(stored, self.count)?;
                let (mut kick, mut sums) = (Kick::ZERO, sums.into_iter());
                let components = momentum_components(D).len();
                for (total, entry) in kick.iter_mut().zip(P::Kind::ACCELERATING) {
                    total.power = sums.next().unwrap_or_default();
                    total.growth = sums.next().unwrap_or_default();
                    let entering = total.force.iter_mut().take(components);
                    if entry.is_some_and(|entry| entry.way.is_some()) {
                        entering.zip(&mut sums).for_each(|(force, sum)| *force = sum);
                    }
                }
                for (entry, sum) in P::Kind::ACCELERATING.iter().zip(&kick) {
                    entry.iter().for_each(|entry| totals.drive(*entry, sum));
                }
                // A pressure that follows from the density changes at once.
                if let (Some(before), Some(after)) = (sums.next(), sums.next()) {
                    let [pressure, ..] = P::Kind::DRIFTING;
                    let gained = Total::of(after - before);
                    pressure.iter().for_each(|entry| totals.book(*entry, &gained));
                }
                Ok(())
            }
            _ => self.launch(pass, &[]),
        }
    }

    /// Where particles may be, if that changes.
    fn room(&self) -> Vec<(&'static str, f64)> {
        self.moving.as_ref().map_or_else(Vec::new, Moving::room)
    }

    fn kick(&mut self, duration: f64) -> Result<(), DeviceError> {
        self.start("kick_velocities", &[("duration", duration)])?;
        Self::LEDGER.kick(D, duration, &mut self.state.tail);
        Ok(())
    }
}

impl<const D: usize, P: OfMatter<D>> DeviceSteps for OnDevice<D, P> {
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
        Self::LEDGER.add(D, &done?, &mut self.state.tail);
        if let Some(moving) = &mut self.moving {
            moving.write(&mut self.machine, time + step)?;
            self.start("impose", &[])?;
        }
        if let Some(held) = self.matter.prescribe(&mut self.machine, time + step)? {
            let mut totals = Totals::default();
            totals.book(P::Kind::WALLS, &held);
            Self::LEDGER.add(D, &totals, &mut self.state.tail);
        }
        let mut stages = std::mem::take(&mut self.accelerate);
        let done = stages.attempt(|pass, totals| self.run(pass, end, totals));
        self.accelerate = stages;
        Self::LEDGER.keep(D, &done?, &mut self.state.tail);
        Ok(self.kick(0.5 * step)?)
    }

    #[inline(never)]
    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError> {
        let plan = self.matter.plan();
        let asks = plan.room.is_some() && !plan.removes;
        if asks && !self.is_picked {
            self.load()?;
        }
        self.launch_look()?;
        let health = self.matter.judge(&mut self.machine, self.count, limits)?;
        let is_whole = health.first_not_finite.is_none();
        Ok(Health { first_escaped: health.first_escaped.filter(|_| asks && is_whole), ..health })
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
