//! What can be wrong with the points that neighbours are searched for.

use thiserror::Error;

use crate::coordinates;

/// A reason why no neighbour list can be made. Particles are named by their row.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NeighborError {
    /// A coordinate is NaN or infinite.
    #[error(
        "particle {particle} is at {at}, expected finite coordinates in m",
        at = coordinates(position)
    )]
    NonFinite {
        /// Row of the particle.
        particle: usize,
        /// Its coordinates in m.
        position: Vec<f64>,
    },
    /// A support radius is not a usable length.
    #[error(
        "particle {particle} has a support radius of {support} m, expected a length between \
         {least:e} and {most:e} m; check its spacing and smoothing length",
        least = super::LEAST_SUPPORT,
        most = super::MOST_SUPPORT
    )]
    Support {
        /// Row of the particle.
        particle: usize,
        /// Its support radius in m.
        support: f64,
    },
    /// There are not as many support radii as points.
    #[error("{points} points have {supports} support radii, expected one each")]
    SupportCount {
        /// Number of points.
        points: usize,
        /// Number of support radii.
        supports: usize,
    },
    /// Particles are numbered with 32 bits.
    #[error("{count} particles are too many, expected at most {}", u32::MAX)]
    TooManyParticles {
        /// Number of particles.
        count: usize,
    },
    /// A list would not fit into memory, or its entries could not be numbered with 32 bits.
    #[error(
        "{particles} particles have more than {most} neighbours in all; make the smoothing length \
         smaller in units of the spacing, or use fewer particles"
    )]
    TooManyEntries {
        /// Number of particles.
        particles: usize,
        /// Most entries of a list.
        most: usize,
    },
    /// The bounds of a periodic axis are not an interval.
    #[error(
        "the domain is periodic in {axis} from {lower} to {upper} m, expected finite bounds, the \
         lower one first, and a finite length"
    )]
    PeriodicBounds {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Lower bound in m.
        lower: f64,
        /// Upper bound in m.
        upper: f64,
    },
    /// A particle would see two images of another one, or itself.
    #[error(
        "the domain is periodic in {axis} with a length of {length} m, expected at least twice the \
         support radius {support} m of particle {particle}; lengthen the domain or refine the \
         particles"
    )]
    PeriodicTooShort {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Length of the period in m.
        length: f64,
        /// Row of the particle with the largest support.
        particle: usize,
        /// Its support radius in m.
        support: f64,
    },
    /// A period is so long that cells along it cannot be numbered exactly.
    #[error(
        "the domain is periodic in {axis} with a length of {length} m, expected at most {most:e} \
         times the support radius {support} m; check the bounds of the domain",
        most = super::MOST_CELLS
    )]
    PeriodicTooLong {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Length of the period in m.
        length: f64,
        /// The support radius in m that the cells are made for.
        support: f64,
    },
    /// Two particles are at the same place.
    #[error(
        "particles {first} and {second} are {distance:e} m apart at {at}, expected at \
         least {tolerance:e} m; remove one of them or the overlap of their bodies",
        at = coordinates(position)
    )]
    Coincident {
        /// Row of the first particle.
        first: usize,
        /// Row of the second particle.
        second: usize,
        /// Their distance in m.
        distance: f64,
        /// The distance in m that was asked for.
        tolerance: f64,
        /// Coordinates of the first particle in m.
        position: Vec<f64>,
    },
    /// A list that must be symmetric is not.
    #[error(
        "particle {neighbor} is a neighbour of {particle} but not the other way round, expected a \
         symmetric list; take its symmetric closure first"
    )]
    NotSymmetric {
        /// Row that holds the entry.
        particle: usize,
        /// Row that lacks it.
        neighbor: usize,
    },
    /// One of several ranks has no list.
    #[error("the neighbours of another rank's particles cannot be found")]
    OtherRank,
}

/// Name of a coordinate axis.
pub(super) fn axis_name(axis: usize) -> &'static str {
    ["x", "y", "z"].get(axis).copied().unwrap_or("a further axis")
}
