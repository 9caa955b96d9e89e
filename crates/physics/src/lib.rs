//! All that computes in piola: particles and who their neighbours are, operators on them, the formulations,
//! integration in time. It reads no case file and draws nothing; meshes and clouds of points it reads, as they are
//! shapes.
//!
//! Its rooms, each of which uses only those further down in this list: [`time`], [`schemes`], [`boundaries`]
//! and [`operators`], [`geometry`] and [`neighbors`], [`solve`] and [`fields`], [`parallel`].

pub mod boundaries;
pub mod fields;
pub mod geometry;
pub mod neighbors;
pub mod operators;
pub mod parallel;
pub mod schemes;
pub mod solve;
pub mod time;

/// A point or vector in `D` dimensions.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
/// A second-order tensor in `D` dimensions.
pub type Tensor<const D: usize> = nalgebra::SMatrix<f64, D, D>;
