//! A material seen from a configuration that is already stressed.

use std::ops::Mul;

use super::{VolumetricLaw, VolumetricResponse};
use crate::Number;

/// A law whose reference configuration has itself the volume ratio `J0` to the stress-free one.
///
/// With `J` measured from the prestressed configuration, energy per its volume, pressure and
/// tangent are `psi(J0 J) / J0`, `p(J0 J)` and `J0 psi''(J0 J)`, theory (7). A hydrostatic start is a ratio
/// per particle, from [`VolumetricResponse::volume_ratio_at_pressure`]. The energy at `J = 1` is
/// not zero but what the prestress stores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prestressed<R = f64> {
    /// The law from its stress-free configuration.
    pub law: VolumetricLaw,
    /// Volume ratio `J0` > 0 of the prestressed configuration.
    pub reference_ratio: R,
}

impl<R: Copy> Prestressed<R> {
    /// Pressure in Pa at a volume ratio, whatever number the ratio of the prestress is.
    #[inline]
    pub fn pressure_at<T: Number + Mul<R, Output = T>>(&self, volume_ratio: T) -> T {
        self.law.pressure(volume_ratio * self.reference_ratio)
    }

    /// Tangent in Pa at a volume ratio, whatever number the ratio of the prestress is.
    #[inline]
    pub fn tangent_at<T: Number + Mul<R, Output = T>>(&self, volume_ratio: T) -> T {
        self.law.tangent(volume_ratio * self.reference_ratio) * self.reference_ratio
    }
}

impl Prestressed {
    /// Density `rho / J0` of the prestressed configuration, of the stress-free density `rho`.
    #[inline]
    pub fn reference_density(&self, stress_free_density: f64) -> f64 {
        stress_free_density / self.reference_ratio
    }
}

impl VolumetricResponse for Prestressed {
    #[inline]
    fn energy<T: Number>(&self, volume_ratio: T) -> T {
        self.law.energy(volume_ratio * self.reference_ratio) * (1.0 / self.reference_ratio)
    }

    #[inline]
    fn pressure<T: Number>(&self, volume_ratio: T) -> T {
        self.pressure_at(volume_ratio)
    }

    #[inline]
    fn tangent<T: Number>(&self, volume_ratio: T) -> T {
        self.tangent_at(volume_ratio)
    }

    fn volume_ratio_at_pressure(&self, pressure: f64) -> Option<f64> {
        Some(self.law.volume_ratio_at_pressure(pressure)? / self.reference_ratio)
    }
}
