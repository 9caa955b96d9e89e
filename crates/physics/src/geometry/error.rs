//! What can be wrong with shapes, lattices and regions.

use thiserror::Error;

use super::fill::MOST_SITES;
use super::{MeshError, OutlineError, PointsError, SurfaceError};
use crate::coordinates;

/// A reason why no particles can be made or selected.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A coordinate is NaN, infinite, or so large that lengths overflow.
    #[error("{what} is {place}, expected finite coordinates in m", place = coordinates(value))]
    NotFinite {
        /// What the coordinates are, for example `the center of a ball`.
        what: &'static str,
        /// The coordinates.
        value: Vec<f64>,
    },
    /// A length must be positive.
    #[error("{what} is {value} m, expected a finite length above 0")]
    NotPositive {
        /// What the length is, for example `the radius of a ball`.
        what: &'static str,
        /// The length in m.
        value: f64,
    },
    /// The corners of a box are not in order.
    #[error("a box reaches from {min} to {max} m in {axis}, expected the smaller one first")]
    Corners {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Coordinate of the first corner in m.
        min: f64,
        /// Coordinate of the second corner in m.
        max: f64,
    },
    /// An annulus is turned inside out.
    #[error("an annulus has the radii {inner} and {outer} m, expected the smaller one first")]
    Radii {
        /// Inner radius in m.
        inner: f64,
        /// Outer radius in m.
        outer: f64,
    },
    /// A shape or lattice does not exist in this dimension.
    #[error("{what} in {got}D, expected {expected}")]
    Dimension {
        /// The shape or lattice, with its article.
        what: &'static str,
        /// Dimensions of space.
        got: usize,
        /// Where it exists.
        expected: &'static str,
    },
    /// A polygon encloses nothing.
    #[error("a polygon has {count} corners, expected at least 3, none of them twice")]
    FewCorners {
        /// Their number.
        count: usize,
    },
    /// A polygon is none.
    #[error(
        "sides {first} and {second} of a polygon cross or touch at {} m; side 1 goes from the first corner to the second, \
         expected sides that meet only at their corners",
        coordinates(place)
    )]
    CrossingSides {
        /// Number of a side, from 1.
        first: usize,
        /// Number of another one.
        second: usize,
        /// Where they meet, in m.
        place: [f64; 2],
    },
    /// A lattice that is turned meets itself across no periodic bound.
    #[error(
        "the bounding box of a turned body spans the whole periodic domain, where its lattice \
         would not match itself: leave the body as it is and turn the rest of the case, or make \
         it shorter"
    )]
    TurnedPeriodic,
    /// A combination of no shapes.
    #[error("{what} has no shapes, expected at least one")]
    NoShapes {
        /// The combination, with its article.
        what: &'static str,
    },
    /// The distance from the boundary is not known.
    #[error(
        "a layer follows the boundary of one shape: expected a surface, an outline, a polygon, a box, a ball, an annulus or a \
         cylinder, or one of them turned; make a layer of each shape and combine the layers"
    )]
    NoLayer,
    /// A normal has no direction.
    #[error(
        "the normal is {normal}, expected finite components, not all of them 0",
        normal = coordinates(value)
    )]
    Normal {
        /// The components.
        value: Vec<f64>,
    },
    /// Other arrangements than a square lattice have one spacing.
    #[error("{what} the spacings {value:?} m, expected exactly the same along each axis")]
    Uneven {
        /// What has them.
        what: &'static str,
        /// The spacings.
        value: Vec<f64>,
    },
    /// Concentric layers in what has no centre and no axis.
    #[error(
        "concentric layers fill a whole body that is a ball, a disc, an annulus or a cylinder; \
         define the rest as another body"
    )]
    NotRound,
    /// Concentric layers and packed particles do not go on beyond a body.
    #[error(
        "ghosts continue a lattice, which concentric layers and packed particles are not: expected \
         `square` or `hexagonal`"
    )]
    NoSurroundings,
    /// Particles moved by half a spacing can meet.
    #[error("the jitter is {value} spacings, expected at least 0 and below 0.5")]
    Jitter {
        /// The jitter in spacings.
        value: f64,
    },
    /// Coordinates are too large for the spacing.
    #[error(
        "a spacing of {spacing} m at coordinates up to {coordinate} m cannot be resolved by \
         floating-point numbers; move the body closer to the origin or make it coarser"
    )]
    TooFine {
        /// Spacing in m.
        spacing: f64,
        /// Largest coordinate in m.
        coordinate: f64,
    },
    /// The spacing is too small for the extent.
    #[error(
        "a spacing of {spacing} m in a body of {extents} m gives about {estimate:.1e} lattice \
         sites, expected at most {:.0e}; make the spacing larger",
        MOST_SITES as f64,
        extents = coordinates(extent)
    )]
    TooManySites {
        /// Smallest spacing in m.
        spacing: f64,
        /// Extent of the body in m.
        extent: Vec<f64>,
        /// Number of sites of the lattice around the body.
        estimate: f64,
    },
    /// The bodies of a run have too many particles together.
    #[error("the bodies have {count} particles together, expected at most {}", u32::MAX)]
    TooManyParticles {
        /// Number of particles.
        count: usize,
    },
    /// No site of the lattice lies inside.
    #[error(
        "the body has no particles; check its shape, and that its spacing is small enough to \
         resolve it"
    )]
    NoParticles,
    /// A file of points cannot be used.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// A surface of triangles cannot be used.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// An outline cannot be read.
    #[error(transparent)]
    Outline(#[from] OutlineError),
    /// A mesh cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Name of a coordinate axis.
pub(super) fn axis_name(axis: usize) -> &'static str {
    ["x", "y", "z"].get(axis).copied().unwrap_or("a further axis")
}

/// Refuses coordinates that are not finite.
pub(super) fn finite(what: &'static str, value: &[f64]) -> Result<(), GeometryError> {
    if value.iter().all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(GeometryError::NotFinite { what, value: value.to_vec() })
    }
}

/// Refuses lengths that are not positive and finite.
pub(super) fn positive(what: &'static str, value: f64) -> Result<(), GeometryError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(GeometryError::NotPositive { what, value })
    }
}
