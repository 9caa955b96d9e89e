//! Steps of several systems that act on each other.

use super::failure::Failure;
use super::integrator::{Integrator, Unserved};
use super::kick_drift_kick::KickDriftKick;
use crate::parallel;
use crate::schemes::Scheme;

/// A fluid by kick-drift-kick, and each solid in it by an integrator of its own, each as often as its stable step asks
/// for: theory (82).
pub struct Coupled {
    solids: Vec<Box<dyn Integrator>>,
    /// The states of a solid at both ends of one of its steps.
    old: Vec<f64>,
    new: Vec<f64>,
    /// Steps of each system in the last one, the fluid first.
    counts: Vec<u64>,
    /// What failures have multiplied steps by.
    factor: f64,
}

impl Coupled {
    /// With the integrators of the solids.
    pub fn new(solids: Vec<Box<dyn Integrator>>) -> Self {
        Self { solids, old: Vec::new(), new: Vec::new(), counts: Vec::new(), factor: 1.0 }
    }
}

impl Integrator for Coupled {
    fn name(&self) -> &'static str {
        KickDriftKick::NAME
    }

    fn evaluations(&self, _scheme: &mut dyn Scheme) -> u64 {
        1
    }

    fn evaluations_by_system(&self, scheme: &mut dyn Scheme) -> Vec<u64> {
        // One of the fluid is a kick, a drift and a kick.
        let mut all = vec![scheme.divided().map_or(0, |fluid| fluid.particle_count() as u64)];
        if let Some(world) = scheme.coupled() {
            let solids = self.solids.iter().enumerate();
            all.extend(solids.map(|(number, solid)| {
                let (scheme, _) = world.solid(number);
                solid.evaluations(scheme) * scheme.particle_count() as u64
            }));
        }
        all
    }

    fn steps_in_last(&self) -> &[u64] {
        &self.counts
    }

    fn shorten(&mut self, factor: f64) {
        self.factor = factor;
    }

    fn renewed(&self, scheme: &mut dyn Scheme) -> Option<Box<dyn Integrator>> {
        let world = scheme.coupled()?;
        let solids = self.solids.iter().enumerate();
        let solids = solids.map(|(number, solid)| solid.renewed(world.solid(number).0));
        Some(Box::new(Self::new(solids.collect::<Option<_>>()?)))
    }

    fn step(
        &mut self,
        scheme: &mut dyn Scheme,
        time: f64,
        step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<(), Failure> {
        let name = self.name();
        if scheme.coupled().is_none_or(|world| world.solid_count() != self.solids.len()) {
            return Err(Unserved::new(name, scheme).into());
        }
        let Some(world) = scheme.coupled() else { return Ok(()) };
        // Where failures have made steps shorter, those within are as much shorter.
        let whole = step / self.factor;
        self.counts.clear();
        self.counts.push(world.fluid_steps(whole));
        self.counts.extend((0..self.solids.len()).map(|number| world.solid_steps(number, whole)));
        parallel::copy(new, old);
        world.push([time, step], &self.counts, new);
        world.settle(time, new);
        for (number, integrator) in self.solids.iter_mut().enumerate() {
            let count = self.counts[number + 1];
            let (_, part) = world.solid(number);
            self.old.clear();
            self.old.extend_from_slice(&new[part.clone()]);
            self.new.resize(part.len(), 0.0);
            let own = step / count as f64;
            for k in 0..count {
                let begin = time + k as f64 * own;
                if k > 0 {
                    world.push_on(number, [begin, own], &mut self.old, new);
                }
                let (solid, _) = world.solid(number);
                integrator.step(solid, begin, own, &self.old, &mut self.new)?;
                std::mem::swap(&mut self.old, &mut self.new);
            }
            new[part].copy_from_slice(&self.old);
        }
        world.flow([time, step], &self.counts, old, new);
        world.repay([time, step], &self.counts, new);
        world.add_up(&self.counts, new);
        Ok(())
    }
}
