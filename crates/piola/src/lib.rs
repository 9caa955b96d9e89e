//! piola: solid and fluid mechanics with smoothed particle hydrodynamics.
//!
//! The way into the library: [`case`] reads a case file and runs it, [`observe`] records what a run shows. What
//! they stand on are two crates of their own, all of which is found here, too: `piola-report`, the files of
//! results, as [`output`], and `piola-physics`, all that computes, as [`time`], [`schemes`], [`boundaries`],
//! [`operators`], [`geometry`], [`neighbors`], [`solve`], [`fields`] and [`parallel`].

pub mod case;
pub mod observe;

pub use piola_physics::{
    Tensor, Vector, boundaries, fields, geometry, neighbors, operators, parallel, schemes, solve,
    time,
};
pub use piola_report as output;
