//! What particles are made of, and what a material makes of a deformation.

use nalgebra::{Matrix3, SMatrix};
use piola_formulas::hyperelastic::{HyperelasticLaw, HyperelasticResponse, LameConstants, Reduced};
use piola_formulas::tensor;
use piola_formulas::{Number, Scalar};

use crate::Tensor;

/// The material of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Material<const D: usize> {
    /// Density in kg/m^3. In 1D and 2D masses, forces and energies are those of a body of 1 m in
    /// each of the missing dimensions.
    pub density: f64,
    /// Strain energy, with what holds the missing dimensions.
    pub law: Reduced<D>,
}

impl<const D: usize> Material<D> {
    /// What bodies that move as one are made of: nothing resists in it, as nothing deforms it.
    pub fn rigid(density: f64) -> Self {
        let law = HyperelasticLaw::linear_elastic(LameConstants { lambda: 0.0, mu: 0.0 });
        Self { density, law: Reduced::without_strain(law) }
    }
}

/// What a particle is made of: shares of materials, which add up to one. Where bodies are joined a
/// particle has one of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture<const D: usize>(pub Vec<(Material<D>, f64)>);

impl<const D: usize> Mixture<D> {
    /// Each material by itself.
    pub fn of_each(materials: &[Material<D>]) -> Vec<Self> {
        materials.iter().map(|material| Self(vec![(material.clone(), 1.0)])).collect()
    }

    /// Density in kg/m^3.
    pub fn density(&self) -> f64 {
        self.mean(|material| material.density)
    }

    /// Shear modulus of small strains, Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.mean(|material| material.law.law().small_strain().mu)
    }

    /// Whether one of its materials has a bulk modulus of more than 45 shear moduli, a Poisson's ratio above 0.489.
    pub(super) fn is_nearly_incompressible(&self) -> bool {
        self.0.iter().any(|(material, _)| {
            let LameConstants { lambda, mu } = material.law.law().small_strain();
            lambda + 2.0 / 3.0 * mu > 45.0 * mu
        })
    }

    /// First Piola-Kirchhoff stress of a displacement gradient, Pa.
    pub fn stress(&self, gradient: &Tensor<D>) -> Tensor<D> {
        self.0.iter().map(|(material, share)| material.law.stress(gradient) * *share).sum()
    }

    /// The [stresses](Self::stress) of many displacement gradients.
    pub fn stresses(&self, gradients: &[Tensor<D>], stresses: &mut [Tensor<D>]) {
        stresses.fill(Tensor::zeros());
        for (material, share) in &self.0 {
            material.law.add_stresses(*share, gradients, stresses);
        }
    }

    /// Strain energy per volume of a displacement gradient, J/m^3.
    pub fn energy<T: Scalar>(&self, gradient: &SMatrix<T, D, D>) -> T {
        let all = self.0.iter();
        all.fold(T::zero(), |sum, (material, share)| sum + material.law.energy(gradient) * *share)
    }

    /// Smallest and largest modulus of a wave, Pa.
    pub fn wave_moduli(&self, gradient: &Tensor<D>) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (material, share) in &self.0 {
            // The wave speed of a law of small strains is what it is at rest.
            let moduli = match material.law.law().is_objective() {
                true => material.law.wave_moduli(gradient),
                false => material.law.wave_moduli(&Tensor::zeros()),
            };
            sums.iter_mut().zip(moduli).for_each(|(sum, modulus)| *sum += share * modulus);
        }
        sums
    }

    /// The [wave moduli](Self::wave_moduli) at many displacement gradients.
    pub fn all_wave_moduli(&self, gradients: &[Tensor<D>], moduli: &mut [[f64; 2]]) {
        moduli.fill([0.0; 2]);
        for (material, share) in &self.0 {
            match material.law.law().is_objective() {
                true => material.law.add_wave_moduli(*share, gradients, moduli),
                false => {
                    let [least, most] = material.law.wave_moduli(&Tensor::zeros());
                    for sums in &mut *moduli {
                        sums[0] += share * least;
                        sums[1] += share * most;
                    }
                }
            }
        }
    }

    /// Whether no stretch across has to be found in any of its materials.
    pub fn is_held(&self) -> bool {
        self.0.iter().all(|(material, _)| material.law.is_held())
    }

    /// [`Self::stress`] where the mixture [is held](Self::is_held), in numbers of any type.
    pub fn held_stress<T: Number>(&self, gradient: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let part = |(material, share): &(Material<D>, f64)| {
            material.law.held_stress(gradient).map(|entry| entry * *share)
        };
        self.0.iter().map(part).fold(SMatrix::zeros(), |sum, part| sum + part)
    }

    /// [`Self::wave_moduli`] where the mixture [is held](Self::is_held), in numbers of any type.
    pub fn held_wave_moduli<T: Number>(&self, gradient: &SMatrix<T, D, D>) -> [T; 2] {
        let mut sums = [T::zero(); 2];
        for (material, share) in &self.0 {
            let moduli = match material.law.law().is_objective() {
                true => material.law.held_wave_moduli(gradient),
                false => material.law.wave_moduli(&Tensor::zeros()).map(T::from),
            };
            sums.iter_mut().zip(moduli).for_each(|(sum, modulus)| *sum += modulus * *share);
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

    /// Whether all of it is of small strains, whose stress is a function of the gradient alone.
    pub(super) fn is_linear(&self) -> bool {
        self.0.iter().all(|(material, _)| !material.law.law().is_objective())
    }

    /// The law of its largest share.
    pub(super) fn main_law(&self) -> Option<&HyperelasticLaw> {
        let largest = self.0.iter().max_by(|(_, one), (_, other)| one.total_cmp(other));
        largest.map(|(material, _)| material.law.law())
    }

    /// Appends the mean over its materials of what they make of a displacement gradient.
    pub(super) fn append(&self, measure: Measure, gradient: &Tensor<D>, values: &mut Vec<f64>) {
        let first = values.len();
        let mut own = Vec::with_capacity(D * D);
        for (material, share) in &self.0 {
            own.clear();
            append_measure(&material.law, gradient, measure, &mut own);
            values.resize(first + own.len(), 0.0);
            values[first..].iter_mut().zip(&own).for_each(|(sum, own)| *sum += share * own);
        }
    }

    fn mean(&self, of: impl Fn(&Material<D>) -> f64) -> f64 {
        self.0.iter().map(|(material, share)| share * of(material)).sum()
    }
}

/// Appends a tensor as fields have it, row by row.
pub(super) fn append_rows<const D: usize>(tensor: &Tensor<D>, values: &mut Vec<f64>) {
    // nalgebra stores columns.
    values.extend((0..D * D).map(|k| tensor[(k / D, k % D)]));
}

/// What a law makes of a displacement gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    DeformationGradient,
    Determinant,
    CauchyStress,
    VonMises,
}

/// Appends what a law makes of a displacement gradient.
pub(super) fn append_measure<const D: usize>(
    law: &Reduced<D>,
    gradient: &Tensor<D>,
    measure: Measure,
    values: &mut Vec<f64>,
) {
    let deformation = gradient + Tensor::identity();
    let cauchy = || {
        let all = law.in_three(gradient);
        let (stress, f): (Matrix3<f64>, _) = (law.law().stress(&all), all + Matrix3::identity());
        stress * f.transpose() / tensor::determinant(&f)
    };
    match measure {
        Measure::DeformationGradient => append_rows(&deformation, values),
        Measure::CauchyStress => {
            let cauchy = cauchy();
            append_rows(&Tensor::<D>::from_fn(|i, j| cauchy[(i, j)]), values);
        }
        Measure::Determinant => values.push(tensor::determinant(&deformation)),
        Measure::VonMises => {
            let cauchy = cauchy();
            let deviator = cauchy - Matrix3::identity() * (cauchy.trace() / 3.0);
            values.push((1.5 * deviator.norm_squared()).sqrt());
        }
    }
}
