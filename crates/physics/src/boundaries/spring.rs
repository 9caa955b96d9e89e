//! Springs and dampers between particles and a point of space.

use crate::Vector;

/// A spring with a damper from the centre of mass of some particles to a point of space.
///
/// With the distance `d` of the centre from the point and the direction e from there it pulls with
/// `F = -(k (d - l) + c e . v) e`, k being its stiffness, l its length without force, c that of the damper and v the velocity
/// of the centre. Each particle gets the share of its mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring<const D: usize> {
    /// Name for messages.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// The point in m.
    pub anchor: Vector<D>,
    /// Its length without force in m.
    pub length: f64,
    /// Stiffness in N/m.
    pub stiffness: f64,
    /// Damping in N s/m.
    pub damping: f64,
}

impl<const D: usize> Spring<D> {
    /// The mean over its particles by mass in kg, of places or of velocities.
    pub(crate) fn mean(&self, mass: &[f64], of: impl Fn(usize) -> Vector<D>) -> Vector<D> {
        let all = self.particles.iter().map(|&a| a as usize);
        let whole: f64 = all.clone().map(|a| mass[a]).sum();
        all.map(|a| of(a) * mass[a]).sum::<Vector<D>>() / whole
    }

    /// The force in N on a centre that is somewhere and moves.
    pub(crate) fn force(&self, place: &Vector<D>, velocity: &Vector<D>) -> Vector<D> {
        let way = place - self.anchor;
        let direction = way.try_normalize(0.0).unwrap_or_else(Vector::zeros);
        let tension = self.stiffness * (way.norm() - self.length);
        direction * -(tension + self.damping * direction.dot(velocity))
    }

    /// The largest step in s of central differences, with damping by the velocity half a step back, theory (67).
    pub(crate) fn stable_step(&self, mass: &[f64]) -> f64 {
        let whole: f64 = self.particles.iter().map(|&a| mass[a as usize]).sum();
        let [square, rate] = [self.stiffness, self.damping].map(|it| it / whole);
        4.0 / (rate + (rate * rate + 4.0 * square).sqrt())
    }
}
