//! Formulas of smoothed particle hydrodynamics: kernels, materials, small tensors.
//!
//! Everything here is a pure function of numbers, generic over the number type
//! ([`Scalar`]), so that dual numbers give exact derivatives through the same body.
//! There are no loops over particles, no threads and no files in this crate.

pub mod fluid;
pub mod hyperelastic;
pub mod hypoelastic;
pub mod kernels;
mod power;
pub mod riemann;
mod scalar;
pub mod tensor;
pub mod volumetric;

pub use scalar::Scalar;
