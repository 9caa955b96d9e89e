//! Energies and momentum, and what each mechanism does to them.
//!
//! A kick of duration s with the acceleration `a = sum_k a_k` changes the kinetic energy by
//! `sum_k s (P_k + s/2 Q_k)` with `P_k = sum m a_k . u` and `Q_k = sum m a_k . a`, and the momentum
//! by `s sum m a_k`: exactly, and mechanism by mechanism, theory (35). These sums stand at the end of the state.

use std::ops::Range;

use super::{
    ACCELERATING, ENTERING, IMPULSES, MECHANISMS, PLASTICITY, PRESSURE, PRESSURE_DIFFUSION,
    TRANSPORT, TransportVelocity,
};
use crate::schemes::momentum::{self, MOST_COMPONENTS};
use crate::schemes::momentum_components;
use crate::{Vector, parallel};

/// Where the sums over all particles stand behind the columns of a state.
pub(super) struct Tail {
    /// Components of momentum.
    components: usize,
}

/// Sums over particles that a kick needs.
type Kick = [f64; 2 * ACCELERATING + ENTERING * MOST_COMPONENTS];

/// Sums over particles that a drift needs: what pressure, transport, diffusion and plasticity do to
/// energies in J, then impulses.
pub(super) type Drift = [f64; DRIFTING + MOST_COMPONENTS];

/// The mechanisms of a drift.
const DRIFTING: usize = 4;

impl Tail {
    pub fn new(dimension: usize) -> Self {
        Self { components: momentum_components(dimension).len() }
    }

    fn after(start: usize, length: usize) -> Range<usize> {
        start..start + length
    }

    /// Impulse so far, by way in and component.
    fn impulses(&self) -> Range<usize> {
        Self::after(MECHANISMS.len(), IMPULSES.len() * self.components)
    }

    /// `P_k`, then `Q_k`, then the force of each way in by component.
    fn kick(&self) -> Range<usize> {
        Self::after(self.impulses().end, 2 * ACCELERATING + ENTERING * self.components)
    }

    /// Where the number of passes of the last shifting stands.
    pub fn passes(&self) -> usize {
        self.kick().end
    }

    /// Numbers behind the columns.
    pub fn length(&self) -> usize {
        self.passes() + 1
    }

    /// Books the `energy` in J of a mechanism and the momentum `momentum` that came in by a `way`, at
    /// `position`.
    pub fn book<const D: usize>(
        &self,
        (mechanism, energy): (usize, f64),
        way: usize,
        position: &Vector<D>,
        momentum: &Vector<D>,
        tail: &mut [f64],
    ) {
        tail[mechanism] += energy;
        let kept = &mut tail[self.impulses()][way * self.components..][..self.components];
        momentum::add_moments(position, momentum, kept);
    }
}

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

    /// Momentum of the fluid, by component.
    pub(super) fn momentum_of(&self, state: &[f64]) -> [f64; MOST_COMPONENTS] {
        let at = self.columns(state);
        parallel::sums(self.particles.len(), |number, sums| {
            if !self.is_wall[number] {
                let momentum = at.velocity[number] * self.mass[number];
                momentum::add_moments(&at.position[number], &momentum, sums);
            }
        })
    }

    /// `1 / (rho0 c)^2`.
    pub(super) fn compliance(&self) -> f64 {
        (self.fluid.density * self.fluid.wave_speed).powi(-2)
    }

    /// Books a kick of `duration` s in the tail of a state.
    pub(super) fn book_kick(duration: f64, tail: &mut [f64]) {
        let layout = Tail::new(D);
        // What stands behind, passes and the matter of solids, is no force.
        let (booked, kick) = tail[..layout.kick().end].split_at_mut(layout.kick().start);
        let (powers, rest) = kick.split_at_mut(ACCELERATING);
        let (squares, forces) = rest.split_at_mut(ACCELERATING);
        for ((power, square), work) in powers.iter_mut().zip(squares).zip(&mut *booked) {
            *work += duration * (*power + 0.5 * duration * *square);
            *power += duration * *square;
        }
        for (impulse, force) in booked[layout.impulses()].iter_mut().zip(forces) {
            *impulse += duration * *force;
        }
    }

    /// Adds power and force of the accelerations of a particle of the fluid, at a place, to sums
    /// for [`Self::book_powers`].
    #[inline]
    pub(super) fn add_powers(
        &self,
        (number, place): (usize, usize),
        [position, velocity]: [&Vector<D>; 2],
        sums: &mut Kick,
    ) {
        let (forces, mass) = (&self.forces[place], self.mass[number]);
        let (total, zero) = (forces.total(), Vector::<D>::zeros());
        // What acts nowhere costs nothing.
        for (k, term) in forces.terms().into_iter().enumerate() {
            if *term != zero {
                sums[k] += mass * term.dot(velocity);
                sums[ACCELERATING + k] += mass * term.dot(&total);
            }
        }
        let ways = sums[2 * ACCELERATING..].chunks_exact_mut(MOST_COMPONENTS);
        for (way, term) in ways.zip(forces.ways_in()) {
            if *term != zero {
                momentum::add_moments(position, &(term * mass), way);
            }
        }
    }

    /// Puts power and force of all accelerations into the tail, for the kicks to come.
    pub(super) fn book_powers(sums: &Kick, tail: &mut [f64]) {
        let layout = Tail::new(D);
        let (energy, momentum) = tail[layout.kick()].split_at_mut(2 * ACCELERATING);
        energy.copy_from_slice(&sums[..2 * ACCELERATING]);
        let ways = sums[2 * ACCELERATING..].chunks_exact(MOST_COMPONENTS);
        for (kept, way) in momentum.chunks_exact_mut(layout.components).zip(ways) {
            kept.copy_from_slice(&way[..layout.components]);
        }
    }

    /// Adds what a drift of `step` s does to a particle of the fluid, at a place, to sums for
    /// [`Self::book_drift`]. Pressure, velocity and deviation are as before; `diffuses` says whether the
    /// pressure drifts.
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
                *sum += step * mass * compliance * mean * rate;
            }
        }
        let momentum = velocity * (step * mass);
        let (moments, count) = momentum::moments(deviation, &momentum);
        for component in D..count {
            sums[DRIFTING + component] += moments[component];
        }
    }

    /// Books what a drift does to the energy of compression, and to angular momentum, by particles
    /// that move across their velocity.
    pub(super) fn book_drift(sums: &Drift, tail: &mut [f64]) {
        tail[PRESSURE] += sums[0];
        tail[TRANSPORT] += sums[1];
        tail[PRESSURE_DIFFUSION] += sums[2];
        tail[PLASTICITY] += sums[3];
        let layout = Tail::new(D);
        // The corrections are the last of the ways in of accelerations.
        let last = (ENTERING - 1) * layout.components;
        for (kept, sum) in tail[layout.impulses()][last..].iter_mut().zip(&sums[DRIFTING..]) {
            *kept += sum;
        }
    }

    /// Books a change of the energy of compression that belongs to the law of state.
    pub(super) fn book_pressure(gained: f64, tail: &mut [f64]) {
        tail[PRESSURE] += gained;
    }

    /// Sets what has been booked so far to nothing.
    pub(super) fn clear_bookings(tail: &mut [f64]) {
        tail[..Tail::new(D).kick().start].fill(0.0);
    }
}
