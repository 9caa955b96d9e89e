//! The largest step of central differences.

use std::sync::Arc;

use super::{Discrete, Stiffness};
use crate::schemes::solid::fastest_mode;
use crate::solve::Tangent as _;

/// By how much the frequency that is found may be too small, as all of Lanczos' values are.
const SAFETY: f64 = 1.01;

/// Largest step of central differences at rest, `2/omega`, theory (50), and the particle that moves
/// most in the mode it belongs to.
pub(super) fn stable_step<const D: usize>(
    discrete: &Arc<Discrete<D>>,
    mass: &[f64],
) -> (f64, usize) {
    // That of the body at rest.
    let mut stiffness = Stiffness::new(discrete.clone());
    let (square, fastest) = fastest_mode(
        mass,
        |_, _| true,
        |direction, force| {
            stiffness.apply(direction, force);
            force.iter_mut().for_each(|force| *force = -*force);
        },
    );
    (2.0 / (SAFETY * square.sqrt()), fastest)
}
