//! piola: solid and fluid mechanics with smoothed particle hydrodynamics.
//!
//! The rooms of the library, each of which uses only those further down in this list:
//! [`case`], [`observe`], [`time`], [`output`], [`schemes`], [`boundaries`] and
//! [`operators`], [`geometry`] and [`neighbors`], [`solve`] and [`fields`], [`parallel`].

pub mod boundaries;
pub mod case;
pub mod fields;
pub mod geometry;
pub mod neighbors;
pub mod observe;
pub mod operators;
pub mod output;
pub mod parallel;
pub mod schemes;
pub mod solve;
pub mod time;

/// A point or vector in `D` dimensions.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
/// A second-order tensor in `D` dimensions.
pub type Tensor<const D: usize> = nalgebra::SMatrix<f64, D, D>;
