//! Steps of a solid on a device.
//!
//! The passes are those of the processor: gathers of the same pair laws over the same rows, with the same stresses. What
//! acts on few particles only, the processor finds, see [`Followed`].

mod build;
mod listed;
mod passes;

use std::sync::Arc;

use piola_device::{DeviceError, Machine};

use self::listed::Followed;
use self::passes::{DATA, FIGURES, Plan};
use super::fields::Columns;
use super::stable_step::Bound;
use super::stages::Pass;
use super::{
    BODY_FORCE, BOUNDARY_MOTION, DAMPING, LEDGER, Loads, PRESSURE, SPRING, Solid, TRACTION,
    VISCOSITY,
};
use crate::Vector;
use crate::operators::{Image, PlaneData};
use crate::parallel::{Reduce as _, Team};
use crate::schemes::device::solid;
use crate::schemes::device::{Acting, DeviceSteps, Gravity, StateColumns, sighted};
use crate::schemes::ledger::{Total, Totals};
use crate::schemes::momentum::momentum_components;
use crate::schemes::stages::{Phase, Stages};
use crate::schemes::{Health, StepLimit, StepsError};

/// A solid on a device.
struct OnDevice<const D: usize> {
    plan: Plan<D>,
    machine: Machine,
    state: StateColumns,
    stages: Stages<Pass>,
    solid: Arc<Solid<D>>,
    loads: Loads<D>,
    followed: Followed<D>,
    images: Vec<Image<D>>,
    stable: Bound,
    gravity: Gravity,
    /// Whether gradients are those of the displacements.
    is_evaluated: bool,
    /// Whether a material was seen to have lost its convexity when the state was looked at last.
    is_soft: bool,
}

impl<const D: usize> OnDevice<D> {
    fn count(&self) -> usize {
        self.solid.len()
    }

    fn start(&self, pass: &str, scalars: &[(&str, f64)]) -> Result<(), DeviceError> {
        self.machine.start(pass, self.count(), scalars)
    }

    /// Writes the values of images behind those of particles.
    fn carry(&self, pass: &str, data: &PlaneData<D>) -> Result<(), DeviceError> {
        let scalars: Vec<(&str, f64)> =
            DATA.iter().zip(data.as_flattened()).map(|(name, datum)| (*name, *datum)).collect();
        self.machine.start(pass, self.images.len(), &scalars)
    }

    /// Displacements, and velocities where stresses depend on them, with their values beyond planes.
    fn load(&self) -> Result<(), DeviceError> {
        if !self.plan.has_images {
            return Ok(());
        }
        let followed = &self.followed;
        self.carry("carry_displacements", &followed.plane_data(&followed.displacement))?;
        if self.plan.viscosity.is_some() {
            self.carry("carry_velocities", &followed.plane_data(&followed.listed.velocity))?;
        }
        Ok(())
    }

    /// Sets the body force of each particle, where it changes.
    fn fall(&mut self, time: f64) -> Result<(), DeviceError> {
        if !self.plan.is_pulled {
            return Ok(());
        }
        let (loads, solid) = (&self.loads, &*self.solid);
        let forces = (time, &*loads.body_forces);
        let each = |a| loads.acceleration(solid, a, time);
        self.gravity.write(&mut self.machine, forces, solid.len(), each)
    }

    fn run(&mut self, pass: Pass, time: f64, totals: &mut Totals) -> Result<(), DeviceError> {
        match pass {
            Pass::Load => self.load(),
            Pass::Rates => self.start("rates", &[]),
            Pass::Strains => self.start("strains", &[]),
            Pass::Forces => {
                self.machine.start("forces", self.count() + self.images.len(), &[])?;
                if self.plan.has_images { self.start("fold_forces", &[]) } else { Ok(()) }
            }
            Pass::External => self.external(time, totals),
            // Those of the strong form, which is refused.
            Pass::Gradients | Pass::Stresses | Pass::Tensions => Ok(()),
        }
    }

    /// What acts from outside, and the ledger.
    fn external(&mut self, time: f64, totals: &mut Totals) -> Result<(), DeviceError> {
        self.fall(time)?;
        self.start("external", &[])?;
        let mut acting = self.act(time)?;
        let terms = match self.plan.terms() {
            0 => Vec::new(),
            terms => {
                self.start("powers", &[])?;
                self.machine.sums(terms, self.count())?
            }
        };
        let mut terms = terms.into_iter();
        let mut next = || terms.next().unwrap_or_default();
        let mut driven = |is_on: bool, grows: bool| {
            let mut total = Total::default();
            if is_on {
                total.power = next();
                total.growth = if grows { next() } else { 0.0 };
                total.force[..momentum_components(D).len()].fill_with(&mut next);
            }
            total
        };
        let body = driven(self.plan.is_pulled, true);
        let mut dragged = driven(self.plan.damping > 0.0, true);
        dragged.growth *= -self.plan.damping;
        let beyond = driven(self.plan.has_images, false);
        acting.motion.force.add(&beyond.force);
        acting.motion.power += self.plane_power()?;
        totals.drive(BODY_FORCE, &body);
        totals.drive(DAMPING, &dragged);
        totals.drive(VISCOSITY, &Total::of(next()));
        totals.drive(SPRING, &Total::default());
        totals.drive(TRACTION, &acting.traction);
        totals.drive(PRESSURE, &acting.pressure);
        totals.drive(BOUNDARY_MOTION, &acting.motion);
        Ok(())
    }

    /// Lets the processor change the accelerations of those particles on which something acts.
    fn act(&mut self, time: f64) -> Result<Acting, DeviceError> {
        let listed = &mut self.followed.listed;
        let width = solid::width(&self.plan.shown());
        let shown = listed.shown(&self.machine, width)?;
        for (row, shown) in shown.chunks_exact(width).enumerate() {
            let (kick, gradient) = shown.split_at(D);
            listed.acceleration[row].copy_from_slice(kick);
            for (entry, value) in gradient.iter().enumerate() {
                listed.gradient[row][(entry / D, entry % D)] = *value;
            }
        }
        let acting = self.followed.act(time);
        let listed = &self.followed.listed;
        listed.give(&mut self.machine, &listed.acceleration)?;
        Ok(acting)
    }

    /// The power of planes that move, with the forces on images.
    fn plane_power(&self) -> Result<f64, DeviceError> {
        let rates = self.followed.plane_data(&self.followed.listed.velocity);
        if rates.as_flattened().iter().all(|rate| *rate == 0.0) {
            return Ok(0.0);
        }
        let slots = self.count() + self.images.len();
        let mut force = vec![0.0; slots * D];
        self.machine.device().read(self.machine.column("force"), &mut force)?;
        let behind = force[self.count() * D..].chunks_exact(D).map(Vector::<D>::from_column_slice);
        let pairs = behind.zip(&self.images);
        Ok(-Team::default().total(pairs.map(|(force, image)| force.dot(&image.carried(&rates)))))
    }

    /// Accelerations at a time, which are kept for the next kick.
    fn evaluate(&mut self, time: f64) -> Result<(), DeviceError> {
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.attempt(|pass, totals| self.run(pass, time, totals));
        self.stages = stages;
        LEDGER.keep(D, &totals?, &mut self.state.tail);
        self.is_evaluated = true;
        Ok(())
    }

    /// Places and velocities that are prescribed.
    fn follow(&mut self) -> Result<(), DeviceError> {
        let Followed { listed, displacement, .. } = &self.followed;
        if listed.prescribed.is_empty() {
            return Ok(());
        }
        let rows = displacement.iter().zip(&listed.velocity);
        let moved = rows.flat_map(|(place, velocity)| place.iter().chain(velocity).copied());
        let moved: Vec<f64> = moved.collect();
        self.machine.write("moved", &moved)?;
        self.machine.start("follow", self.followed.listed.len(), &[])
    }
}

impl<const D: usize> DeviceSteps for OnDevice<D> {
    #[inline(never)]
    fn put(&mut self, state: &[f64]) -> Result<(), StepsError> {
        self.is_evaluated = false;
        self.followed.put(&Columns::of(state, self.solid.len()));
        Ok(self.state.put(&mut self.machine, state)?)
    }

    #[inline(never)]
    fn step(&mut self, time: f64, step: f64) -> Result<(), StepsError> {
        let half = 0.5 * step;
        self.state.mark(&mut self.machine)?;
        self.start("kick_and_drift", &[("duration", half), ("step", step)])?;
        LEDGER.kick(D, half, &mut self.state.tail);
        self.followed.kick(half);
        self.followed.drift(time, step);
        self.follow()?;
        self.evaluate(time + step)?;
        self.start("kick_velocities", &[("duration", half)])?;
        LEDGER.kick(D, half, &mut self.state.tail);
        self.followed.kick(half);
        Ok(())
    }

    #[inline(never)]
    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError> {
        if !self.is_evaluated {
            self.load()?;
        }
        if self.plan.is_quadratic {
            // Of the velocities of the moment.
            if self.is_evaluated {
                self.load()?;
            }
            self.start("rates_of_moment", &[])?;
        }
        if !self.is_evaluated {
            self.start("strains", &[])?;
        }
        self.start("look", &[])?;
        let all = self.machine.largest::<FIGURES>(self.count())?;
        let least = [0.0, 0.0, f64::NEG_INFINITY];
        let (health, [stiffening, thickening, softening]) = sighted(&all, least);
        self.is_soft = softening.value > 0.0;
        limits.clear();
        limits.push(self.stable.limit(stiffening, thickening, self.solid.is_linear()));
        Ok(health)
    }

    fn fetch(&self, state: &mut [f64]) -> Result<(), StepsError> {
        Ok(self.state.give(&self.machine, state)?)
    }

    fn fetch_before(&self, state: &mut [f64]) -> Result<(), StepsError> {
        Ok(self.state.give_before(&self.machine, state)?)
    }

    fn warns(&self) -> bool {
        self.is_soft
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.stages.phase()]
    }
}
