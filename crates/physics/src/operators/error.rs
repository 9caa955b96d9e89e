//! What can be wrong with the support of an operator.

use thiserror::Error;

use crate::coordinates;
use crate::neighbors::NeighborError;

/// An operator that cannot be built on the given particles.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OperatorError {
    /// There is no list of neighbours.
    #[error(transparent)]
    Neighbors(#[from] NeighborError),
    /// Too few neighbours, or neighbours in a plane or line, for a correction matrix.
    #[error(
        "particle {id} at {at} has {neighbors} neighbours, which do not span \
         {dimension} dimensions (reciprocal condition {condition:.1e}): the {correction} \
         correction does not exist there; enlarge the smoothing length or refine the spacing",
        at = coordinates(position)
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
    /// Particles that are not those of an even lattice, with or without ghosts.
    #[error(
        "the neighbours of particle {id} at {at} do not surround it evenly: the strong form is \
         for a box of one lattice, with particles on its edges and none left out",
        at = coordinates(position)
    )]
    Gap {
        /// Number of the particle in the order of creation.
        id: u32,
        /// Its reference position in m.
        position: Vec<f64>,
    },
    /// Two particles at one place: the direction between them does not exist.
    #[error(
        "particles {first} and {second} lie at the same place {at}; remove one of them",
        at = coordinates(position)
    )]
    Coincident {
        /// Number of the one particle.
        first: u32,
        /// Number of the other.
        second: u32,
        /// Where they lie, in m.
        position: Vec<f64>,
    },
    /// Boundary areas that do not enclose the volumes of the particles.
    #[error(
        "the boundary areas of body {body} do not enclose its volume: they sum to {areas} m^(D-1) \
         instead of zero, and their moment misses the volume by a factor of {misfit:.1e}; correct \
         areas or volumes, or use plain gradients",
        areas = coordinates(sum)
    )]
    Areas {
        /// Number of the body.
        body: u32,
        /// Sum of its area vectors in m^(D-1).
        sum: Vec<f64>,
        /// Largest entry of `sum_b N_b (x) X_b / V - I`.
        misfit: f64,
    },
    /// No patch-consistent gradients were found.
    #[error(
        "patch-consistent gradients were not found in {steps} steps: areas are {left:.1e} m^(D-1) \
         off, {tolerance:.1e} are allowed; enlarge the supports, or use plain gradients"
    )]
    NoConvergence {
        /// Steps taken.
        steps: usize,
        /// Largest misfit of an area left, in m^(D-1).
        left: f64,
        /// What is allowed, in m^(D-1).
        tolerance: f64,
    },
}
