//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{
    BODY_FORCE, BOUNDARY_MOTION, DAMPING, FIGURES, LEDGER, PRESSURE, SPRING, TRACTION,
    TotalLagrangian, VISCOSITY,
};
use crate::Vector;
use crate::boundaries::Spring;
use crate::parallel::{self, ExactSums, Reduce as _, add_sums};
use crate::schemes::ledger::{Found, Total, Totals};
use crate::schemes::outside::{Acted, over_all, prescribe, push};

impl<const D: usize> TotalLagrangian<D> {
    /// Body forces at particle a in m/s^2.
    #[inline]
    pub(super) fn body_acceleration(&self, a: usize, time: f64) -> Vector<D> {
        self.loads.acceleration(&self.solid, a, time)
    }

    /// Whether body forces pull.
    fn is_pulled(&self) -> bool {
        !self.loads.body_forces.is_empty()
    }

    /// Writes the accelerations of the loaded state, whose forces have been evaluated, where rates have those of velocities.
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
        let particle = |a: usize| Acted {
            mass: solid.mass[a],
            position: self.position(a, at),
            velocity: velocity[a],
        };
        // What is not there costs nothing.
        let rows = [count, self.team.chunk(count)];
        let [mut body, mut dragged, mut viscous, mut images] = [const { ExactSums::NONE }; 4];
        if self.is_pulled() {
            let weight = |a: usize, mass: f64| self.body_acceleration(a, time) * mass;
            over_all(rows, particle, weight, &mut body);
        }
        if damping > 0.0 {
            let drag = |a: usize, mass: f64| velocity[a] * (-damping * mass);
            over_all(rows, particle, drag, &mut dragged);
        }
        if self.dissipation.is_viscous() {
            let power = |a: usize, total: &mut Total| {
                let [gradient, rate] = [&self.strained.gradient[a], &self.gradient_rate[a]];
                let stress = self.dissipation.at(solid, a).stress(gradient, rate);
                total.power -= stress.dot(rate) * solid.particles.volume[a];
            };
            add_sums(rows, power, &mut viscous);
        }
        let has_more = self.has_images || self.matrices.edges().is_some_and(|it| it.data() > 0);
        if has_more {
            // What bodies beyond planes and ends do on this one.
            over_all(rows, particle, |a, _| self.force[a], &mut images);
        }
        let [mut traction, mut pressure, mut spring, mut boundary] = [const { ExactSums::NONE }; 4];
        push(self.loads.tractions(time), particle, own.velocity, &mut traction);
        push(
            self.loads.pressures(time, &self.strained.gradient),
            particle,
            own.velocity,
            &mut pressure,
        );
        if !self.loads.springs.is_empty() {
            let read = [at.displacement, at.velocity];
            self.with_group(read, [], |solid, [displacement, velocity], []| {
                let mass = &solid.mass;
                for load in &self.loads.springs {
                    let position = |a: usize| solid.particles.position[a] + displacement[a];
                    let pull =
                        load.force(&load.mean(mass, position), &load.mean(mass, |a| velocity[a]));
                    let whole: f64 = load.particles.iter().map(|&a| mass[a as usize]).sum();
                    let share = |&a: &u32| {
                        let here = self.team.own(a as usize, count)?;
                        Some((here, pull * (mass[a as usize] / whole)))
                    };
                    let forces = load.particles.iter().filter_map(share);
                    push(forces, particle, own.velocity, &mut spring);
                }
            });
        }
        prescribe(&self.prescribed, time, particle, own.velocity, &mut boundary);
        let acts = self.is_pulled() || damping > 0.0 || self.dissipation.is_viscous();
        let all = [body, dragged, viscous, images, traction, pressure, spring, boundary];
        let all: [Total; 8] = match acts || has_more || self.is_driven {
            true => self.team.close_all(all),
            false => Default::default(),
        };
        let [body, dragged, viscous, images, mut traction, pressure, spring, mut boundary] = all;
        let [of_tractions, of_motion] = self.ghost_powers(velocity);
        traction.power += of_tractions;
        boundary.power += of_motion;
        boundary.force.add(&images.force);
        totals.drive(BODY_FORCE, &body);
        totals.drive(DAMPING, &dragged);
        totals.drive(VISCOSITY, &viscous);
        totals.drive(SPRING, &spring);
        if !self.rigid.is_empty() {
            let (read, written) = ([at.displacement, &velocity[..count]], [own.velocity]);
            self.with_group(read, written, |solid, moved, [acceleration]| {
                self.rigid.accelerate(time, solid, moved, acceleration, &mut boundary);
            });
        }
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
        if !self.rigid.is_empty() {
            let (read, written) = ([&*own.displacement], [&mut *own.kick]);
            self.with_group(read, written, |solid, [displacement], [kick]| {
                self.rigid.project(solid, displacement, kick);
            });
        }
        if self.matrices.edges().is_some() {
            let data = self.displacement[count..].iter();
            let known = &mut LEDGER.behind_mut(D, tail)[FIGURES..];
            for (kept, datum) in known.chunks_exact_mut(D).zip(data) {
                kept.copy_from_slice(datum.as_slice());
            }
        }
        let kick = &*own.kick;
        let growth = |(a, force): (usize, Vector<D>)| force.dot(&kick[a]);
        let (rows, damping) = ([count, self.team.chunk(count)], self.dissipation.damping);
        let [mut body, mut dragged, mut pressure, mut traction] = [const { ExactSums::NONE }; 4];
        if self.is_pulled() {
            let add = |a: usize, sum: &mut f64| {
                *sum += solid.mass[a] * self.body_acceleration(a, time).dot(&kick[a]);
            };
            add_sums(rows, add, &mut body);
        }
        if damping > 0.0 {
            let add =
                |a: usize, sum: &mut f64| *sum += solid.mass[a] * own.velocity[a].dot(&kick[a]);
            add_sums(rows, add, &mut dragged);
        }
        self.loads
            .pressures(time, &self.strained.gradient)
            .for_each(|load| pressure.add(&growth(load)));
        self.loads.tractions(time).for_each(|load| traction.add(&growth(load)));
        let [body, dragged, pressure, mut traction] =
            match self.is_pulled() || damping > 0.0 || self.is_driven {
                true => self.team.close_all([body, dragged, pressure, traction]),
                false => [0.0; 4],
            };
        totals.grow(BODY_FORCE, body);
        totals.grow(DAMPING, -damping * dragged);
        totals.grow(PRESSURE, pressure);
        if !self.loads.springs.is_empty() {
            let read = [&*own.displacement, &*own.velocity, kick];
            let grown: f64 =
                self.with_group(read, [], |solid, [displacement, velocity, kick], []| {
                    let of = |spring: &Spring<D>| {
                        let mean = |of: &[Vector<D>]| spring.mean(&solid.mass, |a| of[a]);
                        let place = mean(displacement) + mean(&solid.particles.position);
                        spring.force(&place, &mean(velocity)).dot(&mean(kick))
                    };
                    self.loads.springs.iter().map(of).sum()
                });
            totals.grow(SPRING, grown);
        }
        if self.matrices.edges().is_some() {
            self.acceleration[..count].copy_from_slice(kick);
            traction += self.ghost_powers(&self.acceleration)[0];
        }
        totals.grow(TRACTION, traction);
        LEDGER.keep(D, &totals, tail);
    }
}
