//! One implicit step of a body in motion: statics with inertia.

use super::{Statics, StaticsError};
use crate::solve::{Equations, NewtonError};
use crate::{Vector, parallel};

/// A step whose forces are to balance inertia, theory (53).
#[derive(Clone, Copy, Debug)]
pub struct InertialStep<'a, const D: usize> {
    /// Instant at which they do in s.
    pub time: f64,
    /// Start and end of the step in s.
    pub ends: [f64; 2],
    /// Acceleration per displacement in 1/s^2.
    pub stiffening: f64,
    /// Displacements without acceleration in m.
    pub free: &'a [Vector<D>],
    /// Displacements to start from in m, with the values of held components.
    pub start: &'a [Vector<D>],
    /// Displacements at the start of the step in m, to start from where others do not do.
    pub last: &'a [Vector<D>],
}

/// What inertia adds to the equations of a step.
#[derive(Clone)]
pub(super) struct Inertia<const D: usize> {
    /// Acceleration per displacement in 1/s^2.
    stiffening: f64,
    /// Displacements without acceleration in m.
    free: Vec<Vector<D>>,
    /// Values of held components in their frames, m.
    pub held: Vec<Vector<D>>,
    /// Square of the force that the motion alone would take to be stopped within the step, N^2.
    pub size: f64,
}

impl<const D: usize> Inertia<D> {
    /// Force of inertia on a particle of a mass in kg at its displacement u, N.
    pub fn force(&self, mass: f64, a: usize, u: &Vector<D>) -> Vector<D> {
        (self.free[a] - u) * (self.stiffening * mass)
    }

    /// Its potential in J.
    pub fn potential(&self, mass: f64, a: usize, u: &Vector<D>) -> f64 {
        0.5 * self.stiffening * mass * (self.free[a] - u).norm_squared()
    }
}

impl<const D: usize> Statics<D> {
    /// The displacements in m at which forces balance inertia, and the iterations they took.
    ///
    /// What is left is measured against loads, reactions, and the force that would stop the motion
    /// within the step, so that what is left of a displacement is small against that of the step.
    ///
    /// # Errors
    /// [`StaticsError`] where none are found.
    pub fn march(
        &mut self,
        step: &InertialStep<'_, D>,
    ) -> Result<(Vec<Vector<D>>, usize), StaticsError> {
        let InertialStep { time, ends: [reached, end], stiffening, free, start, last } = *step;
        let held = (0..start.len()).map(|a| self.supports.frame(a).tr_mul(&start[a])).collect();
        let stopped = |a: usize| {
            let mass = self.discrete.solid.mass[a];
            ((free[a] - last[a]) * (stiffening * mass)).norm_squared()
        };
        let size = parallel::sum(free.len(), stopped);
        self.solver.restart();
        self.stiffness.accelerate(stiffening);
        self.inertia = Some(Inertia { stiffening, free: free.to_vec(), held, size });
        let mut x = self.collect(start);
        if self.trial(time, &x).broken.is_some() {
            x = self.collect(last);
        }
        let newton = self.newton;
        let found = newton.find(self, time, &mut x, Vec::new());
        let found = found.map_err(|source| self.missed(end, reached, source))?;
        // The residual that was found small was that of these.
        Ok((self.displacement[..self.left.len()].to_vec(), found.iterations.len()))
    }

    fn missed(&self, time: f64, reached: f64, source: NewtonError) -> StaticsError {
        let (worst, force) = self.most_left();
        let broken = match source {
            NewtonError::Broken { particle, .. } => Some(particle),
            _ => None,
        };
        let particle = broken.unwrap_or(worst);
        let particles = &self.discrete.solid.particles;
        let id = particles.id[particle];
        let position = particles.position[particle].iter().copied().collect();
        match broken {
            Some(_) => StaticsError::Collapsed { id, position, time, reached },
            None => StaticsError::Step { id, position, time, reached, force, source },
        }
    }
}
