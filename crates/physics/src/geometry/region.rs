//! Regions that select particles.

use super::error::{axis_name, finite, positive};
use super::fill::ON_BOUNDARY;
use super::{GeometryError, Particles};
use crate::Vector;

/// A face lies in a plane if its centre is as near to it as this share of its size: coordinates in
/// single precision are so.
const IN_PLANE: f64 = 1e-3;

/// Cosine of the largest angle between the outward normal of a face and that of its plane.
const ALONG: f64 = 0.99;

/// A part of space that selects the particles whose reference positions lie in it. All parts are
/// closed, with a tolerance of 1e-9 spacings for rounding.
#[derive(Clone, Debug, PartialEq)]
pub enum Region<const D: usize> {
    /// Everything.
    All,
    /// A layer around a plane (in 2D a line, in 1D a point) of half a particle to either side.
    Plane {
        /// A point of the plane in m.
        point: Vector<D>,
        /// Unit normal.
        normal: Vector<D>,
    },
    /// The box between two corners in m.
    Box {
        /// Lower corner.
        min: Vector<D>,
        /// Upper corner.
        max: Vector<D>,
    },
    /// A ball, in 2D a disc.
    Ball {
        /// Centre in m.
        center: Vector<D>,
        /// Radius in m.
        radius: f64,
    },
    /// The side of a plane that its normal points to.
    HalfSpace {
        /// A point of the plane in m.
        point: Vector<D>,
        /// Unit normal.
        normal: Vector<D>,
    },
}

impl<const D: usize> Region<D> {
    /// The layer around the plane through `point` across `normal`, which may have any length.
    ///
    /// # Errors
    /// Components that are not finite, and a normal of length 0.
    pub fn plane(point: Vector<D>, normal: Vector<D>) -> Result<Self, GeometryError> {
        finite("the point of a plane", point.as_slice())?;
        Ok(Self::Plane { point, normal: unit(&normal)? })
    }

    /// The box between two corners in m, which may be flat.
    ///
    /// # Errors
    /// Corners that are not finite or not in order.
    pub fn cuboid(min: Vector<D>, max: Vector<D>) -> Result<Self, GeometryError> {
        finite("the lower corner of a box", min.as_slice())?;
        finite("the upper corner of a box", max.as_slice())?;
        if let Some(axis) = (0..D).find(|&axis| min[axis] > max[axis]) {
            let (axis, min, max) = (axis_name(axis), min[axis], max[axis]);
            return Err(GeometryError::Corners { axis, min, max });
        }
        Ok(Self::Box { min, max })
    }

    /// The ball around `center` in m.
    ///
    /// # Errors
    /// A centre that is not finite, a radius that is not positive.
    pub fn ball(center: Vector<D>, radius: f64) -> Result<Self, GeometryError> {
        finite("the center of a ball", center.as_slice())?;
        positive("the radius of a ball", radius)?;
        Ok(Self::Ball { center, radius })
    }

    /// The side that `normal` points to of the plane through `point`.
    ///
    /// # Errors
    /// Components that are not finite, and a normal of length 0.
    pub fn half_space(point: Vector<D>, normal: Vector<D>) -> Result<Self, GeometryError> {
        finite("the point of a half space", point.as_slice())?;
        Ok(Self::HalfSpace { point, normal: unit(&normal)? })
    }

    /// The particles of the region, in ascending order. Particles without a finite position are
    /// in no region but [`Self::All`].
    ///
    /// The layer around a plane reaches half the smallest edge of a particle's cell to either
    /// side. That edge is taken from the kernel weight, as the edge that a cell of this volume has
    /// when its others are as large as the spacing: exact for square cells, and in 2D for oblong
    /// ones; in 3D it is smaller than the true edge where two edges are short.
    pub fn select(&self, particles: &Particles<D>) -> Vec<u32> {
        let inside = |a: &u32| {
            let a = *a as usize;
            let spacing = particles.spacing[a];
            let edge = particles.weight[a] / spacing.powi(D as i32 - 1);
            self.contains(&particles.position[a], spacing, 0.5 * edge.min(spacing))
        };
        (0..particles.len() as u32).filter(inside).collect()
    }

    /// The boundary faces of particles that come from meshes, in ascending order: those whose centre
    /// lies in the region. Those of a plane lie in it, and their outward normal points along its.
    pub fn faces(&self, particles: &Particles<D>) -> Vec<u32> {
        let inside = |face: &u32| {
            let face = &particles.surface.faces[*face as usize];
            let size = face.area.norm().powf(1.0 / (D as f64 - 1.0).max(1.0));
            let turns = match self {
                Self::Plane { normal, .. } => face.area.dot(normal) < ALONG * face.area.norm(),
                _ => false,
            };
            !turns && self.contains(&face.place, size, IN_PLANE * size)
        };
        (0..particles.surface.faces.len() as u32).filter(inside).collect()
    }

    /// Whether a place lies in the region, with a tolerance for rounding at particles `spacing` m
    /// apart; the layer around a plane reaches `reach` m to either side.
    fn contains(&self, x: &Vector<D>, spacing: f64, reach: f64) -> bool {
        let slack = ON_BOUNDARY * spacing;
        match self {
            Self::All => true,
            Self::Plane { point, normal } => (x - point).dot(normal).abs() <= reach + slack,
            Self::Box { min, max } => {
                (0..D).all(|k| x[k] >= min[k] - slack && x[k] <= max[k] + slack)
            }
            Self::Ball { center, radius } => (x - center).norm() <= radius + slack,
            Self::HalfSpace { point, normal } => (x - point).dot(normal) >= -slack,
        }
    }
}

/// The direction of `normal`.
fn unit<const D: usize>(normal: &Vector<D>) -> Result<Vector<D>, GeometryError> {
    // Scaled first, as the squares of very large or small components are not numbers.
    let scaled = normal / normal.amax();
    let unit = scaled / scaled.norm();
    if unit.iter().all(|x| x.is_finite()) {
        Ok(unit)
    } else {
        Err(GeometryError::Normal { value: normal.as_slice().to_vec() })
    }
}
