//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{
    BODY_FORCE, BOUNDARY_MOTION, DAMPING, FIGURES, LEDGER, PRESSURE, SPRING, TRACTION,
    TotalLagrangian, VISCOSITY,
};
use crate::boundaries::Spring;
use crate::schemes::ledger::{Found, Total, Totals};
use crate::schemes::outside::{Acted, over_all, prescribe, push};
use crate::{Vector, parallel};

impl<const D: usize> TotalLagrangian<D> {
    /// Body forces at particle a in m/s^2.
    #[inline]
    pub(super) fn body_acceleration(&self, a: usize, time: f64) -> Vector<D> {
        self.loads.acceleration(&self.solid, a, time)
    }

    /// How many particles body forces pull: all or none.
    fn pulled(&self) -> usize {
        if self.loads.body_forces.is_empty() { 0 } else { self.solid.len() }
    }

    /// The forces in N of pressures at the gradients of the moment, with the particles they act on.
    fn pressures(&self, time: f64) -> impl Iterator<Item = (usize, Vector<D>)> {
        let gradient = &self.strained.gradient;
        let pressed = self.loads.pressed.iter();
        pressed.map(move |part| (part.particle, part.force(time, &gradient[part.particle])))
    }

    /// The forces in N of tractions, with the particles they act on.
    fn tractions(&self, time: f64) -> impl Iterator<Item = (usize, Vector<D>)> {
        self.loads.loaded.iter().map(move |load| (load.particle, load.force(time)))
    }

    /// What springs do to the centres of their particles.
    fn pulls(&self, at: &Columns<'_, D>) -> impl Iterator<Item = (&Spring<D>, Vector<D>)> {
        self.loads.springs.iter().map(move |spring| {
            let place = spring.mean(&self.solid.mass, |a| self.position(a, at));
            let velocity = spring.mean(&self.solid.mass, |a| at.velocity[a]);
            (spring, spring.force(&place, &velocity))
        })
    }

    /// Writes the rates of the loaded state, whose forces have been evaluated.
    pub(super) fn external_pass(&self, time: f64, at: &Columns<'_, D>, (rate, totals): Found<'_>) {
        let (solid, damping) = (&*self.solid, self.dissipation.damping);
        let count = solid.len();
        let velocity = self.velocity(at);
        let (own, _) = ColumnsMut::<D>::of(rate, count);
        parallel::for_each_chunk(own.velocity, |first, rows| {
            for (a, acceleration) in (first..).zip(rows) {
                *acceleration = self.force[a] / solid.mass[a] + self.body_acceleration(a, time)
                    - velocity[a] * damping;
            }
        });
        parallel::copy(own.displacement, at.velocity);
        parallel::for_each_chunk(own.kick, |_, kick| kick.fill(Vector::zeros()));
        let particle = |a: usize| Acted {
            mass: solid.mass[a],
            position: self.position(a, at),
            velocity: velocity[a],
        };
        // What is not there costs nothing.
        let weight = |a: usize, mass: f64| self.body_acceleration(a, time) * mass;
        totals.drive(BODY_FORCE, &over_all(self.pulled(), particle, weight));
        let drag = |a: usize, mass: f64| velocity[a] * (-damping * mass);
        let dragged = if damping > 0.0 { count } else { 0 };
        totals.drive(DAMPING, &over_all(dragged, particle, drag));
        let power = |a: usize| {
            let [gradient, rate] = [&self.strained.gradient[a], &self.gradient_rate[a]];
            let stress = self.dissipation.stress(solid, a, gradient, rate);
            stress.dot(rate) * solid.particles.volume[a]
        };
        let viscous = if self.dissipation.is_viscous() { count } else { 0 };
        totals.drive(VISCOSITY, &Total::of(-parallel::sum(viscous, power)));
        let ghosts = self.ghost_powers(velocity);
        let [mut traction, mut boundary] = ghosts.map(Total::of);
        let mut pressure = Total::default();
        if self.matrices.behind() > 0 {
            // What bodies beyond planes and ends do on this one.
            boundary.force = over_all(count, particle, |a, _| self.force[a]).force;
        }
        push(self.tractions(time), particle, own.velocity, &mut traction);
        push(self.pressures(time), particle, own.velocity, &mut pressure);
        let mut spring = Total::default();
        for (load, pull) in self.pulls(at) {
            let whole: f64 = load.particles.iter().map(|&a| solid.mass[a as usize]).sum();
            let share = |&a: &u32| (a as usize, pull * (solid.mass[a as usize] / whole));
            push(load.particles.iter().map(share), particle, own.velocity, &mut spring);
        }
        totals.drive(SPRING, &spring);
        prescribe(&self.prescribed, time, particle, own.velocity, &mut boundary);
        let moved = [at.displacement, velocity];
        self.rigid.accelerate(time, solid, moved, own.velocity, &mut boundary);
        totals.drive(TRACTION, &traction);
        totals.drive(PRESSURE, &pressure);
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
        let solid = &*self.solid;
        let count = solid.len();
        let (own, tail) = ColumnsMut::<D>::of(state, count);
        parallel::copy(own.kick, self.columns(rate).velocity);
        self.prescribed.iter().for_each(|entry| own.kick[entry.particle][entry.component] = 0.0);
        self.rigid.project(solid, own.displacement, own.kick);
        if self.matrices.edges().is_some() {
            let data = self.displacement[count..].iter();
            let known = &mut LEDGER.behind_mut(D, tail)[FIGURES..];
            for (kept, datum) in known.chunks_exact_mut(D).zip(data) {
                kept.copy_from_slice(datum.as_slice());
            }
        }
        let kick = &*own.kick;
        let growth = |(a, force): (usize, Vector<D>)| force.dot(&kick[a]);
        let body = |a: usize| solid.mass[a] * self.body_acceleration(a, time).dot(&kick[a]);
        totals.grow(BODY_FORCE, parallel::sum(self.pulled(), body));
        let drag = |a: usize| solid.mass[a] * own.velocity[a].dot(&kick[a]);
        let dragged = if self.dissipation.damping > 0.0 { count } else { 0 };
        totals.grow(DAMPING, -self.dissipation.damping * parallel::sum(dragged, drag));
        totals.grow(PRESSURE, self.pressures(time).map(growth).sum());
        let springs = self.loads.springs.iter().map(|spring| {
            let mean = |of: &[Vector<D>]| spring.mean(&solid.mass, |a| of[a]);
            let (place, velocity) = (mean(own.displacement), mean(own.velocity));
            let place = place + spring.mean(&solid.mass, |a| solid.particles.position[a]);
            spring.force(&place, &velocity).dot(&mean(kick))
        });
        totals.grow(SPRING, springs.sum());
        let mut traction = self.tractions(time).map(growth).sum();
        if self.matrices.edges().is_some() {
            self.acceleration[..count].copy_from_slice(kick);
            traction += self.ghost_powers(&self.acceleration)[0];
        }
        totals.grow(TRACTION, traction);
        LEDGER.keep(D, &totals, tail);
    }
}
