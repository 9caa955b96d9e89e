//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use multiversion::multiversion;
use rayon::prelude::*;

use super::gather::Sums;
use super::{BODY_FORCE, MECHANISMS, Powers, Row, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind};
use crate::parallel::CHUNK;
use crate::schemes::momentum::{add_moments, momentum_components};
use crate::{Tensor, Vector};

impl<const D: usize> Upwind<D> {
    /// Writes the rates of all rows and the powers at their end.
    pub(super) fn pair_pass(&mut self, rate: &mut [f64]) {
        let settings = &self.settings;
        let (velocity, pressure) = (settings.tau_velocity > 0.0, settings.tau_pressure != 0.0);
        let rate_rows = match (velocity, pressure, settings.reconstruction) {
            (false, false, _) => rate_rows::<D, false, false, false>,
            (true, false, false) => rate_rows::<D, true, false, false>,
            (false, true, false) => rate_rows::<D, false, true, false>,
            (true, true, false) => rate_rows::<D, true, true, false>,
            (true, false, true) => rate_rows::<D, true, false, true>,
            (false, true, true) => rate_rows::<D, false, true, true>,
            (true, true, true) => rate_rows::<D, true, true, true>,
        };
        let (rows, tail) = rate.split_at_mut(self.particles.len() * Row::<D>::LENGTH);
        let mut powers = std::mem::take(&mut self.chunk_powers);
        let chunk_length = CHUNK * Row::<D>::LENGTH;
        let body = |(chunk, (rows, powers)): (usize, (&mut [f64], &mut Powers))| {
            *powers = rate_rows(self, chunk * CHUNK, rows);
        };
        if powers.len() <= 1 {
            rows.chunks_mut(chunk_length).zip(&mut powers).enumerate().for_each(body);
        } else {
            rows.par_chunks_mut(chunk_length).zip(&mut powers).enumerate().for_each(body);
        }
        tail.fill(0.0);
        let (work, impulses) = tail.split_at_mut(MECHANISMS.len());
        let body_force = &mut impulses[..momentum_components(D).len()];
        for chunk in &powers {
            work.iter_mut().zip(chunk.work).for_each(|(total, part)| *total += part);
            body_force.iter_mut().zip(chunk.body_force).for_each(|(total, part)| *total += part);
        }
        self.chunk_powers = powers;
    }

    /// Turns the sums of particle a into its rates.
    #[inline]
    fn write_row(&self, a: usize, sums: &Sums<f64, D>, row: &mut [f64], powers: &mut Powers) {
        let me = &self.sides[a];
        let (settings, volume) = (&self.settings, self.particles.volume[a]);
        let own = me.cofactor * self.areas.diagonal(a) * me.pressure;
        let upwind_force = Vector::from(sums.upwind_force) * settings.tau_velocity;
        let upwind_volume_rate = sums.upwind_volume_rate * settings.tau_pressure;
        let gravity = self.body_acceleration[a];
        let mass = self.mass(a);
        let acceleration =
            (Vector::from(sums.internal_force) + own + upwind_force) / mass + gravity;
        row[..D].copy_from_slice(acceleration.as_slice());
        let deformation_rate =
            Tensor::<D>::from_fn(|i, j| sums.volume_deformation_rate[i][j] / volume);
        let dilatation = me.cofactor.dot(&deformation_rate);
        row[Row::<D>::VOLUME_RATIO] = dilatation + upwind_volume_rate / volume;
        row[Row::<D>::POSITION..Row::<D>::DEFORMATION].copy_from_slice(me.velocity.as_slice());
        for i in 0..D {
            for j in 0..D {
                row[Row::<D>::DEFORMATION + i * D + j] = deformation_rate[(i, j)];
            }
        }
        let weight = gravity * mass;
        powers.work[BODY_FORCE] += weight.dot(&me.velocity);
        powers.work[UPWIND_VELOCITY] += upwind_force.dot(&me.velocity);
        powers.work[UPWIND_PRESSURE] -= me.pressure * upwind_volume_rate;
        add_moments(&me.position, &weight, &mut powers.body_force);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn rate_rows<
    const D: usize,
    const VELOCITY: bool,
    const PRESSURE: bool,
    const RECONSTRUCTION: bool,
>(
    scheme: &Upwind<D>,
    first: usize,
    rows: &mut [f64],
) -> Powers {
    let mut powers = Powers::default();
    for (offset, row) in rows.chunks_exact_mut(Row::<D>::LENGTH).enumerate() {
        let a = first + offset;
        let sums = scheme.gather::<VELOCITY, PRESSURE, RECONSTRUCTION>(a);
        scheme.write_row(a, &sums.total(), row, &mut powers);
    }
    powers
}
