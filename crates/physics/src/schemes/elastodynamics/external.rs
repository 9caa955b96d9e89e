//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{BODY_FORCE, BOUNDARY_MOTION, DAMPING, Elastodynamics, LEDGER, TRACTION, VISCOSITY};
use crate::boundaries::BodyForce;
use crate::schemes::ledger::{Found, Total, Totals};
use crate::schemes::outside::{Acted, over_all, prescribe, push};
use crate::schemes::solid;
use crate::{Vector, parallel};

impl<const D: usize> Elastodynamics<D> {
    #[inline]
    fn body_acceleration(&self, a: usize, time: f64) -> Vector<D> {
        let particles = &self.particles;
        BodyForce::sum(&self.body_forces, particles.body[a], &particles.position[a], time)
    }

    /// Writes the rates of the loaded state, whose forces have been evaluated.
    pub(super) fn external_pass(&self, time: f64, at: &Columns<'_, D>, (rate, totals): Found<'_>) {
        let (count, damping) = (self.mass.len(), self.settings.damping);
        let velocity = self.velocity(at);
        let (own, _) = ColumnsMut::<D>::of(rate, count);
        parallel::for_each_chunk(own.velocity, |first, rows| {
            for (a, acceleration) in (first..).zip(rows) {
                *acceleration = self.force[a] / self.mass[a] + self.body_acceleration(a, time)
                    - velocity[a] * damping;
            }
        });
        parallel::copy(own.displacement, at.velocity);
        parallel::for_each_chunk(own.kick, |_, kick| kick.fill(Vector::zeros()));
        let particle = |a: usize| Acted {
            mass: self.mass[a],
            position: self.particles.position[a] + self.displacement[a],
            velocity: velocity[a],
        };
        let weight = |a: usize, mass: f64| self.body_acceleration(a, time) * mass;
        totals.drive(BODY_FORCE, &over_all(count, particle, weight));
        // What is not there costs nothing.
        let drag = |a: usize, mass: f64| velocity[a] * (-damping * mass);
        let dragged = if damping > 0.0 { count } else { 0 };
        totals.drive(DAMPING, &over_all(dragged, particle, drag));
        let power =
            |a| self.viscous_stress(a).dot(&self.gradient_rate[a]) * self.particles.volume[a];
        let viscous = if self.settings.is_viscous() { count } else { 0 };
        totals.drive(VISCOSITY, &Total::of(-parallel::sum(viscous, power)));
        let ghosts = self.ghost_powers(velocity, &self.plane_data(velocity));
        let [mut traction, mut boundary] = ghosts.map(Total::of);
        if self.matrices.behind() > 0 {
            // What bodies beyond planes and ends do on this one.
            boundary.force = over_all(count, particle, |a, _| self.force[a]).force;
        }
        let loads = self.loaded.iter().map(|load| (load.particle, load.force(time)));
        push(loads, particle, own.velocity, &mut traction);
        prescribe(&self.prescribed, time, particle, own.velocity, &mut boundary);
        totals.drive(TRACTION, &traction);
        totals.drive(BOUNDARY_MOTION, &boundary);
    }

    /// Keeps what kicks need of the rates in the state they belong to: accelerations, those of
    /// prescribed components zero, data of edges, and the ledger with how fast the powers grow, force
    /// times acceleration.
    pub(super) fn store(
        &mut self,
        (time, rate): (f64, &[f64]),
        mut totals: Totals,
        state: &mut [f64],
    ) {
        let count = self.mass.len();
        let (own, tail) = ColumnsMut::<D>::of(state, count);
        solid::keep_accelerations(own.kick, self.columns(rate).velocity, &self.prescribed);
        let data = self.displacement[count..].iter();
        for (kept, datum) in LEDGER.behind_mut(D, tail).chunks_exact_mut(D).zip(data) {
            kept.copy_from_slice(datum.as_slice());
        }
        let kick = &*own.kick;
        let body = |a: usize| self.mass[a] * self.body_acceleration(a, time).dot(&kick[a]);
        totals.grow(BODY_FORCE, parallel::sum(count, body));
        let drag = |a: usize| self.mass[a] * own.velocity[a].dot(&kick[a]);
        totals.grow(DAMPING, -2.0 * self.settings.damping * parallel::sum(count, drag));
        let loads = self.loaded.iter();
        let mut traction = loads.map(|it| it.force(time).dot(&kick[it.particle])).sum();
        if self.matrices.edges().is_some() {
            self.acceleration[..count].copy_from_slice(kick);
            traction += self.ghost_powers(&self.acceleration, &[[0.0; 2]; D])[0];
        }
        totals.grow(TRACTION, traction);
        LEDGER.keep(D, &totals, tail);
    }
}
