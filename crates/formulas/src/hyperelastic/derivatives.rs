//! Derivatives of laws by their constants.

use nalgebra::{Matrix3, SMatrix};
use num_dual::Dual64;

use super::constants::of_young;
use super::{
    HyperelasticLaw, HyperelasticResponse, LameConstants, LinearElastic, MooneyRivlin, NeoHookean,
    NeoHookeanLogarithmic, Reduced, SaintVenantKirchhoff,
};

/// A constant of a law, and what stays as it is when it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constant {
    /// Young's modulus, at the same Poisson's ratio.
    YoungModulus,
    /// Poisson's ratio, at the same Young's modulus.
    PoissonRatio,
    /// Bulk modulus, at the same shear modulus or the same other constants of the law.
    BulkModulus,
    /// Shear modulus, at the same bulk modulus.
    ShearModulus,
    /// Shear modulus, at the same first constant of Lame.
    ShearModulusAtLambda,
    /// First constant of Lame, at the same shear modulus.
    Lambda,
    /// First constant of Mooney and Rivlin's law.
    C10,
    /// Second constant of Mooney and Rivlin's law.
    C01,
    /// Modulus of a term of Ogden's law, counted from 0.
    Modulus(usize),
}

impl LameConstants {
    /// Their derivatives by a constant, exact by dual numbers; none by a constant of another law.
    fn derivative(&self, constant: Constant) -> Option<Self> {
        let [e, nu] = [self.young_modulus(), self.poisson_ratio()].map(Dual64::from_re);
        let [lambda, mu] = match constant {
            Constant::YoungModulus => of_young(e.derivative(), nu).map(|it| it.eps),
            Constant::PoissonRatio => of_young(e, nu.derivative()).map(|it| it.eps),
            Constant::BulkModulus | Constant::Lambda => [1.0, 0.0],
            Constant::ShearModulus => [-2.0 / 3.0, 1.0],
            Constant::ShearModulusAtLambda => [0.0, 1.0],
            Constant::C10 | Constant::C01 | Constant::Modulus(_) => return None,
        };
        Some(Self { lambda, mu })
    }
}

impl HyperelasticLaw {
    /// The derivative of the law by a constant, theory (104): energy and stress are linear in the moduli,
    /// so that it is the law with the derivatives of its moduli in their place.
    ///
    /// None by a constant that the law does not have, and of [`HyperelasticLaw::Energy`], whose
    /// constants are numbers among others.
    pub fn derivative(&self, constant: Constant) -> Option<Self> {
        Some(match self {
            Self::LinearElastic(law) => {
                Self::LinearElastic(LinearElastic(law.0.derivative(constant)?))
            }
            Self::SaintVenantKirchhoff(law) => {
                Self::SaintVenantKirchhoff(SaintVenantKirchhoff(law.0.derivative(constant)?))
            }
            Self::NeoHookean(law) => Self::NeoHookean(NeoHookean(law.0.derivative(constant)?)),
            Self::NeoHookeanLogarithmic(law) => {
                Self::NeoHookeanLogarithmic(NeoHookeanLogarithmic(law.0.derivative(constant)?))
            }
            Self::MooneyRivlin(_) => {
                let [c10, c01, bulk_modulus] = match constant {
                    Constant::C10 => [1.0, 0.0, 0.0],
                    Constant::C01 => [0.0, 1.0, 0.0],
                    Constant::BulkModulus => [0.0, 0.0, 1.0],
                    _ => return None,
                };
                Self::MooneyRivlin(MooneyRivlin { c10, c01, bulk_modulus })
            }
            Self::Ogden(law) => {
                let mut derivative = *law;
                derivative.bulk_modulus = 0.0;
                derivative.terms.iter_mut().for_each(|term| term.modulus = 0.0);
                match constant {
                    Constant::BulkModulus => derivative.bulk_modulus = 1.0,
                    Constant::Modulus(term) if law.terms.get(term)?.modulus != 0.0 => {
                        derivative.terms[term].modulus = 1.0;
                    }
                    _ => return None,
                }
                Self::Ogden(derivative)
            }
            Self::Energy(_) => return None,
        })
    }
}

impl<const D: usize> Reduced<D> {
    /// The derivative of the first Piola-Kirchhoff stress by a constant at a displacement gradient, in Pa over
    /// the unit of the constant, from the [`derivative`](HyperelasticLaw::derivative) of the law: theory
    /// (105). Where the material is free across, the strain there follows the constant.
    pub fn stress_derivative(
        &self,
        displacement_gradient: &SMatrix<f64, D, D>,
        derivative: &HyperelasticLaw,
    ) -> SMatrix<f64, D, D> {
        let all = self.in_three(displacement_gradient);
        let by_constant = derivative.stress(&all);
        let resolved = SMatrix::from_fn(|i, j| by_constant[(i, j)]);
        if !self.state().is_free_across() {
            return resolved;
        }
        let mut seeded: Matrix3<Dual64> = all.map(Dual64::from_re);
        (D..3).for_each(|axis| seeded[(axis, axis)] = seeded[(axis, axis)].derivative());
        let by_strain = self.law().stress(&seeded).map(|stress| stress.eps);
        let across = -by_constant[(2, 2)] / by_strain[(2, 2)];
        SMatrix::from_fn(|i, j| resolved[(i, j)] + by_strain[(i, j)] * across)
    }
}
