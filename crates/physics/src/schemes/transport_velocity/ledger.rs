//! Energies, and what each mechanism does to them and to momentum.
//!
//! A kick of duration s with the acceleration `a = sum_k a_k` changes the kinetic energy by
//! `sum_k s (P_k + s/2 Q_k)` with `P_k = sum m a_k . u` and `Q_k = sum m a_k . a`, and the momentum
//! by `s sum m a_k`: exactly, and mechanism by mechanism, theory (35).

use super::{Common, Continuum};
use crate::schemes::ledger::Total;
use crate::schemes::momentum::{add_moments, moments};
use crate::{Vector, parallel};

/// Number of the accelerations that are told apart.
pub(super) const ACCELERATIONS: usize = 6;

/// Sums over particles that a kick needs, by mechanism.
pub(super) type Kick = [Total; ACCELERATIONS];

/// Number of the mechanisms of a drift: pressure, transport and those of the matter.
pub(super) const DRIFTING: usize = 4;

/// Sums over particles of what a drift does, by mechanism.
pub type Drift = [Total; DRIFTING];

impl<const D: usize> Common<D> {
    /// Kinetic energy in J.
    pub(super) fn kinetic_energy(&self, state: &[f64]) -> f64 {
        let at = self.columns(state);
        parallel::sum(self.particles.len(), |number| match self.is_wall[number] {
            true => 0.0,
            false => 0.5 * self.mass[number] * at.velocity[number].norm_squared(),
        })
    }

    /// Adds power and force of the accelerations of a particle, at a place.
    #[inline]
    pub(super) fn add_powers<M: Continuum<D>>(
        &self,
        (number, place): (usize, usize),
        [position, velocity]: [&Vector<D>; 2],
        sums: &mut Kick,
    ) {
        let (forces, mass) = (&self.forces[place], self.mass[number]);
        let (total, zero) = (forces.total(), Vector::<D>::zeros());
        for ((term, sum), entry) in forces.terms().into_iter().zip(sums).zip(M::ACCELERATING) {
            // What acts nowhere costs nothing.
            if *term != zero {
                sum.power += mass * term.dot(velocity);
                sum.growth += mass * term.dot(&total);
                if entry.is_some_and(|entry| entry.way.is_some()) {
                    add_moments(position, &(term * mass), &mut sum.force);
                }
            }
        }
    }

    /// Adds what a drift of `step` s of a particle (number) does to angular momentum: it moves across its
    /// velocity, both as before.
    #[inline]
    pub(super) fn add_turning(
        &self,
        number: usize,
        step: f64,
        [velocity, deviation]: [&Vector<D>; 2],
        sums: &mut Drift,
    ) {
        let momentum = velocity * (step * self.mass[number]);
        let (moments, count) = moments(deviation, &momentum);
        let [_, transport, ..] = sums;
        let angular = transport.force.iter_mut().zip(&moments).take(count).skip(D);
        angular.for_each(|(sum, moment)| *sum += moment);
    }
}
