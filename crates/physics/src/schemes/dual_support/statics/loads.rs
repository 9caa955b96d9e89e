//! What acts on a body from outside, as a function of the load factor.

use super::super::Discrete;
use crate::Vector;
use crate::boundaries::pressure::{Pressed, pressed_force};
use crate::boundaries::{BodyForce, Traction, padded};

/// Dead loads and follower pressures.
#[derive(Clone, Default)]
pub(super) struct Loads<const D: usize> {
    pub body_forces: Vec<BodyForce<D>>,
    pub tractions: Vec<Traction<D>>,
    pub pressed: Vec<Pressed<D>>,
}

impl<const D: usize> Loads<D> {
    /// Dead forces on all particles in N at a load factor, or their rates by it.
    pub fn dead(&self, discrete: &Discrete<D>, factor: f64, rate: bool) -> Vec<Vector<D>> {
        let particles = &discrete.particles;
        let mut forces = vec![Vector::zeros(); particles.len()];
        for force in &self.body_forces {
            let acts = |body: u32| force.body.is_none_or(|own| own == body);
            for a in (0..particles.len()).filter(|&a| acts(particles.body[a])) {
                let place = padded(&particles.position[a]);
                let mass = discrete.mass(a);
                for (component, value) in force.acceleration.iter().enumerate() {
                    let value = match rate {
                        true => value.rate(place, factor),
                        false => value.value(place, factor),
                    };
                    forces[a][component] += mass * value;
                }
            }
        }
        for traction in &self.tractions {
            for (a, area, place) in traction.parts(&particles.position) {
                for (component, value) in traction.value.iter().enumerate() {
                    let value = match rate {
                        true => value.rate(place, factor),
                        false => value.value(place, factor),
                    };
                    forces[a][component] += area * value;
                }
            }
        }
        forces
    }

    /// `p N_a` of all pressures on each particle in N, or its rate; empty without pressure.
    pub fn pressing(&self, discrete: &Discrete<D>, factor: f64, rate: bool) -> Vec<Vector<D>> {
        if self.pressed.is_empty() {
            return Vec::new();
        }
        let mut pressing = vec![Vector::zeros(); discrete.len()];
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
    discrete: &Discrete<D>,
    displacement: &[Vector<D>],
    pressing: &[Vector<D>],
    forces: &mut [Vector<D>],
) {
    for (a, pressing) in pressing.iter().enumerate().filter(|(_, p)| p.amax() > 0.0) {
        forces[a] += pressed_force(&discrete.displacement_gradient(displacement, a), pressing);
    }
}
