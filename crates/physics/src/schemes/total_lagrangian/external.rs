//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{
    BODY_FORCE, BOUNDARY_MOTION, DAMPING, FIGURES, LEDGER, PRESSURE, SPRING, TRACTION,
    TotalLagrangian, VISCOSITY,
};
use crate::Vector;
use crate::boundaries::Spring;
use crate::parallel::{self, ExactSums, Reduce as _};
use crate::schemes::ledger::{Found, Total, Totals};
use crate::schemes::outside::{Acted, Acts, over_all, prescribe, push};

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
        let (team, weight) =
            (&self.team, |a: usize, mass: f64| self.body_acceleration(a, time) * mass);
        totals.drive(BODY_FORCE, &over_all(team, self.pulled(), particle, weight));
        let drag = |a: usize, mass: f64| velocity[a] * (-damping * mass);
        let dragged = if damping > 0.0 { count } else { 0 };
        totals.drive(DAMPING, &over_all(team, dragged, particle, drag));
        let power = |a: usize| {
            let [gradient, rate] = [&self.strained.gradient[a], &self.gradient_rate[a]];
            let stress = self.dissipation.stress(solid, a, gradient, rate);
            stress.dot(rate) * solid.particles.volume[a]
        };
        let viscous = if self.dissipation.is_viscous() { count } else { 0 };
        totals.drive(VISCOSITY, &Total::of(-team.sum(viscous, power)));
        let mut acts = Acts::<4>::default();
        push(self.tractions(time), particle, own.velocity, |total| acts.add(0, total));
        push(self.pressures(time), particle, own.velocity, |total| acts.add(1, total));
        for (load, pull) in self.pulls(at) {
            let whole: f64 = load.particles.iter().map(|&a| solid.mass[a as usize]).sum();
            let share = |&a: &u32| (a as usize, pull * (solid.mass[a as usize] / whole));
            let shares = load.particles.iter().map(share);
            push(shares, particle, own.velocity, |total| acts.add(2, total));
        }
        prescribe(&self.prescribed, time, particle, own.velocity, |total| acts.add(3, total));
        let [mut traction, pressure, spring, mut boundary] = match self.is_driven {
            true => acts.close(team),
            false => Default::default(),
        };
        let [of_tractions, of_motion] = self.ghost_powers(velocity);
        (traction.power, boundary.power) =
            (traction.power + of_tractions, boundary.power + of_motion);
        if self.has_images || self.matrices.edges().is_some_and(|edges| edges.data() > 0) {
            // What bodies beyond planes and ends do on this one.
            boundary.force.add(&over_all(team, count, particle, |a, _| self.force[a]).force);
        }
        totals.drive(SPRING, &spring);
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
        let team = &self.team;
        totals.grow(BODY_FORCE, team.sum(self.pulled(), body));
        let drag = |a: usize| solid.mass[a] * own.velocity[a].dot(&kick[a]);
        let dragged = if self.dissipation.damping > 0.0 { count } else { 0 };
        totals.grow(DAMPING, -self.dissipation.damping * team.sum(dragged, drag));
        let mut growths = ExactSums::default();
        self.pressures(time).for_each(|load| growths.add(&[growth(load), 0.0]));
        self.tractions(time).for_each(|load| growths.add(&[0.0, growth(load)]));
        let [pressure, mut traction] = match self.is_driven {
            true => team.close::<[f64; 2]>(growths),
            false => [0.0; 2],
        };
        totals.grow(PRESSURE, pressure);
        let springs = self.loads.springs.iter().map(|spring| {
            let mean = |of: &[Vector<D>]| spring.mean(&solid.mass, |a| of[a]);
            let (place, velocity) = (mean(own.displacement), mean(own.velocity));
            let place = place + spring.mean(&solid.mass, |a| solid.particles.position[a]);
            spring.force(&place, &velocity).dot(&mean(kick))
        });
        totals.grow(SPRING, springs.sum());
        if self.matrices.edges().is_some() {
            self.acceleration[..count].copy_from_slice(kick);
            traction += self.ghost_powers(&self.acceleration)[0];
        }
        totals.grow(TRACTION, traction);
        LEDGER.keep(D, &totals, tail);
    }
}
