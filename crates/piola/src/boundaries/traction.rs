//! Dead tractions on the particles of a boundary.

use std::sync::Arc;

use super::function::SpaceTime;

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
    /// The traction vector in Pa.
    pub value: [Arc<dyn SpaceTime>; D],
}
