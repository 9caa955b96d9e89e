//! The law of Mooney and Rivlin.

use nalgebra::Matrix3;

use super::HyperelasticResponse;
use super::kinematics::{Kinematics, scaled, square, trace};
use crate::{Number, tensor};

/// `psi = c10 (J^(-2/3) I1 - 3) + c01 (J^(-4/3) I2 - 3) + kappa/2 (J - 1)^2` with the invariants
/// of `C = F^T F`: theory (41).
///
/// The shear modulus of small strains is `2 (c10 + c01)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    /// First constant, Pa.
    pub c10: f64,
    /// Second constant, Pa.
    pub c01: f64,
    /// Bulk modulus `kappa` > 0, Pa.
    pub bulk_modulus: f64,
}

impl HyperelasticResponse for MooneyRivlin {
    #[inline]
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        let kinematics = Kinematics::new(a);
        let (strain, volume) = (&kinematics.strain, kinematics.volume_strain);
        // I1 = 3 + 2 tr E and I2 = 3 + 4 tr E + 2 (tr E)^2 - 2 E : E, so that nothing of order
        // one is subtracted.
        let trace = trace(strain);
        let first = trace * 2.0;
        let second = trace * 4.0 + (trace * trace - square(strain)) * 2.0;
        let first = kinematics.volume_power(-2.0 / 3.0) * first
            + kinematics.volume_power_less_one(-2.0 / 3.0) * 3.0;
        let second = kinematics.volume_power(-4.0 / 3.0) * second
            + kinematics.volume_power_less_one(-4.0 / 3.0) * 3.0;
        first * self.c10 + second * self.c01 + volume * volume * (0.5 * self.bulk_modulus)
    }

    #[inline(always)]
    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        let kinematics = Kinematics::new(a);
        let gradient = &kinematics.gradient;
        let inverse = kinematics.inverse_transpose();
        let first = trace(&kinematics.strain) * 2.0 + 3.0;
        let volume = kinematics.volume_power(-2.0 / 3.0) * (2.0 * self.c10);
        let mut stress = scaled(&(gradient - scaled(&inverse, first * (1.0 / 3.0))), volume);
        if self.c01 != 0.0 {
            let right = tensor::right_cauchy_green(gradient);
            let second = (first * first - square(&right)) * 0.5;
            let slope = scaled(gradient, first)
                - tensor::product(gradient, &right)
                - scaled(&inverse, second * (2.0 / 3.0));
            let volume = kinematics.volume_power(-4.0 / 3.0) * (2.0 * self.c01);
            stress += scaled(&slope, volume);
        }
        let pressure = kinematics.volume_strain * self.bulk_modulus;
        stress + scaled(&tensor::cofactor(gradient), pressure)
    }
}
