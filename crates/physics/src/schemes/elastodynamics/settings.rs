//! The choices of the elastodynamics formulation.

use crate::Tensor;
use crate::schemes::solid::{Material, wave_moduli};

/// How the divergence of the stress is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// By the transpose of the matrices of the gradient.
    Adjoint,
    /// By the matrices themselves, with ghosts beyond the edges: of a row or of a box.
    Strong,
}

/// Where the matrices are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Configuration {
    /// At the reference places, once.
    Total,
    /// At the places of the moment, in each step, as Elastodynamics 4.7.2 does to show the tensile
    /// instability. In the strong form.
    Updated,
}

/// Numerical settings of the formulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How the divergence of the stress is taken.
    pub form: Form,
    /// Where the matrices are made.
    pub configuration: Configuration,
    /// Coefficient of the hourglass energy of theory (60) in units of the shear modulus, in the adjoint
    /// form.
    pub hourglass: f64,
    /// Viscosity of Kelvin and Voigt's material, Pa s, theory (65).
    pub viscosity: f64,
    /// Linear and quadratic coefficient of the artificial viscosity, theory (66).
    pub artificial_viscosity: [f64; 2],
    /// Rate in 1/s at which motion dies out.
    pub damping: f64,
}

impl Settings {
    /// Whether stresses depend on the rate of the deformation.
    pub(super) fn is_viscous(&self) -> bool {
        self.viscosity > 0.0 || self.artificial_viscosity.iter().any(|&it| it > 0.0)
    }
}

/// What a particle is made of: shares of materials, which add up to one. Where bodies are joined a
/// particle has one of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture<const D: usize>(pub Vec<(Material<D>, f64)>);

impl<const D: usize> Mixture<D> {
    /// Density in kg/m^3.
    pub fn density(&self) -> f64 {
        self.mean(|material| material.density)
    }

    /// Shear modulus of small strains, Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.mean(|material| material.law.law().small_strain().mu)
    }

    /// First Piola-Kirchhoff stress of a displacement gradient, Pa.
    pub fn stress(&self, gradient: &Tensor<D>) -> Tensor<D> {
        self.0.iter().map(|(material, share)| material.law.stress(gradient) * *share).sum()
    }

    /// Strain energy per volume of a displacement gradient, J/m^3.
    pub fn energy(&self, gradient: &Tensor<D>) -> f64 {
        self.mean(|material| material.law.energy(gradient))
    }

    /// Smallest and largest modulus of a wave, Pa.
    pub fn wave_moduli(&self, gradient: &Tensor<D>) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (material, share) in &self.0 {
            let moduli = match material.law.law().is_objective() {
                true => wave_moduli(&material.law, gradient),
                false => wave_moduli(&material.law, &Tensor::zeros()),
            };
            sums.iter_mut().zip(moduli).for_each(|(sum, modulus)| *sum += share * modulus);
        }
        sums
    }

    /// `dP/dF_kl` at a displacement gradient, Pa.
    pub(super) fn tangent(&self, gradient: &Tensor<D>) -> [[Tensor<D>; D]; D] {
        let mut sum = [[Tensor::zeros(); D]; D];
        for (material, share) in &self.0 {
            let own = material.law.tangent(gradient);
            for (sum, own) in sum.iter_mut().flatten().zip(own.iter().flatten()) {
                *sum += own * *share;
            }
        }
        sum
    }

    /// `dP/dF : direction` at rest, Pa.
    pub(super) fn stress_at_rest(
        &self,
        tangents: &[Vec<Tensor<D>>],
        direction: &Tensor<D>,
    ) -> Tensor<D> {
        let mut stress = Tensor::zeros();
        for ((_, share), tangent) in self.0.iter().zip(tangents) {
            for (entry, change) in tangent.iter().enumerate() {
                stress += change * (direction[(entry / D, entry % D)] * *share);
            }
        }
        stress
    }

    /// `dP/dF_kl` at rest of each of its materials, entry `k D + l`.
    pub(super) fn tangents_at_rest(&self) -> Vec<Vec<Tensor<D>>> {
        let of = |(material, _): &(Material<D>, f64)| {
            let tangent = material.law.tangent(&Tensor::zeros());
            (0..D * D).map(|entry| tangent[entry / D][entry % D]).collect()
        };
        self.0.iter().map(of).collect()
    }

    fn mean(&self, of: impl Fn(&Material<D>) -> f64) -> f64 {
        self.0.iter().map(|(material, share)| share * of(material)).sum()
    }
}

/// Whether a law is one of small strains, whose stress is a function of the gradient alone.
pub(super) fn is_linear<const D: usize>(mixture: &Mixture<D>) -> bool {
    mixture.0.iter().all(|(material, _)| !material.law.law().is_objective())
}
