//! Rigid bodies: particles that move as one, theory (83) and (84).
//!
//! A rigid body is a group of particles whose velocities are `v_a = V + W x r_a` with the velocity V of a
//! point of the body, the angular velocity W and the arm `r_a` from that point. What acts on its particles
//! moves it by the resultant and the moment: accelerations, and velocities that something else has
//! changed, are replaced by those of such a motion that are nearest to them by mass, which keeps linear and
//! angular momentum. Components of V and of W may be prescribed. Between kicks the body turns freely: its
//! angular momentum stays, and the rotation of a step is that about the mean of the angular velocities at
//! its ends, seen from the body, which keeps its energy.
//!
//! Particles that are joined to others hold these, so that flexible bodies are clamped to rigid ones.

mod check;
mod motion;

use std::sync::Arc;

use nalgebra::{Matrix3, Rotation3, Vector3};

pub(super) use self::check::check;
use self::motion::{COMPONENTS, Moments, Motion, in_plane, in_space, is_missing, turn_freely};
use super::Solid;
use crate::boundaries::{SpaceTime, padded};
use crate::schemes::StepLimit;
use crate::schemes::ledger::Total;
use crate::schemes::split::advance;
use crate::{Tensor, Vector, parallel};

/// Angle in rad that a body turns by in a step at a CFL number of one.
const ANGLE: f64 = 0.2;

/// Particles that move as one, and what is prescribed of their motion.
#[derive(Clone, Default)]
pub struct RigidBody<const D: usize> {
    /// Name for messages.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// The point of the body, where it is at rest, that velocities are prescribed of, in m: its centre of
    /// mass where there is none.
    pub pivot: Option<Vector<D>>,
    /// Prescribed components of the velocity of that point, m/s.
    pub velocity: Vec<(usize, Arc<dyn SpaceTime>)>,
    /// Prescribed components, 0 to 2, of the angular velocity, rad/s. In 2D the third is all there is.
    pub angular_velocity: Vec<(usize, Arc<dyn SpaceTime>)>,
}

/// A body bound to its particles.
#[derive(Clone)]
struct Bound<const D: usize> {
    particles: Vec<u32>,
    /// How displacements of its particles make that of its point.
    weights: Vec<f64>,
    /// Its point at rest.
    point: Vector<D>,
    prescribed: [Option<Arc<dyn SpaceTime>>; COMPONENTS],
}

/// The rigid bodies of a solid.
#[derive(Clone, Default)]
pub(super) struct RigidBodies<const D: usize> {
    bodies: Vec<Bound<D>>,
    /// Whether a particle belongs to one; empty where there is none.
    is_rigid: Vec<bool>,
}

impl<const D: usize> Bound<D> {
    fn new(body: RigidBody<D>, solid: &Solid<D>) -> Self {
        let mut prescribed: [Option<Arc<dyn SpaceTime>>; COMPONENTS] = Default::default();
        body.velocity.into_iter().for_each(|(i, value)| prescribed[i] = Some(value));
        body.angular_velocity.into_iter().for_each(|(i, value)| prescribed[3 + i] = Some(value));
        let of = |a: u32| (solid.mass[a as usize], &solid.particles.position[a as usize]);
        let mass: f64 = body.particles.iter().map(|&a| of(a).0).sum();
        let centre = body.particles.iter().map(|&a| of(a).1 * (of(a).0 / mass)).sum::<Vector<D>>();
        let second = body.particles.iter().map(|&a| {
            let arm = of(a).1 - centre;
            arm * arm.transpose() * of(a).0
        });
        let inverse = second.sum::<Tensor<D>>().try_inverse().unwrap_or_else(Tensor::zeros);
        let point = body.pivot.unwrap_or(centre);
        // Exact for displacements that are linear in the place, as those of rigid motions are.
        let towards = inverse * (point - centre);
        let weight = |&a: &u32| of(a).0 * (1.0 / mass + (of(a).1 - centre).dot(&towards));
        let weights = body.particles.iter().map(weight).collect();
        Self { weights, particles: body.particles, point, prescribed }
    }

    /// Where its point is.
    fn place(&self, displacement: &[Vector<D>]) -> Vector<D> {
        let moved = self.particles.iter().zip(&self.weights);
        self.point + moved.map(|(&a, weight)| displacement[a as usize] * *weight).sum::<Vector<D>>()
    }

    /// The moments of the body with a velocity, or an acceleration, of each particle, of which it has numbers of
    /// its own.
    fn moments(
        &self,
        mass: &[f64],
        arm: impl Fn(usize) -> Vector3<f64> + Sync,
        velocity: impl Fn(usize) -> Vector<D> + Sync,
    ) -> Moments {
        let all: [f64; 16] = parallel::sums(self.particles.len(), |k, all: &mut [f64; 16]| {
            let (mass, arm) = (mass[self.particles[k] as usize], arm(k));
            let linear = in_space(&velocity(k)) * mass;
            let (angular, first) = (arm.cross(&linear), arm * mass);
            let second = [
                first.y * arm.y + first.z * arm.z,
                first.z * arm.z + first.x * arm.x,
                first.x * arm.x + first.y * arm.y,
                -first.x * arm.y,
                -first.y * arm.z,
                -first.z * arm.x,
            ];
            let parts = [first.as_slice(), linear.as_slice(), angular.as_slice(), &second];
            let parts = parts.into_iter().flatten();
            all[0] += mass;
            all[1..].iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
        });
        let vector = |k: usize| Vector3::new(all[k], all[k + 1], all[k + 2]);
        let [xx, yy, zz, xy, yz, zx] = [10, 11, 12, 13, 14, 15].map(|k| all[k]);
        Moments {
            mass: all[0],
            first: vector(1),
            inertia: Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz),
            linear: vector(4),
            angular: vector(7),
        }
    }

    /// What is prescribed, by value or by rate; zero of what there is not in these dimensions.
    fn held(&self, value: impl Fn(&dyn SpaceTime, [f64; 3]) -> f64) -> [Option<f64>; COMPONENTS] {
        let place = padded(&self.point);
        std::array::from_fn(|k| match &self.prescribed[k] {
            Some(prescribed) => Some(value(&**prescribed, place)),
            None => is_missing(D, k).then_some(0.0),
        })
    }

    fn is_held(&self) -> bool {
        self.prescribed.iter().any(Option::is_some)
    }

    /// Whether it turns about nothing that is prescribed.
    fn turns_freely(&self) -> bool {
        self.prescribed[3..].iter().all(Option::is_none)
    }
}

impl<const D: usize> RigidBodies<D> {
    /// Binds bodies to the particles of a solid.
    pub fn new(bodies: Vec<RigidBody<D>>, solid: &Solid<D>) -> Self {
        let mut is_rigid = vec![false; if bodies.is_empty() { 0 } else { solid.len() }];
        let particles = bodies.iter().flat_map(|body| &body.particles);
        particles.for_each(|&a| is_rigid[a as usize] = true);
        Self { bodies: bodies.into_iter().map(|body| Bound::new(body, solid)).collect(), is_rigid }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The particles of all of them.
    pub fn particles(&self) -> impl Iterator<Item = &u32> {
        self.bodies.iter().flat_map(|body| &body.particles)
    }

    /// Bytes of all arrays.
    pub fn memory(&self) -> usize {
        let of = |body: &Bound<D>| size_of_val(&*body.particles) + size_of_val(&*body.weights);
        self.bodies.iter().map(of).sum::<usize>() + size_of_val(&*self.is_rigid)
    }

    /// Makes velocities those of motions that have the values of `time`, with the momenta that they have.
    pub fn constrain(
        &self,
        time: f64,
        solid: &Solid<D>,
        displacement: &[Vector<D>],
        velocity: &mut [Vector<D>],
    ) {
        for body in &self.bodies {
            let held = body.held(|value, place| value.value(place, time));
            body.make_motion(solid, displacement, velocity, &held);
        }
    }

    /// Makes a field on the bodies where they are one of motions, with zero where something is prescribed.
    pub fn project(&self, solid: &Solid<D>, displacement: &[Vector<D>], field: &mut [Vector<D>]) {
        for body in &self.bodies {
            body.make_motion(solid, displacement, field, &body.held(|_, _| 0.0));
        }
    }

    /// Makes accelerations, which those of particles by themselves are given as, those of motions, and adds what
    /// that takes from outside.
    pub fn accelerate(
        &self,
        time: f64,
        solid: &Solid<D>,
        [displacement, velocity]: [&[Vector<D>]; 2],
        acceleration: &mut [Vector<D>],
        boundary: &mut Total,
    ) {
        for body in &self.bodies {
            let point = body.place(displacement);
            let arm = |k: usize| body.arm(solid, displacement, &point, k);
            let own = |k: usize| body.particles[k] as usize;
            let held = body.held(|value, place| value.rate(place, time));
            let mut moments = body.moments(&solid.mass, arm, |k| acceleration[own(k)]);
            if D == 3 && !body.turns_freely() {
                // Where two components of it are prescribed, drifts do not turn the momentum.
                let now = body.moments(&solid.mass, arm, |k| velocity[own(k)]);
                let spin = now.motion(&body.held_nowhere()).spin;
                moments.angular -= spin.cross(&(moments.inertia * spin));
            }
            let motion = moments.motion(&held);
            for k in 0..body.particles.len() {
                let (a, wanted) = (own(k), in_plane::<D>(&motion.at(&arm(k))));
                let place = solid.particles.position[a] + displacement[a];
                let force = (wanted - acceleration[a]) * solid.mass[a];
                boundary.push(&place, &velocity[a], &force);
                acceleration[a] = wanted;
            }
        }
    }

    /// Moves particles that belong to none on straight paths for `step` s: those from number `begin` on.
    pub fn advance(
        &self,
        (begin, step): (usize, f64),
        displacement: &mut [Vector<D>],
        velocity: &[Vector<D>],
    ) {
        if self.is_empty() {
            return advance(displacement, velocity, step);
        }
        parallel::for_each_chunk(displacement, |first, rows| {
            let rows = (first..).zip(rows);
            for (a, displacement) in rows.filter(|(a, _)| !self.is_rigid[begin + *a]) {
                *displacement += velocity[a] * step;
            }
        });
    }

    /// Moves bodies from `time` for `step` s with the motions that they have, and with what is prescribed half
    /// way; what that takes is added, as work and impulse.
    pub fn drift(
        &self,
        [time, step]: [f64; 2],
        solid: &Solid<D>,
        [displacement, velocity]: [&mut [Vector<D>]; 2],
        boundary: &mut Total,
    ) {
        for body in &self.bodies {
            if body.is_held() {
                let held = body.held(|value, place| value.value(place, time + 0.5 * step));
                body.make_motion(solid, displacement, velocity, &held);
            }
            let before = body.balance(solid, displacement, velocity);
            let point = body.place(displacement);
            let moments = {
                let arm = |k: usize| body.arm(solid, displacement, &point, k);
                body.moments(&solid.mass, arm, |k| velocity[body.particles[k] as usize])
            };
            let motion = moments.motion(&body.held_nowhere());
            let (turned, spin) = match D == 3 && body.turns_freely() {
                true => turn_freely(&moments.inertia, &motion.spin, step),
                false => (*Rotation3::new(motion.spin * step).matrix(), motion.spin),
            };
            let after = Motion { spin, ..motion };
            for (k, &a) in body.particles.iter().enumerate() {
                let arm = body.arm(solid, displacement, &point, k);
                let moved = turned * arm;
                displacement[a as usize] +=
                    in_plane::<D>(&(motion.velocity * step + (moved - arm)));
                velocity[a as usize] = in_plane(&after.at(&moved));
            }
            if body.is_held() {
                let after = body.balance(solid, displacement, velocity);
                boundary.power += after.power - before.power;
                let change = after.force.iter().zip(before.force);
                boundary
                    .force
                    .iter_mut()
                    .zip(change)
                    .for_each(|(sum, (new, old))| *sum += new - old);
            }
        }
    }

    /// The bound on a step by how far bodies turn in it, with velocities and accelerations as they are.
    pub fn limit(
        &self,
        solid: &Solid<D>,
        [displacement, velocity, acceleration]: [&[Vector<D>]; 3],
    ) -> Option<StepLimit> {
        let of = |body: &Bound<D>| {
            let point = body.place(displacement);
            let arm = |k: usize| body.arm(solid, displacement, &point, k);
            let turn = |field: &[Vector<D>]| {
                let moments = body.moments(&solid.mass, arm, |k| field[body.particles[k] as usize]);
                moments.motion(&body.held_nowhere()).spin.norm()
            };
            let step = (ANGLE / turn(velocity)).min((2.0 * ANGLE / turn(acceleration)).sqrt());
            StepLimit::scaled("rotation", step, body.particles[0] as usize)
        };
        let all = self.bodies.iter().map(of);
        all.reduce(|least, other| if other.step < least.step { other } else { least })
    }
}

impl<const D: usize> Bound<D> {
    /// Where its particle `k` is from a place of its point.
    fn arm(
        &self,
        solid: &Solid<D>,
        displacement: &[Vector<D>],
        point: &Vector<D>,
        k: usize,
    ) -> Vector3<f64> {
        let a = self.particles[k] as usize;
        in_space(&(solid.particles.position[a] - point + displacement[a]))
    }

    /// Makes a field on its particles that of a motion with the same momenta where components are not held.
    fn make_motion(
        &self,
        solid: &Solid<D>,
        displacement: &[Vector<D>],
        field: &mut [Vector<D>],
        held: &[Option<f64>; COMPONENTS],
    ) {
        let point = self.place(displacement);
        let arm = |k: usize| self.arm(solid, displacement, &point, k);
        let motion =
            self.moments(&solid.mass, arm, |k| field[self.particles[k] as usize]).motion(held);
        for (k, &a) in self.particles.iter().enumerate() {
            field[a as usize] = in_plane(&motion.at(&arm(k)));
        }
    }

    /// Nothing held but what there is not in these dimensions.
    fn held_nowhere(&self) -> [Option<f64>; COMPONENTS] {
        std::array::from_fn(|k| is_missing(D, k).then_some(0.0))
    }

    /// Its kinetic energy and its momentum about the origin.
    fn balance(
        &self,
        solid: &Solid<D>,
        displacement: &[Vector<D>],
        velocity: &[Vector<D>],
    ) -> Total {
        parallel::sums(self.particles.len(), |k, total: &mut Total| {
            let a = self.particles[k] as usize;
            let place = solid.particles.position[a] + displacement[a];
            let momentum = velocity[a] * solid.mass[a];
            total.push(&place, &(velocity[a] * 0.5), &momentum);
        })
    }
}
