//! Pressure that follows the surface it acts on.

use std::sync::Arc;

use super::function::SpaceTime;
use crate::Vector;

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
    /// The pressure in Pa, positive in compression, as a function of reference place and of the
    /// load factor, which stands for the time.
    pub value: Arc<dyn SpaceTime>,
}
