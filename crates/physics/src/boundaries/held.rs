//! Displacements with prescribed values, and particles that move together.

use std::sync::Arc;

use super::function::SpaceTime;
use crate::Vector;

/// The displacement of a set of particles along a direction, prescribed as a function of reference
/// place and of the load factor, which stands for the time. Across the direction they are free:
/// along an axis this prescribes a component, along a normal it is a roller on an inclined plane.
#[derive(Clone)]
pub struct PrescribedDisplacement<const D: usize> {
    /// Name for messages and for the reaction.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// The direction, of any length.
    pub direction: Vector<D>,
    /// Displacement along the direction in m.
    pub value: Arc<dyn SpaceTime>,
}

impl<const D: usize> PrescribedDisplacement<D> {
    /// A component, 0, 1 or 2 for x, y or z, of some particles. A component that does not exist
    /// gives a direction without length, which is refused where it is used.
    pub fn component(
        name: impl Into<String>,
        particles: Vec<u32>,
        component: usize,
        value: Arc<dyn SpaceTime>,
    ) -> Self {
        let direction = Vector::from_fn(|i, _| f64::from(u8::from(i == component)));
        Self { name: name.into(), particles, direction, value }
    }

    /// All components of some particles held at zero.
    pub fn clamp(name: &str, particles: &[u32]) -> [Self; D] {
        std::array::from_fn(|component| {
            Self::component(name, particles.to_vec(), component, Arc::new(0.0))
        })
    }
}

/// The displacement of boundary faces of cells along a direction, prescribed as a function of the
/// face's reference place and of the load factor, which stands for the time. For clouds of cell
/// centres, which have no particle where the body is held.
#[derive(Clone)]
pub struct PrescribedFaces<const D: usize> {
    /// Name for messages and for the reaction.
    pub name: String,
    /// Faces by number.
    pub faces: Vec<u32>,
    /// The direction, of any length.
    pub direction: Vector<D>,
    /// Displacement along the direction in m.
    pub value: Arc<dyn SpaceTime>,
}

/// Particles whose displacements have one component in common, which is not prescribed: with a tie
/// for each component they are the face of a rigid platen that is guided, and does not tilt.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tie {
    /// Name for messages.
    pub name: String,
    /// Particles by index in memory.
    pub particles: Vec<u32>,
    /// 0, 1 or 2 for x, y or z.
    pub component: usize,
}
