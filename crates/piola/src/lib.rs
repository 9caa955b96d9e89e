//! piola: solid and fluid mechanics with smoothed particle hydrodynamics.
//!
//! The entry points of the library: [`case`] reads a case file and runs it, [`observe`] records the results of a run.
//! They build on two crates of their own, which are re-exported here: `piola-report`, the result files, as
//! [`output`], and `piola-physics`, everything that computes, as [`time`], [`schemes`], [`boundaries`],
//! [`operators`], [`geometry`], [`neighbors`], [`solve`], [`fields`] and [`parallel`].

pub mod case;
pub mod observe;

// The formulations, compiled.
use {piola_physics_1d as _, piola_physics_2d as _, piola_physics_3d as _};

pub use piola_physics::{
    Tensor, Vector, boundaries, coordinates, fields, geometry, neighbors, operators, parallel,
    schemes, solve, time,
};
pub use piola_report as output;
