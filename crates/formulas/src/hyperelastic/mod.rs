//! Elastic solids by their strain energy: small and large strain, in three dimensions or fewer.
//!
//! The energy `psi` per reference volume is the definition of a material. The first
//! Piola-Kirchhoff stress `P = d psi/dF` is written out beside it, Dual-support (31), and the
//! tangent `dP/dF`, Dual-support (33), is the exact derivative of that body by dual numbers.
//!
//! All of them take the displacement gradient `A = F - I` instead of F: of a small strain F keeps
//! half of the digits only, and an energy that is quadratic in it hardly any.
//!
//! - [`HyperelasticLaw`] is the registry, by which a case file names a material.
//! - [`EnergyFunction`] is the law of an energy that is none of those.
//! - [`Reduced`] puts a law into one or two dimensions, where the missing ones are held or free.
//! - [`LameConstants`] come from any usual pair of parameters.

mod constants;
mod derivatives;
mod energy;
mod kinematics;
mod law;
mod linear;
mod many;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
mod reduced;
mod spectral;

pub use constants::LameConstants;
pub use derivatives::Constant;
pub use energy::{EnergyError, EnergyFunction, Instruction, Invariant};
pub use law::HyperelasticLaw;
pub use linear::{LinearElastic, SaintVenantKirchhoff};
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::{NeoHookean, NeoHookeanLogarithmic};
pub use ogden::{Ogden, OgdenTerm};
pub use reduced::{Reduced, ReducedError, Tangent};

use nalgebra::Matrix3;

use crate::Number;

/// What an isotropic elastic solid answers to a displacement gradient `A = F - I`.
///
/// Nothing is checked here: where `det F <= 0`, energies and stresses of laws with a logarithm or
/// a power of it are NaN. Second derivatives of the energy and first ones of the stress are exact
/// by dual numbers; higher ones need not be.
pub trait HyperelasticResponse {
    /// Strain energy `psi` per reference volume, J/m^3.
    fn energy<T: Number>(&self, displacement_gradient: &Matrix3<T>) -> T;

    /// First Piola-Kirchhoff stress `P = d psi/dF`, Pa: theory (36).
    fn stress<T: Number>(&self, displacement_gradient: &Matrix3<T>) -> Matrix3<T>;
}
