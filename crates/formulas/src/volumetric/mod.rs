//! Materials whose energy depends on the volume ratio alone.
//!
//! `J` is the ratio of current to reference volume, `psi(J)` the energy per reference volume,
//! `p = -d psi/dJ` the pressure, positive in compression, and `d2 psi/dJ2` the tangent. The first
//! Piola-Kirchhoff stress is `P = -p cof F`: Upwind (3.12) corrected, where the printed sign of
//! `p` contradicts its own text, and (6.30).

mod law;
mod moduli;
mod prestressed;

pub use law::{MaterialError, VolumetricLaw};
pub use moduli::{StressState, bulk_modulus};
pub use prestressed::Prestressed;

use crate::Number;

/// What a material of volume answers to a volume ratio `J > 0`.
///
/// Implemented by the [`VolumetricLaw`] and by its [`Prestressed`] form, so that a loop can be
/// generic over the two. Nothing is checked here: for `J <= 0` results mean nothing, and may be
/// infinite or NaN.
pub trait VolumetricResponse {
    /// Energy `psi(J)` per reference volume, J/m^3.
    fn energy<T: Number>(&self, volume_ratio: T) -> T;

    /// Pressure `p = -d psi/dJ`, Pa, positive in compression.
    fn pressure<T: Number>(&self, volume_ratio: T) -> T;

    /// Tangent `d2 psi/dJ2 = -dp/dJ`, Pa.
    fn tangent<T: Number>(&self, volume_ratio: T) -> T;

    /// The volume ratio at which the pressure is `pressure` (Pa), in closed form.
    ///
    /// `None` where no positive and finite ratio has that pressure: too strong a tension for the
    /// gamma law, too strong a compression for the linear law, or a pressure that is not finite.
    fn volume_ratio_at_pressure(&self, pressure: f64) -> Option<f64>;

    /// Speed `sqrt(psi''(J) / density)` of pressure waves, m/s, for a density of the reference
    /// configuration in kg/m^3.
    ///
    /// At `J = 1` it is Upwind (3.54) for the linear law and (6.31) for the gamma law.
    #[inline]
    fn wave_speed<T: Number>(&self, volume_ratio: T, density: f64) -> T {
        (self.tangent(volume_ratio) * (1.0 / density)).sqrt()
    }
}
