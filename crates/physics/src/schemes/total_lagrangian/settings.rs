//! The choices of the formulation.

use super::StaticsInput;
use crate::Vector;
use crate::solve::{LinearMethod, Newton};

/// How the divergence of the stress is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// By the transpose of the gradient.
    #[default]
    Adjoint,
    /// By the matrices of the gradient themselves, with ghosts beyond the edges: of a row or of a box.
    Strong,
}

/// Where the matrices are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Configuration {
    /// At the reference places, once.
    #[default]
    Total,
    /// At the places of the moment, in each step, as Elastodynamics 4.7.2 does to show the tensile
    /// instability. In the strong form.
    Updated,
}

/// Which gradient coefficients are used.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Gradients<const D: usize> {
    /// Those of the papers. On clouds that are no lattice a constant stress is not in equilibrium.
    #[default]
    Plain,
    /// Corrected so that it is, theory (45) and (46): what to use wherever the boundary is known.
    PatchConsistent {
        /// Outward boundary area vector of each particle in m^(D-1), zero inside.
        areas: Vec<Vector<D>>,
    },
}

/// Which particles a traction acts on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tractions {
    /// Those on the surface.
    #[default]
    Surface,
    /// Behind a plane face as many layers as forces of a homogeneous stress reach, each with its share, so
    /// that such a stress is in equilibrium with plain gradients.
    Layers,
}

/// Stresses and forces that take energy out of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dissipation {
    /// Viscosity of Kelvin and Voigt's material, Pa s, theory (65).
    pub viscosity: f64,
    /// Linear and quadratic coefficient of the artificial viscosity, theory (66).
    pub artificial_viscosity: [f64; 2],
    /// Rate in 1/s at which motion dies out.
    pub damping: f64,
}

impl Dissipation {
    /// Whether stresses depend on the rate of the deformation.
    pub(super) fn is_viscous(&self) -> bool {
        self.viscosity > 0.0 || self.artificial_viscosity.iter().any(|&it| it > 0.0)
    }
}

/// Numerical settings of the formulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings<const D: usize> {
    /// How the divergence of the stress is taken.
    pub form: Form,
    /// Where the matrices are made.
    pub configuration: Configuration,
    /// The gradient coefficients of the adjoint form.
    pub gradients: Gradients<D>,
    /// Coefficient of the hourglass energy of theory (47) and (60) in the adjoint form, a pure number
    /// that multiplies the shear modulus: the `mu/m_L` of Dual-support (21) is 1. From 0.05 to 0.1 with
    /// patch-consistent gradients and on lattices, about 1 with plain ones elsewhere; 0 for none.
    pub hourglass: f64,
    /// Which particles tractions act on in the adjoint form.
    pub tractions: Tractions,
    /// What takes energy out of motion.
    pub dissipation: Dissipation,
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
