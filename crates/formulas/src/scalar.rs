//! The number type of all formulas.

use num_dual::DualNum;

/// A number that a formula computes with: `f64`, or a dual number that carries exact derivatives.
///
/// Branches in a formula look at the real part only (`x.re()`).
pub trait Scalar: DualNum<Primitive = f64> + nalgebra::Scalar + Copy {}

impl<T: DualNum<Primitive = f64> + nalgebra::Scalar + Copy> Scalar for T {}
