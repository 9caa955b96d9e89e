//! Lame's constants from the pairs of parameters in use.

use crate::Number;
use crate::volumetric::MaterialError;

/// Lame's constants of small strains, of a material whose energy has a minimum at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LameConstants {
    /// First constant `lambda` > -2/3 mu, Pa.
    pub lambda: f64,
    /// Shear modulus `mu` > 0, Pa.
    pub mu: f64,
}

impl LameConstants {
    /// Of `lambda` and `mu` in Pa.
    ///
    /// # Errors
    /// When `mu` is not positive, `lambda` not above `-2/3 mu`, or one is not finite.
    pub fn new(lambda: f64, mu: f64) -> Result<Self, MaterialError> {
        let mu = positive("shear_modulus", mu)?;
        let least = -2.0 / 3.0 * mu;
        if !(lambda > least && lambda.is_finite()) {
            return Err(MaterialError::LameLambda { value: lambda, least });
        }
        Ok(Self { lambda, mu })
    }

    /// Of Young's modulus in Pa and Poisson's ratio:
    /// `mu = E/(2 (1 + nu))`, `lambda = E nu/((1 + nu)(1 - 2 nu))`.
    ///
    /// # Errors
    /// When Young's modulus is not positive and finite, or Poisson's ratio not between -1 and 1/2.
    pub fn from_young(young_modulus: f64, poisson_ratio: f64) -> Result<Self, MaterialError> {
        let (e, nu) = (positive("young_modulus", young_modulus)?, poisson_ratio);
        if !(nu > -1.0 && nu < 0.5) {
            return Err(MaterialError::PoissonRatio { value: nu, incompressible_allowed: false });
        }
        let [lambda, mu] = of_young(e, nu);
        Self::new(lambda, mu)
    }

    /// Of bulk and shear modulus in Pa: `lambda = kappa - 2/3 mu`.
    ///
    /// # Errors
    /// When one of them is not positive and finite.
    pub fn from_bulk(bulk_modulus: f64, shear_modulus: f64) -> Result<Self, MaterialError> {
        let kappa = positive("bulk_modulus", bulk_modulus)?;
        let mu = positive("shear_modulus", shear_modulus)?;
        Ok(Self { lambda: kappa - 2.0 / 3.0 * mu, mu })
    }

    /// Bulk modulus `kappa = lambda + 2/3 mu`, Pa.
    pub fn bulk_modulus(&self) -> f64 {
        self.lambda + 2.0 / 3.0 * self.mu
    }

    /// Young's modulus `E = mu (3 lambda + 2 mu)/(lambda + mu)`, Pa.
    pub fn young_modulus(&self) -> f64 {
        self.mu * (3.0 * self.lambda + 2.0 * self.mu) / (self.lambda + self.mu)
    }

    /// Poisson's ratio `nu = lambda/(2 (lambda + mu))`.
    pub fn poisson_ratio(&self) -> f64 {
        self.lambda / (2.0 * (self.lambda + self.mu))
    }

    /// Modulus `lambda + 2 mu` of pressure waves, Pa.
    pub fn pressure_wave_modulus(&self) -> f64 {
        self.lambda + 2.0 * self.mu
    }
}

/// `[lambda, mu]` of Young's modulus and Poisson's ratio.
pub(super) fn of_young<T: Number>(e: T, nu: T) -> [T; 2] {
    let one = nu + 1.0;
    [e * nu / (one * (nu * -2.0 + 1.0)), e / (one * 2.0)]
}

pub(super) fn positive(parameter: &'static str, value: f64) -> Result<f64, MaterialError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(MaterialError::NotPositive { parameter, value })
    }
}
