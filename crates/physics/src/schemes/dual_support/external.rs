//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{BODY_FORCE, BOUNDARY_MOTION, DualSupport, PRESSURE, TRACTION};
use crate::boundaries::BodyForce;
use crate::schemes::ledger::{Found, Total};
use crate::schemes::outside::{Acted, over_all, prescribe, push};
use crate::{Tensor, Vector, parallel};

impl<const D: usize> DualSupport<D> {
    /// Current position of particle a in m.
    #[inline]
    pub(super) fn position(&self, a: usize, at: &Columns<'_, D>) -> Vector<D> {
        self.discrete.particles.position[a] + at.displacement[a]
    }

    /// Body forces at particle a in m/s^2.
    #[inline]
    pub(super) fn body_acceleration(&self, a: usize, time: f64) -> Vector<D> {
        let particles = &self.discrete.particles;
        BodyForce::sum(&self.body_forces, particles.body[a], &particles.position[a], time)
    }

    /// Writes the rates of `state`, of which the internal forces in N and the displacement gradients are known.
    pub(super) fn external_pass(
        &self,
        time: f64,
        at: &Columns<'_, D>,
        (internal, gradient): (&[Vector<D>], &[Tensor<D>]),
        (rate, totals): Found<'_>,
    ) {
        let count = self.mass.len();
        let (own, _) = ColumnsMut::<D>::of(rate, count);
        parallel::for_each_chunk(own.velocity, |first, rows| {
            for (a, acceleration) in (first..).zip(rows) {
                *acceleration = internal[a] / self.mass[a] + self.body_acceleration(a, time);
            }
        });
        parallel::copy(own.displacement, at.velocity);
        parallel::for_each_chunk(own.kick, |_, kick| kick.fill(Vector::zeros()));
        let particle = |a: usize| Acted {
            mass: self.mass[a],
            position: self.position(a, at),
            velocity: at.velocity[a],
        };
        let weight = |a: usize, mass: f64| self.body_acceleration(a, time) * mass;
        let [mut traction, mut pressure, mut boundary] = [Total::default(); 3];
        let loads = self.loaded.iter().map(|load| (load.particle, load.force(time)));
        push(loads, particle, own.velocity, &mut traction);
        let pressed = self
            .pressed
            .iter()
            .map(|part| (part.particle, part.force(time, &gradient[part.particle])));
        push(pressed, particle, own.velocity, &mut pressure);
        prescribe(&self.prescribed, time, particle, own.velocity, &mut boundary);
        totals.drive(BODY_FORCE, &over_all(count, particle, weight));
        totals.drive(TRACTION, &traction);
        totals.drive(PRESSURE, &pressure);
        totals.drive(BOUNDARY_MOTION, &boundary);
    }
}
