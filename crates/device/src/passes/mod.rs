//! Whole passes over particles: laws with the loops over neighbours around them.
//!
//! Each pass is there twice from one law: as a loop in Rust for any number, and as text for a device.
//! Both add up in the same order, so that in double precision they agree to the bit.
//!
//! - [`solid`]: one explicit step of a total Lagrangian solid on frozen lists.
//! - [`fluid`]: what the particles of a weakly compressible fluid do to each other, and a step.

pub mod fluid;
mod rows;
pub mod solid;

pub use rows::{Rows, SLICE, Sliced};

use crate::law::Law;

/// The laws of all passes, with constants of some case.
pub fn laws() -> Vec<Law> {
    let fluid = fluid::Fluid::water(0.1);
    let solid = solid::Solid::rubber();
    vec![
        fluid.exchange_law(),
        fluid.advance_law(),
        solid.gradient_law(),
        solid.tension_law(),
        solid.force_law(),
        solid.kick_law(),
    ]
}
