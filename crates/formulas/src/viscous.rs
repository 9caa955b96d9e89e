//! Stresses of solids that depend on the rate of the deformation.

use nalgebra::SMatrix;

use crate::{Number, tensor};

/// Kelvin and Voigt's viscosity with the artificial one, theory (65) and (66), of one particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viscous<T> {
    /// Viscosity `eta`, Pa s.
    pub viscosity: f64,
    /// `b_1 rho c l` of the artificial viscosity, Pa s.
    pub linear: T,
    /// `b_2 rho l^2` of it, Pa s^2.
    pub quadratic: T,
}

impl<T: Number> Viscous<T> {
    /// The first Piola-Kirchhoff stress in Pa at a displacement gradient and its rate in 1/s: `J (2 eta d - q I) F^-T`
    /// with the rate of deformation d, and `q = -b_1 tr d + b_2 (tr d)^2` where the body is compressed. Zero for a
    /// rotation, and where F has no inverse.
    pub fn stress<const D: usize>(
        &self,
        gradient: &SMatrix<T, D, D>,
        rate: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        let deformation = gradient + SMatrix::identity();
        let (inverse, exists) = inverse(&deformation);
        let spatial = rate * inverse;
        let rate = (spatial + spatial.transpose()).map(|entry| entry * 0.5);
        let mut cauchy = rate.map(|entry| entry * (2.0 * self.viscosity));
        let expansion = rate.trace();
        let pressure = -self.linear * expansion + self.quadratic * (expansion * expansion);
        let pressure = T::select(expansion.below(0.0), pressure, T::zero());
        for i in 0..D {
            cauchy[(i, i)] -= pressure;
        }
        let determinant = tensor::determinant(&deformation);
        let stress = (cauchy * inverse.transpose()).map(|entry| entry * determinant);
        stress.map(|entry| T::select(exists, entry, T::zero()))
    }

    /// The viscosity in Pa s that a wave meets in the direction that is shortened most, theory (67).
    ///
    /// Rates `a (x) N` have `d = sym(a (x) m)` with `m = F^-T N`, so that the power of (65) and (66),
    /// `J (2 eta d : d + b (tr d)^2)`, is at most `J |m|^2 (2 eta + b) |a|^2`, for a and m along the
    /// direction of the smallest stretch l, where `|m| = 1/l`. The slope of the quadratic part is
    /// `b = 2 b_2 rho l^2 |tr d|`.
    pub fn of_waves<const D: usize>(
        &self,
        gradient: &SMatrix<T, D, D>,
        rate: Option<&SMatrix<T, D, D>>,
    ) -> T {
        let deformation = gradient + SMatrix::identity();
        let shortest = tensor::smallest_eigenvalue(&tensor::right_cauchy_green(&deformation));
        let mut viscosity = self.linear + 2.0 * self.viscosity;
        if let Some(rate) = rate {
            let (inverse, exists) = inverse(&deformation);
            let compression = -(rate * inverse).trace();
            let compression = T::select(compression.above(0.0) & exists, compression, T::zero());
            viscosity += self.quadratic * 2.0 * compression;
        }
        tensor::determinant(&deformation).abs() / shortest * viscosity
    }
}

/// The inverse of a deformation gradient, and whether it exists. Entries are of the size of one, so that its determinant
/// is a normal number unless the body is crushed.
fn inverse<T: Number, const D: usize>(
    deformation: &SMatrix<T, D, D>,
) -> (SMatrix<T, D, D>, T::Mask) {
    let determinant = tensor::determinant(deformation);
    let inverse = tensor::cofactor(deformation).transpose().map(|entry| entry / determinant);
    let largest = T::from(f64::MAX);
    let exists = inverse
        .iter()
        .fold(T::from(f64::MIN_POSITIVE).at_most(determinant.abs()), |exists, entry| {
            exists & entry.abs().at_most(largest)
        });
    (inverse, exists)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Matrix3};

    use super::*;

    const WATERY: Viscous<f64> = Viscous { viscosity: 3.0, linear: 5.0, quadratic: 7.0 };

    /// At rest with the rate L the stress is `2 eta sym L - q I`, by hand.
    #[test]
    fn at_rest_it_is_that_of_a_viscous_fluid() {
        let none = Matrix2::zeros();
        let stress = WATERY.stress(&none, &Matrix2::new(0.5, 2.0, -1.0, 0.25));
        assert_eq!(stress, Matrix2::new(3.0, 3.0, 3.0, 1.5));
        // tr L = -2: q = 5 * 2 + 7 * 4.
        let stress = WATERY.stress(&none, &Matrix2::new(-2.0, 0.0, 0.0, 0.0));
        assert_eq!(stress, Matrix2::new(-12.0 - 38.0, 0.0, 0.0, -38.0));
    }

    /// `dF/dt = W F` with a skew W turns the body.
    #[test]
    fn rotations_cost_nothing_and_what_is_crushed_has_no_stress() {
        let gradient = Matrix3::new(0.2, -0.1, 0.3, 0.0, -0.4, 0.1, 0.2, 0.1, 0.5);
        let spin = Matrix3::new(0.0, 2.0, -1.0, -2.0, 0.0, 3.0, 1.0, -3.0, 0.0);
        let stress = WATERY.stress(&gradient, &(spin * (gradient + Matrix3::identity())));
        assert!(stress.amax() < 64.0 * f64::EPSILON * 100.0, "{stress}");
        let crushed = Matrix2::new(-1.0, 0.0, 0.0, 0.0);
        assert_eq!(WATERY.stress(&crushed, &Matrix2::identity()), Matrix2::zeros());
    }

    /// The power of a rate `a (x) N` is at most what [`Viscous::of_waves`] says, and is it in the direction of the
    /// smallest stretch.
    #[test]
    fn waves_meet_the_largest_power_of_all_directions() {
        let gradient = Matrix2::new(0.5, 0.0, 0.0, -0.2);
        let own = Viscous { quadratic: 0.0, ..WATERY };
        let bound = own.of_waves(&gradient, None);
        let mut largest = 0.0_f64;
        for k in 0..64 {
            let turn = |k: usize| (std::f64::consts::PI * k as f64 / 64.0).sin_cos();
            for l in 0..64 {
                let ((a_y, a_x), (n_y, n_x)) = (turn(k), turn(l));
                // Of a compression, so that the linear part acts.
                let rate = Matrix2::new(a_x * n_x, a_x * n_y, a_y * n_x, a_y * n_y);
                let rate = if (rate * Matrix2::new(0.8, 0.0, 0.0, 1.5)).trace() > 0.0 {
                    -rate
                } else {
                    rate
                };
                largest = largest.max(own.stress(&gradient, &rate).dot(&rate));
            }
        }
        assert!(
            largest <= bound * (1.0 + 1e-12) && largest > bound * (1.0 - 1e-12),
            "{largest} {bound}"
        );
    }
}
