//! Moduli of volume from Young's modulus and Poisson's ratio.

use super::law::{MaterialError, positive};

/// What holds the directions that a calculation does not resolve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressState {
    /// One dimension, free to contract sideways: `kappa = E`.
    UniaxialStress,
    /// One dimension, held sideways: `kappa = E (1 - nu) / ((1 + nu) (1 - 2 nu))`.
    UniaxialStrain,
    /// Two dimensions, free to contract across the plane: `kappa = E / (2 (1 - nu))`.
    PlaneStress,
    /// Two dimensions, held across the plane: `kappa = E / (2 (1 + nu) (1 - 2 nu))`.
    PlaneStrain,
    /// Three dimensions: `kappa = E / (3 (1 - 2 nu))`.
    ThreeDimensional,
}

impl StressState {
    /// All states.
    pub const ALL: [Self; 5] = [
        Self::UniaxialStress,
        Self::UniaxialStrain,
        Self::PlaneStress,
        Self::PlaneStrain,
        Self::ThreeDimensional,
    ];

    /// How many dimensions are resolved.
    pub fn dimension(self) -> usize {
        match self {
            Self::UniaxialStress | Self::UniaxialStrain => 1,
            Self::PlaneStress | Self::PlaneStrain => 2,
            Self::ThreeDimensional => 3,
        }
    }

    /// Whether there are directions that are not resolved, in which the material is free.
    pub fn is_free_across(self) -> bool {
        matches!(self, Self::UniaxialStress | Self::PlaneStress)
    }
}

/// Modulus `kappa` of the linear law, Pa: the equal normal stress in all resolved directions over
/// the change of length, area or volume that it goes with.
///
/// Upwind takes [`StressState::PlaneStress`] for its two-dimensional cases.
///
/// # Errors
/// When Young's modulus (Pa) is not positive and finite, or Poisson's ratio not above -1 and below
/// 1/2. Where the material is free sideways, in uniaxial and plane stress, 1/2 itself is possible.
pub fn bulk_modulus(
    young_modulus: f64,
    poisson_ratio: f64,
    state: StressState,
) -> Result<f64, MaterialError> {
    let (e, nu) = (positive("young_modulus", young_modulus)?, poisson_ratio);
    let incompressible_allowed =
        matches!(state, StressState::UniaxialStress | StressState::PlaneStress);
    if !(nu > -1.0 && (nu < 0.5 || (incompressible_allowed && nu == 0.5))) {
        return Err(MaterialError::PoissonRatio { value: nu, incompressible_allowed });
    }
    Ok(match state {
        StressState::UniaxialStress => e,
        StressState::UniaxialStrain => e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        StressState::PlaneStress => e / (2.0 * (1.0 - nu)),
        StressState::PlaneStrain => e / (2.0 * (1.0 + nu) * (1.0 - 2.0 * nu)),
        StressState::ThreeDimensional => e / (3.0 * (1.0 - 2.0 * nu)),
    })
}
