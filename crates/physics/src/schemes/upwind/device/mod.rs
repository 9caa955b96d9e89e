//! Steps of an upwind body on a device, by Runge-Kutta methods or, where nothing dissipates, kicks and drifts.
//!
//! The passes are those of the processor: gathers of the same pair laws over the same rows, with the same laws of one
//! particle between them. Tractions and prescribed motion, which act on few particles, the processor finds.

mod build;
mod passes;

use piola_device::{DeviceError, Machine};

use self::passes::{FIGURES, Method, Plan, shown};
use super::inspect::{Bounds, LEAST};
use super::passes::Pass;
use super::{BODY_FORCE, BOUNDARY_MOTION, LEDGER, TRACTION, UPWIND_PRESSURE, UPWIND_VELOCITY};
use crate::Vector;
use crate::boundaries::BodyForce;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::geometry::Particles;
use crate::schemes::blend::{BlendStage, advance};
use crate::schemes::device::solid;
use crate::schemes::device::{DeviceSteps, Gravity, Listed, StateColumns, sighted};
use crate::schemes::ledger::{Total, Totals};
use crate::schemes::momentum::momentum_components;
use crate::schemes::stages::{Phase, Stages};
use crate::schemes::{Health, StepLimit, StepsError};

/// An upwind body on a device.
struct OnDevice<const D: usize> {
    plan: Plan<D>,
    machine: Machine,
    state: StateColumns,
    /// What an evaluation is made of.
    stages: Stages<Pass>,
    particles: Particles<D>,
    body_forces: Vec<BodyForce<D>>,
    listed: Listed<D>,
    prescribed: PrescribedComponents,
    limits: Bounds,
    /// Rates of the ledger.
    rate: Vec<f64>,
    gravity: Gravity,
    /// Whether accelerations are those of the places.
    is_rated: bool,
}

impl<const D: usize> OnDevice<D> {
    fn start(&self, pass: &str, scalars: &[(&str, f64)]) -> Result<(), DeviceError> {
        self.machine.start(pass, self.particles.len(), scalars)
    }

    /// Sets the body force of each particle, where it changes.
    fn fall(&mut self, time: f64) -> Result<(), DeviceError> {
        if !self.plan.is_pulled {
            return Ok(());
        }
        let (forces, particles) = (&self.body_forces, &self.particles);
        let each = |a| BodyForce::sum(forces, particles.body[a], &particles.position[a], time);
        self.gravity.write(&mut self.machine, (time, forces), particles.len(), each)
    }

    fn run(&mut self, pass: Pass, time: f64, totals: &mut Totals) -> Result<(), DeviceError> {
        match pass {
            Pass::BodyForces => self.fall(time),
            Pass::Local => self.start("sides", &[]),
            Pass::Slopes => self.start("slopes", &[]),
            Pass::Pairs => {
                self.fall(time)?;
                self.start("exchange", &[])?;
                let sums = self.machine.sums(passes::terms(D), self.particles.len())?;
                let mut body = Total::of(sums[0]);
                let components = momentum_components(D).len();
                body.force[..components].copy_from_slice(&sums[1..][..components]);
                totals.drive(BODY_FORCE, &body);
                totals.drive(UPWIND_VELOCITY, &Total::of(sums[1 + components]));
                totals.drive(UPWIND_PRESSURE, &Total::of(sums[2 + components]));
                Ok(())
            }
            Pass::Boundary => self.act(time, totals),
        }
    }

    /// Lets the processor change the accelerations of those particles on which something acts.
    fn act(&mut self, time: f64, totals: &mut Totals) -> Result<(), DeviceError> {
        let listed = &mut self.listed;
        let width = solid::width(&shown::<D>());
        let all = listed.shown(&self.machine, width)?;
        for (row, shown) in all.chunks_exact(width).enumerate() {
            let [acceleration, position, velocity] =
                [0, 1, 2].map(|k| Vector::from_column_slice(&shown[k * D..][..D]));
            listed.acceleration[row] = acceleration;
            listed.position[row] = position;
            listed.velocity[row] = velocity;
        }
        let acting = listed.act(time);
        listed.give(&mut self.machine, &listed.acceleration)?;
        totals.drive(TRACTION, &acting.traction);
        totals.drive(BOUNDARY_MOTION, &acting.motion);
        Ok(())
    }

    /// Rates of the state at a time.
    fn evaluate(&mut self, time: f64) -> Result<(), DeviceError> {
        let mut stages = std::mem::take(&mut self.stages);
        let totals = stages.attempt(|pass, totals| self.run(pass, time, totals));
        self.stages = stages;
        LEDGER.write(D, &totals?, &mut self.rate);
        Ok(())
    }

    fn by_stages(
        &mut self,
        [time, step]: [f64; 2],
        method: &[BlendStage],
    ) -> Result<(), DeviceError> {
        let mut at = time;
        for stage in method {
            self.evaluate(at)?;
            self.start(stage.name, &[("step", step)])?;
            self.state.advance_tail(|old, new| advance(stage.blend, step, old, &self.rate, new));
            at = time + stage.at * step;
            self.constrain(at)?;
        }
        Ok(())
    }

    /// As the kick-drift-kick method does with what is partitioned.
    fn by_kicks(&mut self, [time, step]: [f64; 2]) -> Result<(), DeviceError> {
        let half = 0.5 * step;
        if !self.is_rated {
            self.evaluate(time)?;
        }
        self.start("kick_velocities", &[("duration", half)])?;
        self.constrain(time + half)?;
        self.evaluate(time)?;
        self.account(half);
        self.start("drift", &[("step", step)])?;
        self.evaluate(time + step)?;
        self.account(half);
        self.start("kick_velocities", &[("duration", half)])?;
        self.constrain(time + step)?;
        self.is_rated = true;
        Ok(())
    }

    /// Carries the ledger on with its rates.
    fn account(&mut self, duration: f64) {
        for (integral, power) in self.state.tail.iter_mut().zip(&self.rate) {
            *integral += duration * power;
        }
    }

    /// Gives velocities that are prescribed their values of a time.
    fn constrain(&mut self, time: f64) -> Result<(), DeviceError> {
        let values = self.prescribed.iter().map(|entry| entry.at(time));
        let values: Vec<f64> = values.collect();
        if values.is_empty() {
            return Ok(());
        }
        self.machine.write("value", &values)?;
        self.machine.start("impose", values.len(), &[])
    }
}

impl<const D: usize> DeviceSteps for OnDevice<D> {
    #[inline(never)]
    fn put(&mut self, state: &[f64]) -> Result<(), StepsError> {
        self.is_rated = false;
        Ok(self.state.put(&mut self.machine, state)?)
    }

    #[inline(never)]
    fn step(&mut self, time: f64, step: f64) -> Result<(), StepsError> {
        self.state.mark(&mut self.machine)?;
        match self.plan.method {
            Method::RungeKutta(stages) => self.by_stages([time, step], stages)?,
            Method::Kicks => self.by_kicks([time, step])?,
        }
        Ok(())
    }

    #[inline(never)]
    fn inspect(&mut self, limits: &mut Vec<StepLimit>) -> Result<Health, StepsError> {
        self.start("look", &[])?;
        let all = self.machine.largest::<FIGURES>(self.particles.len())?;
        let (health, figures) = sighted(&all, LEAST);
        self.limits.write(figures, limits);
        Ok(health)
    }

    fn fetch(&self, state: &mut [f64]) -> Result<(), StepsError> {
        Ok(self.state.give(&self.machine, state)?)
    }

    fn fetch_before(&self, state: &mut [f64]) -> Result<(), StepsError> {
        Ok(self.state.give_before(&self.machine, state)?)
    }

    fn phases(&self) -> Vec<&Phase> {
        vec![self.stages.phase()]
    }
}
