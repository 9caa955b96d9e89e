//! The choices of the dual-support formulation.

use piola_formulas::hyperelastic::Reduced;

use super::StaticsInput;
use crate::Vector;
use crate::solve::{LinearMethod, Newton};

/// Which gradient coefficients are used.
#[derive(Clone, Debug, PartialEq)]
pub enum Gradients<const D: usize> {
    /// Those of the paper. On clouds that are no lattice a constant stress is not in equilibrium.
    Plain,
    /// Corrected so that it is, theory (45) and (46): what to use wherever the boundary is known.
    PatchConsistent {
        /// Outward boundary area vector of each particle in m^(D-1), zero inside.
        areas: Vec<Vector<D>>,
    },
}

/// Numerical settings of the formulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings<const D: usize> {
    /// The gradient coefficients.
    pub gradients: Gradients<D>,
    /// Coefficient of the hourglass energy, a pure number that multiplies the shear modulus:
    /// the `mu/m_L` of Dual-support (21) is 1. From 0.05 to 0.1 with patch-consistent gradients,
    /// about 1 with plain ones; 0 for none.
    pub hourglass: f64,
}

/// How states follow each other.
#[derive(Clone, Default)]
pub enum Motion<const D: usize> {
    /// In explicit steps.
    #[default]
    Explicit,
    /// In implicit steps, which take linear equations and Newton's method.
    Implicit(LinearMethod, Newton),
    /// Not at all: in equilibrium, each with the loads of its load factor. Body forces, tractions
    /// and pressures are those of the body in motion.
    Static(Box<StaticsInput<D>>),
}

/// The material of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material<const D: usize> {
    /// Density in kg/m^3. In 1D and 2D masses, forces and energies are those of a body of 1 m in
    /// each of the missing dimensions.
    pub density: f64,
    /// Strain energy, with what holds the missing dimensions.
    pub law: Reduced<D>,
}
