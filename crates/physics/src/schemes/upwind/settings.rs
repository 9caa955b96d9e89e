//! The choices of the upwind formulation.

use piola_formulas::volumetric::VolumetricLaw;

use crate::operators::Correction;

/// Speed of the shock in the dissipation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaveSpeed {
    /// The speed of the reference state, Upwind (3.54) and (6.31).
    Constant,
    /// Raised where the material is compressed in one direction, Upwind (3.57).
    Stretch,
}

/// Numerical settings of the formulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Correction of the kernel gradient.
    pub correction: Correction,
    /// Strength of the velocity dissipation, 0 for none, 1 for the full Riemann flux.
    pub tau_velocity: f64,
    /// Strength of the pressure dissipation. A negative one feeds energy in: the printed sign of
    /// Upwind (3.42).
    pub tau_pressure: f64,
    /// Whether the states at an interface are reconstructed linearly, Upwind (3.50).
    pub reconstruction: bool,
    /// Speed of the shock in the dissipation.
    pub wave_speed: WaveSpeed,
}

/// The material of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Density of the stress-free state in kg/m^3. In 1D and 2D masses, forces and energies are
    /// those of a body of 1 m in each of the missing dimensions.
    pub density: f64,
    /// Energy of volume change.
    pub law: VolumetricLaw,
}
