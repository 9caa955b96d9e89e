//! Pressure that follows the surface it acts on.

use std::sync::Arc;

use piola_formulas::tensor;

use super::function::{SpaceTime, padded};
use crate::{Tensor, Vector};

/// A pressure on a set of particles that carry boundary areas, along the normal and on the area of
/// the moment: `-p cof(F_a) N_a` with the outward reference area vector N.
#[derive(Clone)]
pub struct FollowerPressure<const D: usize> {
    /// Name for messages.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// Outward reference area vector of each of them in m^(D-1).
    pub areas: Vec<Vector<D>>,
    /// Where in the reference state its value is taken for each of them, in m; where they are if
    /// this is empty. Sums over a face have several points with shares of several particles.
    pub places: Vec<Vector<D>>,
    /// The pressure in Pa, positive in compression, as a function of reference place and of the
    /// time, or of the load factor, which stands for it.
    pub value: Arc<dyn SpaceTime>,
}

impl<const D: usize> FollowerPressure<D> {
    /// The pressure on each of its particles, of which all are at `positions` in m.
    pub(crate) fn pressed(&self, positions: &[Vector<D>]) -> impl Iterator<Item = Pressed<D>> {
        let parts = self.particles.iter().zip(&self.areas).enumerate();
        parts.map(|(number, (&particle, &area))| {
            let own = || positions[particle as usize];
            let place = padded(&self.places.get(number).copied().unwrap_or_else(own));
            Pressed { particle: particle as usize, area, place, value: self.value.clone() }
        })
    }
}

/// A pressure at one particle.
#[derive(Clone)]
pub(crate) struct Pressed<const D: usize> {
    /// Index of the particle in memory.
    pub particle: usize,
    /// Outward reference area vector N in m^(D-1).
    area: Vector<D>,
    place: [f64; 3],
    value: Arc<dyn SpaceTime>,
}

impl<const D: usize> Pressed<D> {
    /// The same on another particle.
    pub fn on(self, particle: usize) -> Self {
        Self { particle, ..self }
    }

    /// `p N` at a time in s, in N.
    pub fn pressing(&self, time: f64) -> Vector<D> {
        self.area * self.value.value(self.place, time)
    }

    /// Its rate in N/s.
    pub fn pressing_rate(&self, time: f64) -> Vector<D> {
        self.area * self.value.rate(self.place, time)
    }

    /// The force in N at a time in s on a particle with the displacement gradient A = F - I.
    pub fn force(&self, time: f64, gradient: &Tensor<D>) -> Vector<D> {
        pressed_force(gradient, &self.pressing(time))
    }
}

/// `-cof(F) (p N)` in N, with the displacement gradient A = F - I and `p N` in N.
pub(crate) fn pressed_force<const D: usize>(
    gradient: &Tensor<D>,
    pressing: &Vector<D>,
) -> Vector<D> {
    -(tensor::cofactor(&(gradient + Tensor::identity())) * pressing)
}
