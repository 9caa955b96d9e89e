//! Dead tractions on the particles of a boundary.

use std::sync::Arc;

use super::function::{SpaceTime, padded};
use crate::Vector;

/// A traction in Pa of the reference area on a set of particles that carry areas: `A_a t_a / V_a`
/// of Upwind (3.39).
///
/// The load keeps its direction and its reference area. In one dimension that is sound. In two and
/// three a material without shear stiffness cannot bear it: wherever the traction t is not zero,
/// surface waves of wave number k grow like `exp(k sqrt(|t|/rho) time)`, in tension and in
/// compression, and the faster the finer the particles are. Velocity upwinding only slows this.
#[derive(Clone)]
pub struct Traction<const D: usize> {
    /// Name for messages.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// Reference area of each of them in m^(D-1).
    pub areas: Vec<f64>,
    /// Where in the reference state its value is taken for each of them, in m; where they are if
    /// this is empty. Sums over a face have several points with shares of several particles.
    pub places: Vec<Vector<D>>,
    /// The traction vector in Pa.
    pub value: [Arc<dyn SpaceTime>; D],
}

impl<const D: usize> Traction<D> {
    /// Particle, area in m^(D-1) and place of the value of each part, of particles at `positions` in
    /// m.
    pub(crate) fn parts(
        &self,
        positions: &[Vector<D>],
    ) -> impl Iterator<Item = (usize, f64, [f64; 3])> {
        let parts = self.particles.iter().zip(&self.areas).enumerate();
        parts.map(|(number, (&particle, &area))| {
            let own = || positions[particle as usize];
            let place = self.places.get(number).copied().unwrap_or_else(own);
            (particle as usize, area, padded(&place))
        })
    }

    /// The load on each of its particles, of which all are at `positions` in m.
    pub(crate) fn loaded(&self, positions: &[Vector<D>]) -> impl Iterator<Item = Loaded<D>> {
        self.parts(positions).map(|(particle, area, place)| {
            Loaded::new(particle, Vector::from_element(area), place, self.value.clone())
        })
    }

    /// The load on a particle with this area in m^(D-1) for each component, of the value at a place.
    pub(crate) fn at(&self, particle: usize, area: Vector<D>, place: &Vector<D>) -> Loaded<D> {
        Loaded::new(particle, area, padded(place), self.value.clone())
    }
}

/// A traction at one particle.
#[derive(Clone)]
pub(crate) struct Loaded<const D: usize> {
    /// Index of the particle in memory.
    pub particle: usize,
    /// Reference area in m^(D-1) that each component acts on.
    area: Vector<D>,
    place: [f64; 3],
    value: [Arc<dyn SpaceTime>; D],
    /// The traction, if it is the same at all times.
    steady: Option<Vector<D>>,
}

impl<const D: usize> Loaded<D> {
    fn new(
        particle: usize,
        area: Vector<D>,
        place: [f64; 3],
        value: [Arc<dyn SpaceTime>; D],
    ) -> Self {
        let is_steady = value.iter().all(|value| value.is_steady());
        let steady = is_steady.then(|| Vector::from_fn(|i, _| value[i].value(place, 0.0)));
        Self { particle, area, place, value, steady }
    }

    /// The same on another particle.
    pub fn on(self, particle: usize) -> Self {
        Self { particle, ..self }
    }

    /// The force in N at a time in s.
    pub fn force(&self, time: f64) -> Vector<D> {
        self.traction(time).component_mul(&self.area)
    }

    /// Its rate in N/s.
    pub fn force_rate(&self, time: f64) -> Vector<D> {
        self.traction_rate(time).component_mul(&self.area)
    }

    /// The traction in Pa at a time in s.
    pub fn traction(&self, time: f64) -> Vector<D> {
        let now = || Vector::from_fn(|i, _| self.value[i].value(self.place, time));
        self.steady.unwrap_or_else(now)
    }

    /// Its rate in Pa/s.
    pub fn traction_rate(&self, time: f64) -> Vector<D> {
        Vector::from_fn(|i, _| self.value[i].rate(self.place, time))
    }
}
