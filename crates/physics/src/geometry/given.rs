//! Particles from points at hand.

use std::collections::HashMap;

use thiserror::Error;

use super::Particles;
use super::points::{place, push};
use crate::Vector;
use crate::coordinates;

/// Points with their volumes, of which a body is made.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCloud {
    dimension: usize,
    positions: Vec<f64>,
    volumes: Vec<f64>,
}

/// Why points cannot be used, and which. Particles are counted from 0.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PointCloudError {
    /// There is none.
    #[error("a cloud needs at least one particle")]
    Empty,
    /// Points have coordinates that no space has.
    #[error("particles have {got} coordinates, expected 1 to 3")]
    Dimension {
        /// How many.
        got: usize,
    },
    /// Numbers do not make up as many points as there are volumes.
    #[error(
        "{coordinates} coordinates in {dimension}D and {volumes} volumes, expected {dimension} for each volume"
    )]
    Length {
        /// Coordinates of a point.
        dimension: usize,
        /// Coordinates of all.
        coordinates: usize,
        /// Volumes.
        volumes: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("particle {particle}: {axis} is {got}, expected a finite number of m")]
    NotFinite {
        /// Its number.
        particle: usize,
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// The coordinate.
        got: f64,
    },
    /// A volume is not positive.
    #[error("particle {particle}: the volume is {got}, expected a finite number above 0")]
    NotPositive {
        /// Its number.
        particle: usize,
        /// The volume.
        got: f64,
    },
    /// Two particles are at one place.
    #[error(
        "particles {first} and {particle} are both at {at}, expected each place once",
        at = coordinates(point)
    )]
    Duplicate {
        /// The number of the first of them.
        first: usize,
        /// That of the second.
        particle: usize,
        /// Coordinates in m.
        point: Vec<f64>,
    },
}

impl PointCloud {
    /// Points with `dimension` coordinates each in m, point by point, and the volume of each in m^D.
    ///
    /// # Errors
    /// [`PointCloudError`], which names the first particle that cannot be used.
    pub fn new(
        dimension: usize,
        positions: Vec<f64>,
        volumes: Vec<f64>,
    ) -> Result<Self, PointCloudError> {
        if !(1..=3).contains(&dimension) {
            return Err(PointCloudError::Dimension { got: dimension });
        }
        let (coordinates, count) = (positions.len(), volumes.len());
        if coordinates != dimension * count {
            return Err(PointCloudError::Length { dimension, coordinates, volumes: count });
        }
        if count == 0 {
            return Err(PointCloudError::Empty);
        }
        let mut known = HashMap::new();
        for (particle, (point, &got)) in positions.chunks_exact(dimension).zip(&volumes).enumerate()
        {
            let names = ["x", "y", "z"].into_iter().zip(point);
            if let Some((axis, &got)) = names.into_iter().find(|(_, x)| !x.is_finite()) {
                return Err(PointCloudError::NotFinite { particle, axis, got });
            }
            if !(got > 0.0 && got.is_finite()) {
                return Err(PointCloudError::NotPositive { particle, got });
            }
            let mut own = [0; 3];
            own.iter_mut().zip(point).for_each(|(bits, x)| *bits = place(*x));
            if let Some(first) = known.insert(own, particle) {
                let point = point.to_vec();
                return Err(PointCloudError::Duplicate { first, particle, point });
            }
        }
        Ok(Self { dimension, positions, volumes })
    }

    /// Coordinates of a point.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Coordinates in m, point by point.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Volumes in m^D.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// Its particles, if it is of `D` dimensions: the volume of a point is both quadrature volume and kernel weight,
    /// and its spacing the edge of a cube of this volume.
    #[inline(never)]
    pub fn particles<const D: usize>(&self) -> Option<Particles<D>> {
        let mut particles = Particles::default();
        for (point, &volume) in self.positions.chunks_exact(self.dimension).zip(&self.volumes) {
            let position = Vector::<D>::from_column_slice(point.get(..D)?);
            push(&mut particles, position, volume);
        }
        (self.dimension == D).then_some(particles)
    }
}
