//! The pass over pairs: forces, deformation rates and upwind dissipation in one gather.

use piola_formulas::riemann::Interface;
use rayon::prelude::*;

use super::local::Side;
use super::{BODY_FORCE, Powers, Row, UPWIND_PRESSURE, UPWIND_VELOCITY, Upwind};
use crate::parallel::CHUNK;
use crate::{Tensor, Vector};

/// What a particle gathers from its neighbours.
struct Gathered<const D: usize> {
    /// Internal force in N.
    internal: Vector<D>,
    /// Force of the velocity dissipation in N.
    upwind_force: Vector<D>,
    /// Rate of the deformation gradient in 1/s.
    deformation_rate: Tensor<D>,
    /// Volume rate of the pressure dissipation in m^D/s.
    upwind_volume_rate: f64,
}

impl<const D: usize> Upwind<D> {
    /// Writes the rates of all rows and the powers at their end.
    pub(super) fn pair_pass(&mut self, rate: &mut [f64]) {
        let (rows, tail) = rate.split_at_mut(self.particles.len() * Row::<D>::LENGTH);
        let mut powers = std::mem::take(&mut self.chunk_powers);
        let chunk_length = CHUNK * Row::<D>::LENGTH;
        let body = |(chunk, (rows, powers)): (usize, (&mut [f64], &mut Powers))| {
            *powers = self.rate_rows(chunk * CHUNK, rows);
        };
        if powers.len() <= 1 {
            rows.chunks_mut(chunk_length).zip(&mut powers).enumerate().for_each(body);
        } else {
            rows.par_chunks_mut(chunk_length).zip(&mut powers).enumerate().for_each(body);
        }
        tail.fill(0.0);
        for chunk in &powers {
            tail.iter_mut().zip(chunk.0).for_each(|(total, part)| *total += part);
        }
        self.chunk_powers = powers;
    }

    fn rate_rows(&self, first: usize, rows: &mut [f64]) -> Powers {
        let mut powers = Powers::default();
        for (offset, row) in rows.chunks_exact_mut(Row::<D>::LENGTH).enumerate() {
            let a = first + offset;
            let me = &self.sides[a];
            let sum = self.gather(a, me);
            let gravity = self.body_acceleration[a];
            let mass = self.mass(a);
            let acceleration = (sum.internal + sum.upwind_force) / mass + gravity;
            row[..D].copy_from_slice(acceleration.as_slice());
            let dilatation = me.cofactor.dot(&sum.deformation_rate);
            row[Row::<D>::VOLUME_RATIO] = dilatation + sum.upwind_volume_rate / me.volume;
            row[Row::<D>::POSITION..Row::<D>::DEFORMATION].copy_from_slice(me.velocity.as_slice());
            for i in 0..D {
                for j in 0..D {
                    row[Row::<D>::DEFORMATION + i * D + j] = sum.deformation_rate[(i, j)];
                }
            }
            powers.0[BODY_FORCE] += mass * gravity.dot(&me.velocity);
            powers.0[UPWIND_VELOCITY] += sum.upwind_force.dot(&me.velocity);
            powers.0[UPWIND_PRESSURE] -= me.pressure * sum.upwind_volume_rate;
        }
        powers
    }

    /// The sums over neighbours of theory (8) to (10), with b = a in the first.
    #[inline]
    fn gather(&self, a: usize, me: &Side<D>) -> Gathered<D> {
        let (list, settings) = (&self.support.list, &self.settings);
        let entries = list.range(a);
        let forward = self.gradient.forward(entries.clone());
        let adjoint = self.gradient.adjoint(entries);
        let mut sum = Gathered {
            internal: me.cofactor * self.gradient.diagonal(a) * (me.pressure * me.volume),
            upwind_force: Vector::zeros(),
            deformation_rate: Tensor::zeros(),
            upwind_volume_rate: 0.0,
        };
        let dissipates = settings.tau_velocity > 0.0 || settings.tau_pressure > 0.0;
        for ((&b, g), transposed) in list.row(a).iter().zip(forward).zip(adjoint) {
            let other = &self.sides[b as usize];
            let (g, transposed) = (Vector::from(*g), Vector::from(*transposed));
            let jump = other.velocity - me.velocity;
            let other_area = other.cofactor * transposed * other.volume;
            sum.internal += other_area * other.pressure;
            sum.deformation_rate += jump * g.transpose();
            if dissipates {
                let area = Areas { g, transposed, other_area };
                self.dissipate(a, b as usize, jump, &area, &mut sum);
            }
        }
        sum
    }

    /// Adds the exchange with one neighbour, theory (12) and (13), with the antisymmetric areas
    /// that let b lose what a receives.
    #[inline]
    fn dissipate(
        &self,
        a: usize,
        b: usize,
        mut velocity_jump: Vector<D>,
        area: &Areas<D>,
        sum: &mut Gathered<D>,
    ) {
        let (me, other, settings) = (&self.sides[a], &self.sides[b], &self.settings);
        let domain = &self.support.domain;
        let reference = domain.separation(&me.reference, &other.reference);
        let interface = Interface::new(domain.separation(&me.position, &other.position), reference);
        let impedance = 0.5 * (me.density + other.density) * me.wave_speed.max(other.wave_speed);
        let mut pressure_jump = other.pressure - me.pressure;
        if settings.reconstruction {
            let (mine, theirs) = (&self.slopes[a], &self.slopes[b]);
            velocity_jump -= (mine.velocity + theirs.velocity) * reference * 0.5;
            pressure_jump -= (mine.pressure + theirs.pressure).dot(&reference) * 0.5;
        }
        if settings.tau_velocity > 0.0 {
            let area = area.g * me.volume - area.transposed * other.volume;
            sum.upwind_force +=
                interface.force(impedance, &velocity_jump, &area) * settings.tau_velocity;
        }
        if settings.tau_pressure > 0.0 {
            let average = (me.cofactor + other.cofactor) * 0.5;
            let area = me.cofactor * area.g * me.volume - area.other_area;
            let rate = interface.volume_rate(impedance, pressure_jump, &average, &area);
            sum.upwind_volume_rate += rate * settings.tau_pressure;
        }
    }
}

/// The areas of a pair that the internal force has formed already.
struct Areas<const D: usize> {
    g: Vector<D>,
    transposed: Vector<D>,
    /// `V_b H_b G_ba`.
    other_area: Vector<D>,
}
