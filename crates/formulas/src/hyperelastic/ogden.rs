//! Ogden's law.

use nalgebra::Matrix3;

use super::HyperelasticResponse;
use super::kinematics::{Kinematics, scaled};
use super::spectral::Spectral;
use crate::{Number, tensor};

/// One term of Ogden's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OgdenTerm {
    /// Modulus `mu_k`, Pa, of the sign of the exponent.
    pub modulus: f64,
    /// Exponent `alpha_k`, not zero.
    pub exponent: f64,
}

/// `psi = sum_k mu_k/alpha_k (sum_i lbar_i^alpha_k - 3) + kappa/2 (J - 1)^2` with the principal
/// stretches `lbar_i = J^(-1/3) l_i`: theory (42).
///
/// The shear modulus of small strains is `1/2 sum_k mu_k alpha_k`. One term of exponent 2 is the
/// neo-Hookean law (39), terms of 2 and -2 are Mooney and Rivlin's (41).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ogden {
    /// Up to three terms; those left out have a modulus of zero and any exponent but zero.
    pub terms: [OgdenTerm; 3],
    /// Bulk modulus `kappa` > 0, Pa.
    pub bulk_modulus: f64,
}

impl Ogden {
    fn acting(&self) -> impl Iterator<Item = &OgdenTerm> {
        self.terms.iter().filter(|term| term.modulus != 0.0)
    }
}

impl HyperelasticResponse for Ogden {
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        let kinematics = Kinematics::new(a);
        let spectral = Spectral::new(&kinematics.strain);
        let volume = kinematics.volume_strain;
        let mut energy = volume * volume * (0.5 * self.bulk_modulus);
        for &OgdenTerm { modulus, exponent } in self.acting() {
            let sum = spectral.trace_power_less_three(0.5 * exponent);
            let isochoric = kinematics.volume_power(-exponent / 3.0) * sum
                + kinematics.volume_power_less_one(-exponent / 3.0) * 3.0;
            energy += isochoric * (modulus / exponent);
        }
        energy
    }

    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        let kinematics = Kinematics::new(a);
        let spectral = Spectral::new(&kinematics.strain);
        let inverse = kinematics.inverse_transpose();
        let gradient = &kinematics.gradient;
        let pressure = kinematics.volume_strain * self.bulk_modulus;
        let mut stress = scaled(&tensor::cofactor(gradient), pressure);
        for &OgdenTerm { modulus, exponent } in self.acting() {
            let sum = spectral.trace_power_less_three(0.5 * exponent) + 3.0;
            let slope = gradient * spectral.power(0.5 * exponent - 1.0)
                - scaled(&inverse, sum * (1.0 / 3.0));
            stress += scaled(&slope, kinematics.volume_power(-exponent / 3.0) * modulus);
        }
        stress
    }
}
