//! The registry of volumetric materials.

use super::{Prestressed, VolumetricResponse};
use crate::{Number, power::integer_power};

/// A material whose energy depends on the volume ratio alone.
///
/// The constructors check their parameters; build the variants directly only from checked ones.
///
/// ```
/// use piola_formulas::volumetric::{VolumetricLaw, VolumetricResponse};
///
/// // Water-like: sound speed 10 m/s at 1000 kg/m^3.
/// let law = VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0)?;
/// assert_eq!(law.pressure(1.0), 0.0);
/// assert!(law.pressure(0.9) > 0.0);
/// assert_eq!(law.wave_speed(1.0, 1000.0), 10.0);
/// # Ok::<(), piola_formulas::volumetric::MaterialError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VolumetricLaw {
    /// `psi = kappa (J - 1)^2 / 2`, `p = -kappa (J - 1)`: theory (5), Upwind (3.11), and
    /// (3.12) corrected.
    ///
    /// Full collapse, `J = 0`, costs the finite energy `kappa / 2` only, Upwind (6.28).
    Linear {
        /// Bulk modulus `kappa` > 0, Pa.
        bulk_modulus: f64,
    },
    /// `psi = kappa (J - 1 - (J^(1 - gamma) - 1) / (1 - gamma))`, `p = kappa (J^-gamma - 1)`:
    /// theory (6), Upwind (6.29) and (6.30).
    ///
    /// At `gamma = 1` the fraction is its limit, `ln J`.
    Gamma {
        /// Modulus `kappa` > 0, Pa. The bulk modulus of small changes is `gamma kappa`.
        bulk_modulus: f64,
        /// Exponent `gamma` >= 1.
        gamma: f64,
    },
}

/// A material parameter outside its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// A parameter that has to be positive and finite is not.
    #[error("`{parameter}` must be positive and finite, got {value}")]
    NotPositive {
        /// The parameter's name in a case file.
        parameter: &'static str,
        /// What was given.
        value: f64,
    },
    /// The exponent of the gamma law is too small, or not finite.
    #[error("`gamma` must be at least 1 and finite, got {value}")]
    GammaBelowOne {
        /// What was given.
        value: f64,
    },
    /// Poisson's ratio has no finite and positive modulus of volume.
    #[error(
        "`poisson_ratio` must be above -1 and {} 0.5, got {value}",
        if *.incompressible_allowed { "at most" } else { "below" }
    )]
    PoissonRatio {
        /// What was given.
        value: f64,
        /// Whether 0.5 itself would have been possible.
        incompressible_allowed: bool,
    },
    /// Lame's first constant belongs to a body without resistance to a change of volume.
    #[error("`lame_lambda` must be above -2/3 of the shear modulus, which is {least}, got {value}")]
    LameLambda {
        /// What was given, Pa.
        value: f64,
        /// The bound that it has to exceed, Pa.
        least: f64,
    },
    /// Ogden's law has one to three terms.
    #[error("`ogden` takes one to three pairs of modulus and exponent, got {count}")]
    OgdenTerms {
        /// How many there are.
        count: usize,
    },
}

impl VolumetricLaw {
    /// Names of all laws, as in a case file.
    pub const NAMES: [&'static str; 2] = ["linear", "gamma_law"];

    /// The law's name in a case file, one of [`VolumetricLaw::NAMES`].
    pub fn name(&self) -> &'static str {
        match self {
            Self::Linear { .. } => Self::NAMES[0],
            Self::Gamma { .. } => Self::NAMES[1],
        }
    }

    /// The modulus `kappa` of the law, Pa.
    pub fn modulus(&self) -> f64 {
        match *self {
            Self::Linear { bulk_modulus } | Self::Gamma { bulk_modulus, .. } => bulk_modulus,
        }
    }

    /// Whether full collapse, `J = 0`, costs an energy without bound.
    pub fn resists_collapse(&self) -> bool {
        !self.energy(0.0_f64).is_finite()
    }

    /// Linear law of a bulk modulus in Pa, Upwind (3.11).
    ///
    /// # Errors
    /// When the bulk modulus is not positive and finite.
    pub fn linear(bulk_modulus: f64) -> Result<Self, MaterialError> {
        Ok(Self::Linear { bulk_modulus: positive("bulk_modulus", bulk_modulus)? })
    }

    /// Linear law of a wave speed in m/s and a density in kg/m^3: `kappa = rho c^2`, (3.54).
    ///
    /// # Errors
    /// When an argument or the resulting bulk modulus is not positive and finite.
    pub fn linear_from_wave_speed(wave_speed: f64, density: f64) -> Result<Self, MaterialError> {
        Self::linear(wave_modulus(wave_speed, density)?)
    }

    /// Gamma law of a modulus `kappa` in Pa and an exponent, Upwind (6.29).
    ///
    /// # Errors
    /// When the modulus is not positive and finite, or the exponent not at least 1 and finite.
    pub fn gamma_law(bulk_modulus: f64, gamma: f64) -> Result<Self, MaterialError> {
        if !(gamma >= 1.0 && gamma.is_finite()) {
            return Err(MaterialError::GammaBelowOne { value: gamma });
        }
        Ok(Self::Gamma { bulk_modulus: positive("bulk_modulus", bulk_modulus)?, gamma })
    }

    /// Gamma law of a wave speed in m/s, a density in kg/m^3 and an exponent:
    /// `kappa = rho c^2 / gamma`, Upwind (6.31).
    ///
    /// # Errors
    /// As [`VolumetricLaw::gamma_law`], and when wave speed or density are not positive and finite.
    pub fn gamma_law_from_wave_speed(
        wave_speed: f64,
        density: f64,
        gamma: f64,
    ) -> Result<Self, MaterialError> {
        Self::gamma_law(wave_modulus(wave_speed, density)? / gamma, gamma)
    }

    /// This law seen from a configuration of the volume ratio `reference_ratio`.
    ///
    /// # Errors
    /// When the ratio is not positive and finite.
    pub fn prestressed(self, reference_ratio: f64) -> Result<Prestressed, MaterialError> {
        let reference_ratio = positive("reference_ratio", reference_ratio)?;
        Ok(Prestressed { law: self, reference_ratio })
    }
}

pub(super) fn positive(parameter: &'static str, value: f64) -> Result<f64, MaterialError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(MaterialError::NotPositive { parameter, value })
    }
}

fn wave_modulus(wave_speed: f64, density: f64) -> Result<f64, MaterialError> {
    Ok(positive("density", density)? * positive("wave_speed", wave_speed)?.powi(2))
}

impl VolumetricResponse for VolumetricLaw {
    #[inline]
    fn energy<T: Number>(&self, volume_ratio: T) -> T {
        let strain = volume_ratio - 1.0;
        match *self {
            Self::Linear { bulk_modulus } => strain * strain * (0.5 * bulk_modulus),
            Self::Gamma { bulk_modulus, gamma } => gamma_energy(strain, gamma) * bulk_modulus,
        }
    }

    #[inline]
    fn pressure<T: Number>(&self, volume_ratio: T) -> T {
        match *self {
            Self::Linear { bulk_modulus } => (volume_ratio - 1.0) * -bulk_modulus,
            Self::Gamma { bulk_modulus, gamma } => {
                (power(volume_ratio.recip(), gamma) - 1.0) * bulk_modulus
            }
        }
    }

    #[inline]
    fn tangent<T: Number>(&self, volume_ratio: T) -> T {
        match *self {
            Self::Linear { bulk_modulus } => T::from(bulk_modulus),
            Self::Gamma { bulk_modulus, gamma } => {
                let density_ratio = volume_ratio.recip();
                power(density_ratio, gamma) * density_ratio * (gamma * bulk_modulus)
            }
        }
    }

    fn volume_ratio_at_pressure(&self, pressure: f64) -> Option<f64> {
        let ratio = match *self {
            Self::Linear { bulk_modulus } => 1.0 - pressure / bulk_modulus,
            Self::Gamma { bulk_modulus, gamma } => {
                Number::powf(1.0 + pressure / bulk_modulus, -1.0 / gamma)
            }
        };
        (ratio > 0.0 && ratio.is_finite()).then_some(ratio)
    }
}

/// Energy of the gamma law over `kappa`, from `strain = J - 1`.
///
/// The closed form subtracts numbers of order one, so that rounding would hide the energy of a
/// small strain; there the binomial series takes over.
fn gamma_energy<T: Number>(strain: T, gamma: f64) -> T {
    let series = || {
        let mut term = strain * strain * (0.5 * gamma);
        let mut sum = term;
        for order in 2..SERIES_ORDER {
            let order = f64::from(order);
            term = term * strain * (-(gamma + order - 1.0) / (order + 1.0));
            sum += term;
        }
        sum
    };
    let closed = || {
        let logarithm = strain.ln_1p();
        let exponent = 1.0 - gamma;
        if exponent == 0.0 {
            strain - logarithm
        } else {
            strain - (logarithm * exponent).exp_m1() * (1.0 / exponent)
        }
    };
    T::choose((strain.abs() * (gamma + 1.0)).below(SERIES_BELOW), series, closed)
}

/// Bound of `|J - 1| (gamma + 1)` for the series: each term is below a twentieth of the one before.
const SERIES_BELOW: f64 = 0.1;

/// Order of the last term; the first one left out is below 1e-18 of the sum.
const SERIES_ORDER: u32 = 16;

/// `base^exponent`, by products for the small integers that gamma mostly is.
///
/// That is several times as fast as the general power, and the same on every machine.
#[inline]
fn power<T: Number>(base: T, exponent: f64) -> T {
    if exponent.fract() == 0.0 && (0.0..=64.0).contains(&exponent) {
        integer_power(base, exponent as u32)
    } else {
        base.powf(exponent)
    }
}
