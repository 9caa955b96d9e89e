//! Energies, and what each mechanism does to them and to momentum.
//!
//! A kick of duration s with the acceleration `a = sum_k a_k` changes the kinetic energy by
//! `sum_k s (P_k + s/2 Q_k)` with `P_k = sum m a_k . u` and `Q_k = sum m a_k . a`, and the momentum
//! by `s sum m a_k`: exactly, and mechanism by mechanism, theory (35).

use super::{ACCELERATING, DRIFTING, TransportVelocity};
use crate::schemes::ledger::Total;
use crate::schemes::momentum::{add_moments, moments};
use crate::{Vector, parallel};

/// Sums over particles that a kick needs, by mechanism.
pub(super) type Kick = [Total; ACCELERATING.len()];

/// Sums over particles of what a drift does.
pub(super) type Drift = [Total; DRIFTING.len()];

impl<const D: usize> TransportVelocity<D> {
    /// Kinetic energy of the fluid in J.
    pub(super) fn kinetic_energy(&self, state: &[f64]) -> f64 {
        let at = self.columns(state);
        parallel::sum(self.particles.len(), |number| match self.is_wall[number] {
            true => 0.0,
            false => 0.5 * self.mass[number] * at.velocity[number].norm_squared(),
        })
    }

    /// Energy of compression in J: `sum m p^2 / (2 rho0^2 c^2)`.
    pub(super) fn compression_energy(&self, state: &[f64]) -> f64 {
        let (stiffness, at) = (self.compliance(), self.columns(state));
        parallel::sum(self.particles.len(), |number| match self.is_wall[number] {
            true => 0.0,
            false => {
                let pressure = at.pressure[number];
                0.5 * self.mass[number] * stiffness * pressure * pressure
            }
        })
    }

    /// `1 / (rho0 c)^2`.
    pub(super) fn compliance(&self) -> f64 {
        (self.fluid.density * self.fluid.wave_speed).powi(-2)
    }

    /// Adds power and force of the accelerations of a particle of the fluid, at a place.
    #[inline]
    pub(super) fn add_powers(
        &self,
        (number, place): (usize, usize),
        [position, velocity]: [&Vector<D>; 2],
        sums: &mut Kick,
    ) {
        let (forces, mass) = (&self.forces[place], self.mass[number]);
        let (total, zero) = (forces.total(), Vector::<D>::zeros());
        for ((term, sum), entry) in forces.terms().into_iter().zip(sums).zip(ACCELERATING) {
            // What acts nowhere costs nothing.
            if *term != zero {
                sum.power += mass * term.dot(velocity);
                sum.growth += mass * term.dot(&total);
                if entry.way.is_some() {
                    add_moments(position, &(term * mass), &mut sum.force);
                }
            }
        }
    }

    /// Adds what a drift of `step` s does to a particle of the fluid, at a place: to the energy of
    /// compression, and to angular momentum, by particles that move across their velocity. Pressure,
    /// velocity and deviation are as before; `diffuses` says whether the pressure drifts.
    #[inline]
    pub(super) fn add_drift(
        &self,
        (number, place): (usize, usize),
        (step, diffuses): (f64, bool),
        (pressure, velocity, deviation): (f64, &Vector<D>, &Vector<D>),
        sums: &mut Drift,
    ) {
        let mass = self.mass[number];
        if diffuses {
            let (rates, compliance) = (self.pressure_rates(place), self.compliance());
            let mean = pressure + 0.5 * step * rates.iter().sum::<f64>();
            for (sum, rate) in sums.iter_mut().zip(rates) {
                sum.power += step * mass * compliance * mean * rate;
            }
        }
        let momentum = velocity * (step * mass);
        let (moments, count) = moments(deviation, &momentum);
        let [_, transport, ..] = sums;
        let angular = transport.force.iter_mut().zip(&moments).take(count).skip(D);
        angular.for_each(|(sum, moment)| *sum += moment);
    }
}
