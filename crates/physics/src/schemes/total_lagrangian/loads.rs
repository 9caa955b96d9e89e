//! What acts on a body from outside, as a function of the time or of the load factor.

use super::Solid;
use crate::boundaries::pressure::{Pressed, pressed_force};
use crate::boundaries::traction::Loaded;
use crate::boundaries::{BodyForce, Spring, padded};
use crate::operators::ReferenceGradient;
use crate::{Tensor, Vector};

/// Dead loads, follower pressures, and springs.
#[derive(Clone, Default)]
pub(super) struct Loads<const D: usize> {
    pub body_forces: Vec<BodyForce<D>>,
    pub loaded: Vec<Loaded<D>>,
    pub pressed: Vec<Pressed<D>>,
    pub springs: Vec<Spring<D>>,
}

impl<const D: usize> Loads<D> {
    /// Those on some particles, of which `place` says where they stand now, and all springs.
    pub fn part(&self, place: impl Fn(usize) -> Option<usize>) -> Self {
        let loaded = self.loaded.iter().filter_map(|it| Some(it.clone().on(place(it.particle)?)));
        let pressed = self.pressed.iter().filter_map(|it| Some(it.clone().on(place(it.particle)?)));
        Self {
            body_forces: self.body_forces.clone(),
            loaded: loaded.collect(),
            pressed: pressed.collect(),
            springs: self.springs.clone(),
        }
    }

    /// The forces in N of pressures at displacement gradients, with the particles they act on.
    pub fn pressures(
        &self,
        time: f64,
        gradient: &[Tensor<D>],
    ) -> impl Iterator<Item = (usize, Vector<D>)> {
        let pressed = self.pressed.iter();
        pressed.map(move |part| (part.particle, part.force(time, &gradient[part.particle])))
    }

    /// The forces in N of tractions, with the particles they act on.
    pub fn tractions(&self, time: f64) -> impl Iterator<Item = (usize, Vector<D>)> {
        self.loaded.iter().map(move |load| (load.particle, load.force(time)))
    }

    /// Whether nothing acts but body forces.
    pub fn is_empty(&self) -> bool {
        self.loaded.is_empty() && self.pressed.is_empty() && self.springs.is_empty()
    }

    /// Body forces at particle a in m/s^2.
    #[inline]
    pub fn acceleration(&self, solid: &Solid<D>, a: usize, time: f64) -> Vector<D> {
        let particles = &solid.particles;
        BodyForce::sum(&self.body_forces, particles.body[a], &particles.position[a], time)
    }

    /// Dead forces on all particles in N at a load factor, or their rates by it.
    pub fn dead(&self, solid: &Solid<D>, factor: f64, rate: bool) -> Vec<Vector<D>> {
        let particles = &solid.particles;
        let mut forces = vec![Vector::zeros(); particles.len()];
        for force in &self.body_forces {
            let acts = |body: u32| force.body.is_none_or(|own| own == body);
            for a in (0..particles.len()).filter(|&a| acts(particles.body[a])) {
                let place = padded(&particles.position[a]);
                for (component, value) in force.acceleration.iter().enumerate() {
                    let value = match rate {
                        true => value.rate(place, factor),
                        false => value.value(place, factor),
                    };
                    forces[a][component] += solid.mass[a] * value;
                }
            }
        }
        for load in &self.loaded {
            forces[load.particle] += match rate {
                true => load.force_rate(factor),
                false => load.force(factor),
            };
        }
        forces
    }

    /// `p N_a` of all pressures on each of `count` particles in N, or its rate; empty without pressure.
    pub fn pressing(&self, count: usize, factor: f64, rate: bool) -> Vec<Vector<D>> {
        if self.pressed.is_empty() {
            return Vec::new();
        }
        let mut pressing = vec![Vector::zeros(); count];
        for part in &self.pressed {
            pressing[part.particle] += match rate {
                true => part.pressing_rate(factor),
                false => part.pressing(factor),
            };
        }
        pressing
    }
}

/// Adds the forces of pressures on particles in N.
pub(super) fn press<const D: usize>(
    operator: &ReferenceGradient<D>,
    displacement: &[Vector<D>],
    pressing: &[Vector<D>],
    forces: &mut [Vector<D>],
) {
    for (a, pressing) in pressing.iter().enumerate().filter(|(_, p)| p.amax() > 0.0) {
        forces[a] += pressed_force(&operator.gradient_at(displacement, a), pressing);
    }
}
