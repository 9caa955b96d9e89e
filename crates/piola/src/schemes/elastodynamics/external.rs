//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{
    BODY_FORCE, BOUNDARY_MOTION, DAMPING, DAMPING_IMPULSE, Elastodynamics, IMPULSES, MECHANISMS,
    TRACTION, VISCOSITY,
};
use crate::boundaries::BodyForce;
use crate::schemes::momentum::{MOST_COMPONENTS, add_moments, momentum_components};
use crate::{Vector, parallel};

/// Power, and forces with their moments.
const SUMS: usize = 1 + MOST_COMPONENTS;

impl<const D: usize> Elastodynamics<D> {
    /// Numbers at the end of a state: the work of each mechanism, then the impulse of each way
    /// in which momentum enters, component by component.
    pub(super) fn ledger_length() -> usize {
        MECHANISMS.len() + IMPULSES.len() * momentum_components(D).len()
    }

    /// Where the data of edges stand behind the rows, D numbers each: after the ledger, its rates, and
    /// how fast its powers grow in a kick.
    pub(super) fn slopes_at() -> usize {
        2 * Self::ledger_length() + MECHANISMS.len()
    }

    /// Current position of particle a in m.
    #[inline]
    pub(super) fn position(&self, a: usize) -> Vector<D> {
        self.particles.position[a] + self.displacement[a]
    }

    #[inline]
    fn body_acceleration(&self, a: usize, time: f64) -> Vector<D> {
        let particles = &self.particles;
        BodyForce::sum(&self.body_forces, particles.body[a], &particles.position[a], time)
    }

    /// Writes the rates of the loaded state, whose forces have been evaluated.
    pub(super) fn external_pass(&self, time: f64, at: &Columns<'_, D>, rate: &mut [f64]) {
        let components = momentum_components(D).len();
        let damping = self.settings.damping;
        let velocity = self.velocity(at);
        let (own, tail) = ColumnsMut::<D>::of(rate, self.mass.len());
        parallel::for_each_chunk(own.velocity, |first, rows| {
            for (a, acceleration) in (first..).zip(rows) {
                *acceleration = self.force[a] / self.mass[a] + self.body_acceleration(a, time)
                    - velocity[a] * damping;
            }
        });
        parallel::copy(own.displacement, at.velocity);
        parallel::for_each_chunk(own.kick, |_, kick| kick.fill(Vector::zeros()));
        let (tail, growths) = tail.split_at_mut(Self::ledger_length());
        growths.fill(0.0);
        let (powers, impulses) = tail.split_at_mut(MECHANISMS.len());
        powers.fill(0.0);
        impulses.fill(0.0);
        let mut enters = |way: usize, sums: [f64; SUMS]| {
            let impulse = &mut impulses[way * components..][..components];
            impulse.iter_mut().zip(&sums[1..]).for_each(|(sum, part)| *sum += part);
            sums[0]
        };
        let over_all = |force: &(dyn Fn(usize) -> Vector<D> + Sync)| {
            parallel::sums::<SUMS>(self.mass.len(), |a, sums| {
                let force = force(a);
                sums[0] += force.dot(&velocity[a]);
                add_moments(&self.position(a), &force, &mut sums[1..]);
            })
        };
        let body = |a: usize| self.body_acceleration(a, time) * self.mass[a];
        powers[BODY_FORCE] = enters(BODY_FORCE, over_all(&body));
        if damping > 0.0 {
            let drag = |a: usize| velocity[a] * (-damping * self.mass[a]);
            powers[DAMPING] = enters(DAMPING_IMPULSE, over_all(&drag));
        }
        if self.edges.is_some() || !self.mirrors.is_empty() {
            // What bodies beyond planes and ends do on this one.
            enters(BOUNDARY_MOTION, over_all(&|a: usize| self.force[a]));
        }
        if self.settings.is_viscous() {
            powers[VISCOSITY] = -parallel::sum(self.mass.len(), |a| {
                self.viscous_stress(a).dot(&self.gradient_rate[a]) * self.particles.volume[a]
            });
        }
        let ghosts = self.ghost_powers(velocity, &self.plane_data(velocity));
        powers[TRACTION] = ghosts.traction;
        powers[BOUNDARY_MOTION] = ghosts.motion;
        for load in &self.loaded {
            let (a, force) = (load.particle, load.force(time));
            for (component, force) in force.iter().enumerate() {
                own.velocity[a][component] += force / self.mass[a];
            }
            let mut sums = [0.0; SUMS];
            sums[0] = force.dot(&velocity[a]);
            add_moments(&self.position(a), &force, &mut sums[1..]);
            powers[TRACTION] += enters(TRACTION, sums);
        }
        for entry in self.prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let acceleration = &mut own.velocity[a][component];
            let wanted = entry.value.rate(entry.place, time);
            let mut force = Vector::<D>::zeros();
            force[component] = self.mass[a] * (wanted - *acceleration);
            *acceleration = wanted;
            let mut sums = [0.0; SUMS];
            sums[0] = force.dot(&velocity[a]);
            add_moments(&self.position(a), &force, &mut sums[1..]);
            powers[BOUNDARY_MOTION] += enters(BOUNDARY_MOTION, sums);
        }
    }

    /// Keeps what kicks need of the rates in the state they belong to: accelerations, those of
    /// prescribed components zero; rates of the ledger; and how fast the powers grow, force times
    /// acceleration.
    pub(super) fn store(&mut self, time: f64, rate: &[f64], state: &mut [f64]) {
        let rate = self.columns(rate);
        let (own, tail) = ColumnsMut::<D>::of(state, self.mass.len());
        parallel::copy(own.kick, rate.velocity);
        for entry in self.prescribed.iter() {
            own.kick[entry.particle][entry.component] = 0.0;
        }
        let (kick, ledger) = (&*own.kick, Self::ledger_length());
        tail[ledger..2 * ledger].copy_from_slice(&rate.tail[..ledger]);
        let data = self.displacement[self.mass.len()..].iter();
        for (kept, datum) in tail[Self::slopes_at()..].chunks_exact_mut(D).zip(data) {
            kept.copy_from_slice(datum.as_slice());
        }
        let growths = &mut tail[2 * ledger..][..MECHANISMS.len()];
        growths.fill(0.0);
        growths[BODY_FORCE] = parallel::sum(self.mass.len(), |a| {
            self.mass[a] * self.body_acceleration(a, time).dot(&kick[a])
        });
        growths[DAMPING] = -2.0
            * self.settings.damping
            * parallel::sum(self.mass.len(), |a| self.mass[a] * own.velocity[a].dot(&kick[a]));
        let own = self.loaded.iter();
        growths[TRACTION] = own.map(|load| load.force(time).dot(&kick[load.particle])).sum();
        if self.edges.is_some() {
            self.acceleration[..kick.len()].copy_from_slice(kick);
            growths[TRACTION] += self.ghost_powers(&self.acceleration, &[[0.0; 2]; D]).traction;
        }
    }

    /// Momentum of all particles together.
    pub(super) fn momentum_of(&self, state: &[f64]) -> [f64; MOST_COMPONENTS] {
        let at = self.columns(state);
        parallel::sums(self.mass.len(), |a, sum| {
            let momentum = at.velocity[a] * self.mass[a];
            add_moments(&(self.particles.position[a] + at.displacement[a]), &momentum, sum);
        })
    }
}
