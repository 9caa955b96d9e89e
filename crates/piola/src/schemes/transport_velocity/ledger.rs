//! The energies, and what each mechanism does to them.
//!
//! A kick of duration s with the acceleration `a = sum_k a_k` changes the kinetic energy by
//! `sum_k s (P_k + s/2 Q_k)` with `P_k = sum m a_k . u` and `Q_k = sum m a_k . a`: exactly, and
//! mechanism by mechanism. Both sums stand in the state, between the rows and the work so far.

use super::{
    ACCELERATING, MECHANISMS, PRESSURE, PRESSURE_DIFFUSION, Row, TRANSPORT, TransportVelocity,
};
use crate::parallel;

/// Scratch of the sums over chunks.
#[derive(Default)]
pub(super) struct Scratch {
    powers: Vec<[f64; 2 * ACCELERATING]>,
    compressions: Vec<[f64; 3]>,
}

/// Length of the state behind its rows.
pub(super) const TAIL: usize = 2 * ACCELERATING + MECHANISMS.len();

impl<const D: usize> TransportVelocity<D> {
    /// Kinetic energy of the fluid in J.
    pub(super) fn kinetic_energy(&self, state: &[f64]) -> f64 {
        parallel::sum(self.particles.len(), |number| match self.is_wall[number] {
            true => 0.0,
            false => {
                let velocity = Row::<D>::velocity(Row::<D>::of(state, number));
                0.5 * self.mass[number] * velocity.norm_squared()
            }
        })
    }

    /// Energy of compression in J: `sum m p^2 / (2 rho0^2 c^2)`.
    pub(super) fn compression_energy(&self, state: &[f64]) -> f64 {
        let stiffness = self.compliance();
        parallel::sum(self.particles.len(), |number| match self.is_wall[number] {
            true => 0.0,
            false => {
                let pressure = Row::<D>::of(state, number)[Row::<D>::PRESSURE];
                0.5 * self.mass[number] * stiffness * pressure * pressure
            }
        })
    }

    /// `1 / (rho0 c)^2`.
    fn compliance(&self) -> f64 {
        (self.fluid.density * self.fluid.wave_speed).powi(-2)
    }

    /// Books a kick of `duration` s in the tail of a state.
    pub(super) fn book_kick(duration: f64, tail: &mut [f64]) {
        let (powers, rest) = tail.split_at_mut(ACCELERATING);
        let (squares, work) = rest.split_at_mut(ACCELERATING);
        for ((power, square), work) in powers.iter_mut().zip(squares).zip(work) {
            *work += duration * (*power + 0.5 * duration * *square);
            *power += duration * *square;
        }
    }

    /// Puts the power of all accelerations, and what further kicks add to it, into the tail.
    pub(super) fn book_powers(&mut self, rows: &[f64], tail: &mut [f64]) {
        let mut scratch = std::mem::take(&mut self.sums.powers);
        let (forces, places) = (&self.forces, self.support.list().places());
        let sums = parallel::sums(self.particles.len(), &mut scratch, |number| {
            let mut terms = [0.0; 2 * ACCELERATING];
            if self.is_wall[number] {
                return terms;
            }
            let forces = &forces[places[number] as usize];
            let velocity = Row::<D>::velocity(Row::<D>::of(rows, number));
            let (mass, total) = (self.mass[number], forces.total());
            for (k, term) in forces.terms().into_iter().enumerate() {
                terms[k] = mass * term.dot(&velocity);
                terms[ACCELERATING + k] = mass * term.dot(&total);
            }
            terms
        });
        tail[..2 * ACCELERATING].copy_from_slice(&sums);
        self.sums.powers = scratch;
    }

    /// Books what the drift of the pressures from `rows` by `step` s does to the energy of
    /// compression. The rates are in `self.rates`.
    pub(super) fn book_pressures(&mut self, step: f64, rows: &[f64], tail: &mut [f64]) {
        let mut scratch = std::mem::take(&mut self.sums.compressions);
        let (places, compliance) = (self.support.list().places(), self.compliance());
        let sums = parallel::sums(self.particles.len(), &mut scratch, |number| {
            if self.is_wall[number] {
                return [0.0; 3];
            }
            let rates = self.pressure_rates(places[number] as usize);
            let pressure = Row::<D>::of(rows, number)[Row::<D>::PRESSURE];
            let mean = pressure + 0.5 * step * rates.iter().sum::<f64>();
            rates.map(|rate| step * self.mass[number] * compliance * mean * rate)
        });
        let work = &mut tail[2 * ACCELERATING..];
        work[PRESSURE] += sums[0];
        work[TRANSPORT] += sums[1];
        work[PRESSURE_DIFFUSION] += sums[2];
        self.sums.compressions = scratch;
    }
}
