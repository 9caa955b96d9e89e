//! What can be wrong with the support of an operator.

use thiserror::Error;

/// An operator that cannot be built on the given particles.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OperatorError {
    /// Too few neighbours, or neighbours in a plane or line, for a correction matrix.
    #[error(
        "particle {id} at {position:?} has {neighbors} neighbours, which do not span \
         {dimension} dimensions (reciprocal condition {condition:.1e}): the {correction} \
         correction does not exist there; enlarge the smoothing length or refine the spacing"
    )]
    PoorSupport {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
        /// How many neighbours it has.
        neighbors: usize,
        /// Dimensions of space.
        dimension: usize,
        /// Determinant of the moment matrix over its largest singular value to the power of the
        /// dimension: at most the smallest over the largest singular value.
        condition: f64,
        /// The correction that was asked for.
        correction: &'static str,
    },
    /// Two particles at one place: the direction between them does not exist.
    #[error(
        "particles {first} and {second} lie at the same place {position:?}; remove one of them"
    )]
    Coincident {
        /// Number of the one particle.
        first: u32,
        /// Number of the other.
        second: u32,
        /// Where they lie, in m.
        position: Vec<f64>,
    },
}
