//! What acts on the body from outside, with the work and the momentum that enter with it.

use super::fields::{Columns, ColumnsMut};
use super::{
    BODY_FORCE, BOUNDARY_MOTION, DualSupport, FIGURES, IMPULSES, MECHANISMS, PRESSURE, Side,
    TRACTION,
};
use crate::boundaries::BodyForce;
use crate::schemes::momentum::{MOST_COMPONENTS, add_moments, momentum_components};
use crate::{Vector, parallel};

/// Power, force and moment of the body forces.
const BODY_SUMS: usize = 1 + MOST_COMPONENTS;

impl<const D: usize> DualSupport<D> {
    /// Numbers at the end of a state: the work of each mechanism, then the impulse of each way
    /// in which momentum enters, component by component.
    pub(super) fn ledger_length() -> usize {
        MECHANISMS.len() + IMPULSES.len() * momentum_components(D).len()
    }

    /// Numbers behind the rows: the ledger, its rates, how fast its powers grow in a kick, and the
    /// [`FIGURES`] of the last step.
    pub(super) fn tail_length() -> usize {
        2 * Self::ledger_length() + MECHANISMS.len() + FIGURES
    }

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

    /// Writes the rates of `state`, of which the internal forces in N and the sides are known.
    pub(super) fn external_pass(
        &self,
        time: f64,
        at: &Columns<'_, D>,
        (internal, sides): (&[Vector<D>], &[Side<f64, D>]),
        rate: &mut [f64],
    ) {
        let (own, tail) = ColumnsMut::<D>::of(rate, self.mass.len());
        parallel::for_each_chunk(own.velocity, |first, rows| {
            for (a, acceleration) in (first..).zip(rows) {
                *acceleration = internal[a] / self.mass[a] + self.body_acceleration(a, time);
            }
        });
        parallel::copy(own.displacement, at.velocity);
        parallel::for_each_chunk(own.kick, |_, kick| kick.fill(Vector::zeros()));
        let components = momentum_components(D).len();
        let (tail, kept) = tail.split_at_mut(Self::ledger_length());
        kept.fill(0.0);
        let (powers, impulses) = tail.split_at_mut(MECHANISMS.len());
        powers.fill(0.0);
        impulses.fill(0.0);
        let body = parallel::sums::<BODY_SUMS>(self.mass.len(), |a, sums| {
            let force = self.body_acceleration(a, time) * self.mass[a];
            sums[0] += force.dot(&at.velocity[a]);
            add_moments(&self.position(a, at), &force, &mut sums[1..]);
        });
        powers[BODY_FORCE] = body[0];
        impulses[BODY_FORCE * components..][..components].copy_from_slice(&body[1..][..components]);
        let mut acts = |mechanism: usize, a: usize, force: Vector<D>| {
            for (component, force) in force.iter().enumerate() {
                own.velocity[a][component] += force / self.mass[a];
            }
            powers[mechanism] += force.dot(&at.velocity[a]);
            let impulse = &mut impulses[mechanism * components..][..components];
            add_moments(&self.position(a, at), &force, impulse);
        };
        for load in &self.loaded {
            acts(TRACTION, load.particle, load.force(time));
        }
        for part in &self.pressed {
            let a = part.particle;
            acts(PRESSURE, a, part.force(time, &sides[a].gradient));
        }
        let boundary = &mut impulses[BOUNDARY_MOTION * components..];
        for entry in self.prescribed.iter() {
            let (a, component) = (entry.particle, entry.component);
            let acceleration = &mut own.velocity[a][component];
            let wanted = entry.value.rate(entry.place, time);
            let reaction = self.mass[a] * (wanted - *acceleration);
            *acceleration = wanted;
            let mut force = Vector::<D>::zeros();
            force[component] = reaction;
            powers[BOUNDARY_MOTION] += force.dot(&at.velocity[a]);
            add_moments(&self.position(a, at), &force, boundary);
        }
    }

    /// Momentum of all particles together.
    pub(super) fn momentum_of(&self, state: &[f64]) -> [f64; MOST_COMPONENTS] {
        if self.is_static {
            return [0.0; MOST_COMPONENTS];
        }
        let at = self.columns(state);
        parallel::sums(self.mass.len(), |a, sum| {
            let momentum = at.velocity[a] * self.mass[a];
            add_moments(&self.position(a, &at), &momentum, sum);
        })
    }
}
