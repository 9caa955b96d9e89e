//! Formulas of smoothed particle hydrodynamics: kernels, materials, small tensors.
//!
//! Everything here is a pure function of numbers, generic over the number type
//! ([`Number`]), so that dual numbers give exact derivatives through the same body, and numbers that
//! record what is done to them its text for other machines.
//! There are no loops over particles, no threads and no files in this crate.

pub mod fluid;
mod frame;
pub mod functions;
pub mod hyperelastic;
pub mod hypoelastic;
pub mod kernels;
mod lanes;
mod number;
pub mod pairs;
mod power;
pub mod riemann;
mod slope;
pub mod tensor;
pub mod viscous;
pub mod volumetric;
pub mod waves;

pub use lanes::{Lanes, Lanes4, Mask4, WIDTH};
pub use number::{Number, Scalar};
pub use slope::Slope;
