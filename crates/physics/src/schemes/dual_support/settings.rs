//! The choices of the dual-support formulation.

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
